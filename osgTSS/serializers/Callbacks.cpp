// osg::Callback inherits osg::Object virtually, which a static_cast does not undo. Before the templates that
// use it.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>
#include <osgDB/Serializer>
#include <osgTSS/DriveCallback>
#include <osgTSS/JointCallback>
#include <osgTSS/LimitsCallback>
#include <osgTSS/MuscleCallback>
#include <osgTSS/SkinCallback>
#include <osgTSS/ViewerCallback>

// One namespace a wrapper: the macros define the same names in each.
namespace driveCallback {
REGISTER_OBJECT_WRAPPER(osgTSS_DriveCallback, new osgTSS::DriveCallback, osgTSS::DriveCallback,
                        "osg::Object osg::Callback osgTSS::DriveCallback") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
}
} // namespace driveCallback

namespace limitsCallback {
REGISTER_OBJECT_WRAPPER(osgTSS_LimitsCallback, new osgTSS::LimitsCallback, osgTSS::LimitsCallback,
                        "osg::Object osg::Callback osgTSS::LimitsCallback") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
}
} // namespace limitsCallback

namespace viewerCallback {
REGISTER_OBJECT_WRAPPER(osgTSS_ViewerCallback, new osgTSS::ViewerCallback, osgTSS::ViewerCallback,
                        "osg::Object osg::Callback osgTSS::ViewerCallback") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
}
} // namespace viewerCallback

namespace muscleCallback {
REGISTER_OBJECT_WRAPPER(osgTSS_MuscleCallback, new osgTSS::MuscleCallback, osgTSS::MuscleCallback,
                        "osg::Object osg::Callback osgTSS::MuscleCallback") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
    ADD_STRING_SERIALIZER(MusclePath, "");
}
} // namespace muscleCallback

namespace skinCallback {
REGISTER_OBJECT_WRAPPER(osgTSS_SkinCallback, new osgTSS::SkinCallback, osgTSS::SkinCallback,
                        "osg::Object osg::Callback osgTSS::SkinCallback") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
    ADD_STRING_SERIALIZER(SkinPath, "");
}
} // namespace skinCallback

namespace jointCallback {

bool checkPairPaths(const osgTSS::JointCallback& callback) {
    return !callback.getPairPaths().empty();
}

bool readPairPaths(osgDB::InputStream& is, osgTSS::JointCallback& callback) {
    unsigned int count = 0;
    is >> count >> is.BEGIN_BRACKET;
    std::vector<std::string> paths;
    for (unsigned int i = 0; i < count && !is.getException(); ++i) {
        std::string path;
        is.readWrappedString(path);
        paths.push_back(path);
    }
    is >> is.END_BRACKET;
    callback.setPairPaths(paths);
    return true;
}

bool writePairPaths(osgDB::OutputStream& os, const osgTSS::JointCallback& callback) {
    os << static_cast<unsigned int>(callback.getPairPaths().size()) << os.BEGIN_BRACKET << std::endl;
    for (const std::string& path : callback.getPairPaths()) {
        os.writeWrappedString(path);
        os << std::endl;
    }
    os << os.END_BRACKET << std::endl;
    return true;
}

REGISTER_OBJECT_WRAPPER(osgTSS_JointCallback, new osgTSS::JointCallback, osgTSS::JointCallback,
                        "osg::Object osg::Callback osgTSS::JointCallback") {
    ADD_OBJECT_SERIALIZER(Scene, osgTSS::Scene, nullptr);
    ADD_USER_SERIALIZER(PairPaths);
}

} // namespace jointCallback
