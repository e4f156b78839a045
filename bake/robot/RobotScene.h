#pragma once
#include "bake/geometry/Import.h"
#include "bake/model/SceneModel.h"
#include "bake/robot/Robot.h"
#include "bake/scene/AllPairs.h"

#include <functional>

namespace tss {

/// Where the mesh of a robot's file lies, from its name there; empty: it is to be left out. Throws InputError
/// for one that may not be read or of which it is not known where to look.
using FindMesh = std::function<std::string(const std::string& name)>;

enum class RobotPairs {
    Neighbours, ///< the links of each joint
    All,        ///< links that move against each other
    Near,       ///< these, and of a character's bones those that its animation has near each other
};

struct RobotSceneRequest {
    bool visual = false; ///< take the visual shapes of a link, not those of its collision
    RobotPairs pairs = RobotPairs::Near;
};

/// What became of a link, for people and scripts.
struct LinkReport {
    std::string body;       ///< prim path
    std::size_t shapes = 0; ///< that its mesh was put together from
    bool visual = false;    ///< they are its visual ones
};

struct RobotScene {
    SceneModel scene;
    std::vector<LinkReport> links; ///< one per link
    std::vector<AllPairs::Unmade>
        unmade; ///< links that were wanted as a pair and cannot be one; not in notes
    std::vector<std::string> notes;
};

/// A scene of a robot: a body a link, its shapes one mesh in the link's frame (the other kind of shapes where
/// it has none of the wanted one or one that cannot be had, noted; an Xform where it has none at all), a
/// joint a joint, fixed ones too, so that every link keeps its name; the pairs of links that move against
/// each other and are not switched off; a skin a skin; and a motion that shows each joint. Throws InputError
/// as findMesh does, where no link has a shape that can be had though some name one, and for too many
/// triangles.
RobotScene sceneOf(const Robot& robot, const RobotSceneRequest& request, const FindMesh& findMesh);

} // namespace tss
