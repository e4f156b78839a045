#pragma once
#include "bake/motion/Motion.h"
#include "bake/motion/Muscle.h"
#include "bake/table/Table.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace tss {

struct Layer;

/// A value over time: linear between samples, held before the first and after the last, as USD does. Times
/// are time codes, strictly rising.
struct TimeSamples {
    std::vector<double> times;
    std::vector<double> values;

    bool empty() const { return times.empty(); }
    double at(double time) const {
        if (times.empty()) return 0;
        const auto next = std::upper_bound(times.begin(), times.end(), time);
        if (next == times.begin()) return values.front();
        if (next == times.end()) return values.back();
        const std::size_t i = next - times.begin();
        const double t = (time - times[i - 1]) / (times[i] - times[i - 1]);
        return values[i - 1] + t * (values[i] - values[i - 1]);
    }
};

/// A mesh prim, or an Xform without geometry (the frame between two joints of a chain).
struct Body {
    std::string path;        ///< prim path, e.g. /Jaw/Skull
    std::string displayName; ///< the name it had elsewhere (an OSG node's), when that is not a prim name
    TriangleMesh mesh; ///< in the body's own rigid frame; scale of the prim's transform is applied already
    Pose placement = Pose::Identity(); ///< body to world, as modelled
    Vec3 displayColor{0.8, 0.8, 0.8};  ///< linear RGB, 0..1
    bool named = true;  ///< false: where it comes from it has no name, and this one was made up
    bool rigid = false; ///< PhysicsRigidBodyAPI
    bool visible = true;
    bool doubleSided = false;
};

/// A joint of USD physics: T = frame0 * D1(q1)...Dd(qd) * frame1^-1 maps body1 to body0.
/// DOFs are given in the joint's frame: rotations and translations about and along X, Y or Z, or paths.
struct Joint {
    std::string path;
    int body0 = -1; ///< index into bodies; -1: the world
    int body1 = -1;
    Pose frame0 = Pose::Identity();
    Pose frame1 = Pose::Identity();
    std::vector<Dof> dofs;           ///< radians and scene units, in the order of T(q); rest in Dof::rest
    std::vector<LimitPlane> planes;  ///< couplings between the DOFs of this joint
    std::vector<TimeSamples> drives; ///< the asked motion, one per DOF, may be empty; same units as the DOF
    bool enabled = true;
    bool collisionEnabled = true;
};

/// Settings of a pair's bake that differ from the defaults, as "key" -> text; keys are the options of `tss
/// bake` without dashes.
using BakeSettings = std::map<std::string, std::string>;

/// Two rigid bodies whose collision is of interest.
struct Pair {
    std::string path; ///< the joint's path, or that of a prim with tss:bodies
    int bodyA = -1;   ///< A stays, B moves
    int bodyB = -1;
    std::vector<int> joints; ///< the chain from A to B, indices into joints; one for neighbours
    BakeSettings settings;
    std::string tablePath; ///< prim path of the table, empty when there is none
    std::shared_ptr<const Table> table;
    std::shared_ptr<const NeverCollides> proof; ///< instead of a table
    std::string sourceHash;                     ///< of what the table or the proof was made from
};

/// A muscle prim. Its surface is that of a body of the scene.
struct MuscleModel {
    std::string path;
    int body = -1; ///< index into bodies: the surface
    int bone = -1; ///< the body it rides on, or its origin does, -1: none
    int insertionBone =
        -1;        ///< the body that its insertion moves with, -1: the same; Muscle::spans says so too
    Muscle muscle; ///< in the surface's frame
    TimeSamples activation;
};

/// Whose motion each vertex of a skin follows, as a person has painted it (UsdSkel's joint indices and
/// weights).
struct SkinWeights {
    std::vector<int> joints;            ///< indices into bodies; none: the skin finds its weights itself
    std::size_t influences = 1;         ///< a vertex
    std::vector<std::uint32_t> indices; ///< #V times influences, into joints
    std::vector<double> weights;        ///< the same number, >= 0, of a vertex 1 together
};

/// A skin that lies on bones and is pushed by muscles.
struct SkinModel {
    std::string path; ///< of its mesh prim
    int body = -1;
    std::vector<int> muscles; ///< indices into muscles
    std::vector<int> bones;   ///< indices into bodies: what it lies on and moves with, any meshes
    SkinWeights weights;
    double thickness = 0; ///< skin sphere radius, scene units; 0: from the mesh
    double travel = 0;    ///< how far a vertex may stray from rest; 0: from the muscles' motion
    double stretchCompliance = 0;
    double bendCompliance = 0;
    bool selfContact = false;   ///< the skin also keeps out of itself
    std::vector<double> tether; ///< #V, 0..1, how firmly a vertex is held to its rest place; empty: 0
    std::vector<double>
        attach; ///< #V, 0..1, how firmly it is carried by the muscle below; empty: from the muscles
    BakeSettings settings;
    std::string tablePath;
    std::shared_ptr<const SkinTable> table;
    std::string sourceHash;
};

/// The typed view of a scene file: what osgTSS knows of it. Indices are into this struct's own vectors.
struct SceneModel {
    std::string defaultPrim = "Scene"; ///< name of the root prim
    std::string displayName;           ///< the name it had elsewhere, when that is not a prim name
    double metersPerUnit = 1;
    char upAxis = 'Z'; ///< 'Y' or 'Z'
    double timeCodesPerSecond = 24;
    double startTimeCode = 0;
    double endTimeCode = 0;

    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<Pair> pairs;
    std::vector<MuscleModel> muscles;
    std::vector<SkinModel> skins;

    std::shared_ptr<const Layer> layer; ///< what it was read from, with everything that it does not know
};

/// The motion of a pair: its chain of joints composed, B-local to A-local. The DOFs are the joints' in chain
/// order; a joint crossed from body1 to body0 is inverted. DOF names are "<joint name>:<dof>" when there are
/// several joints.
Motion pairMotion(const SceneModel& scene, const Pair& pair);

/// Index of the body, joint, ... with this prim path, -1 when there is none.
int findBody(const SceneModel& scene, const std::string& path);
int findPair(const SceneModel& scene, const std::string& path);
int findMuscle(const SceneModel& scene, const std::string& path);
int findSkin(const SceneModel& scene, const std::string& path);

/// Whether a body, joint, muscle or pair has this prim path.
bool hasPath(const SceneModel& scene, const std::string& path);

/// The largest diagonal of a body's mesh, scene units; 0 where none has a mesh.
double largestDiagonal(const SceneModel& scene);

/// The last name of a prim path.
std::string primName(const std::string& path);

} // namespace tss
