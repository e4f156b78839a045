#pragma once
#include "bake/robot/LeftOut.h"
#include "bake/robot/Robot.h"
#include "bake/scene/Layer.h"
#include "bake/scene/SceneParts.h"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tss {

// What robotOf() is made of.

/// What is wrong with a prim or one of its properties: the message, after the property's name.
std::string messageBelow(const std::string& prim, const InputError& error);

/// What others write of UsdPhysics' and UsdGeom's attributes in another type of as many numbers, as in
/// `float3 physics:localPos0`, `point3f xformOp:translate` or `double physics:lowerLimit`, in the type of the
/// schema; quaternions of any length but 0 as ones of length 1, noted; operations in xformOpOrder that have
/// no property left out, noted. Where a number does not fit, the type stays.
void adaptTypes(Layer& layer, LeftOut& leftOut);

/// Where the end of a joint is: a link (-1: the world), and the prim's frame in the link's. Points of the
/// prim may be stretched on their way.
struct JointEnd {
    int link = -1;
    Eigen::Affine3d points = Eigen::Affine3d::Identity();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    bool simulated = false; ///< joints move it: a rigid body that is not kinematic
    bool kinematic = false; ///< it is moved from outside
};

/// The end that a path names; the world for an empty one.
using FindJointEnd = std::function<JointEnd(const PrimReader& joint, const std::string& path)>;

/// Reads all joints of a stage into the robot, as a forest of its links from `world` down, the link of all
/// that stands still (-1: there is none). What cannot be one is left out by name.
void readUsdJoints(const SceneReading& reading, const FindJointEnd& findEnd, int world, Robot& robot,
                   LeftOut& leftOut);

/// The last name of a path, with as many of those above as make it one that is not taken yet; it is then.
std::string freeName(const std::string& path, std::set<std::string>& taken);

/// Where bodies stand elsewhere than a joint of one value has them at 0, that rests at the value which it
/// is shown at. What no value explains is said.
void restAsShown(Robot& robot, LeftOut& leftOut);

/// The prim is of no type, or an Xform or Scope.
bool isGroup(const Prim& prim);

/// What of a stage collides. Entries as in the reading's index, which must outlive this.
class Colliders {
public:
    explicit Colliders(const SceneReading& reading);

    /// It has PhysicsCollisionAPI, switched on or not.
    bool is(std::size_t entry) const { return holds_[entry] == Own; }
    /// It collides itself, or is part of what does: of a prim above it that is no shape.
    bool collides(std::size_t entry) const;
    /// The prim whose PhysicsCollisionAPI that is, switched on or not; -1 where there is none.
    int colliderOf(std::size_t entry) const;
    /// A PointInstancer has copies of what is below it, and not that itself.
    bool isPrototype(std::size_t entry) const;
    /// Of an instancer: below it, or where its prototypes are, some prim has PhysicsCollisionAPI.
    bool hasCollidingPrototypes(std::size_t instancer) const;

private:
    enum Holds : char { None, Below, Own };
    const SceneReading& reading_;
    std::vector<Holds> holds_; ///< one per entry: PhysicsCollisionAPI itself, or somewhere below it
};

/// Links as pairs of indices, the lower first; -1: the world.
struct FilteredLinks {
    std::vector<std::pair<int, int>> wholly; ///< no shape of one collides with any of the other
    std::vector<std::pair<int, int>> partly; ///< some do
};

/// What PhysicsFilteredPairsAPI and collision groups leave of the pairs of links. linkOf: by entry, the link
/// that it belongs to. What is not read of them leaves pairs on, noted.
FilteredLinks filteredLinks(const SceneReading& reading, const Colliders& colliders,
                            const std::vector<int>& linkOf, LeftOut& leftOut);

/// The prim is of a type that meshOfGprim() reads.
bool isGprim(const Prim& prim);

/// The prim is a surface of a type that is not read.
bool isUnreadSurface(const Prim& prim);

/// A Mesh (its cage, polygons cut into triangles), or the closed mesh of a Cube, Sphere, Cylinder, Capsule
/// (of one radius, as Capsule_1 and Cylinder_1) or Cone, which encloses it; in the frame that `place` leads
/// to. Throws InputError, or adds to the reader's problems.
TriangleMesh meshOfGprim(const PrimReader& prim, const Eigen::Affine3d& place);

} // namespace tss
