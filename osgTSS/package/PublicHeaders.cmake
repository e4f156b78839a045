# Run when installing: the headers of the core that a program includes, and what these include in turn. All others are
# private. SOURCE: the repository; INCLUDES: where they go.
cmake_policy(PUSH)
cmake_policy(SET CMP0057 NEW) # IN_LIST
set(open
    bake/base/Error.h
    bake/base/FramePattern.h
    bake/model/AddPair.h
    bake/model/CheckIndices.h
    bake/model/JointGraph.h
    bake/model/Kinematics.h
    bake/model/SceneModel.h
    bake/model/SourceHash.h
    bake/motion/MotionFrame.h
    bake/play/JointPlan.h
    bake/play/MechanismQuery.h
    bake/play/Player.h
    bake/play/SkinSetup.h
    bake/respond/JointResponder.h
    bake/respond/SkinCosts.h
    bake/respond/SkinResponse.h
    bake/scene/Layer.h
    bake/scene/SceneFile.h
    bake/table/Contact.h
    bake/table/PreparedTable.h
    bake/table/Query.h
    bake/table/TablePairs.h)
set(known "")
while(open)
    list(POP_FRONT open header)
    if(header IN_LIST known)
        continue()
    endif()
    list(APPEND known ${header})
    file(STRINGS "${SOURCE}/${header}" lines REGEX "^#include \"bake/")
    foreach(line IN LISTS lines)
        string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
        list(APPEND open ${included})
    endforeach()
    get_filename_component(folder ${header} DIRECTORY)
    file(INSTALL "${SOURCE}/${header}" DESTINATION "${INCLUDES}/${folder}")
endwhile()
cmake_policy(POP)
