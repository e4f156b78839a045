#pragma once
#include "bake/model/SceneModel.h"
#include "bake/motion/Motion.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tss {

/// A shape of a link, in the link's frame once placed. Lengths in units of the robot.
struct RobotShape {
    enum class Kind { Mesh, Box, Sphere, Cylinder, Capsule, Ellipsoid, Cone };
    Kind kind = Kind::Mesh;
    /// Mesh: scale along x, y, z. Box: its edges. Sphere: the radius. Cylinder: radius and length, along z.
    /// Capsule: radius, and length between the centres of its ends. Ellipsoid: its three radii. Cone: radius
    /// and height, its tip up along z, the middle of its height at 0.
    Vec3 size = Vec3::Ones();
    std::string file;                         ///< of a mesh: its name as the robot's file has it
    Pose unscaled = Pose::Identity();         ///< of a mesh: puts its vertices where they are scaled
    std::shared_ptr<const TriangleMesh> mesh; ///< or the mesh itself, where it stands in the robot's file
    Pose place = Pose::Identity();
    std::string where;   ///< for messages: "line 12"
    std::string problem; ///< why it cannot be had; empty where it can
};

struct RobotLink {
    std::string name;
    bool named = true; ///< false: the file has no name for it, this one was made up
    std::vector<RobotShape> collision, visual;
    std::optional<Vec3> color; ///< linear RGB
    bool visible = true;
    Pose place = Pose::Identity(); ///< in the world, where no joint says it
};

/// How a link hangs on another: child to parent is origin * D1(q1) ... Dd(qd), the DOFs in the child's frame
/// as it stands at 0. No DOFs: fixed.
struct RobotJoint {
    std::string name;
    int parent = -1, child = -1; ///< indices of links; -1: the world
    Pose origin = Pose::Identity();
    std::vector<Dof> dofs;
    bool endless = false; ///< it turns on and on: its limits are one whole turn
    /// In the child's frame, one whose axes the DOFs are about and along (X, Y, Z, each once): these are then
    /// in it, with their origins at 0. Nothing: they are in the child's frame.
    std::optional<Pose> frame;
    /// The joint that this one, of one DOF, follows: value = factor * its value + offset.
    std::string leader;
    double factor = 1, offset = 0;
    std::vector<TimeSamples> drives; ///< the motion that the file asks for, none or one per DOF
    std::string where;
};

/// A mesh over links that follows them by weights: it is drawn, and collides with nothing.
struct RobotSkin {
    std::string name;
    TriangleMesh mesh;                  ///< in the world, where all links are at rest
    std::vector<int> links;             ///< indices of links
    std::size_t influences = 1;         ///< a vertex
    std::vector<std::uint32_t> indices; ///< #V times influences, into links
    std::vector<double> weights;        ///< the same number, >= 0, of a vertex 1 together
    std::optional<Vec3> color;          ///< linear RGB
    bool visible = true;
};

/// What a robot's description says, whatever its format. Links hang on each other as a forest.
struct Robot {
    std::string name, file; ///< file: as the user gave it
    double metersPerUnit = 1;
    char upAxis = 'Z'; ///< 'Y' or 'Z'
    /// Of its drives, if any joint has some.
    double timeCodesPerSecond = 24, startTimeCode = 0, endTimeCode = 0;
    std::vector<RobotLink> links;
    std::vector<RobotJoint> joints;
    std::vector<RobotSkin> skins;
    std::vector<std::pair<std::string, std::string>> unpaired; ///< links whose collision is switched off
    /// Links that one surface was cut into, as it bends between them: they meet there at every pose.
    std::vector<std::pair<std::string, std::string>> seams;
    std::vector<std::string> notes; ///< what was left out or taken otherwise than it stands there, by name
};

/// Moves the child, with what hangs on it, by `by` in its own frame; its DOFs stay where they are.
void moveChild(RobotJoint& joint, const Vec3& by);

/// That links hang on each other as a forest: from the joints' parents and children alone. Throws InputError
/// with file and line for a link that hangs on two, for a closed loop, for more than 500 links.
void checkForest(const Robot& robot);

/// What holds for any format, once all is read: checkForest(). A joint whose limits leave it one value
/// becomes fixed there; one that turns further than is served turns once round. One that follows another
/// moves as far as the other's limits lead it, whatever its own; the coupling itself is for the scene's
/// motion alone, and noted: in a table both move by themselves, which only adds poses. One whose leader is
/// none, or itself in the end, moves by itself, noted, and leads on. Led by one that turns on and on it turns
/// all the way round, or slides within its own limits, without which it is left out.
void settleRobot(Robot& robot);

} // namespace tss
