#pragma once
#include "bake/motion/BoneSwing.h"
#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleTrack.h"
#include "bake/motion/PoseBlend.h"
#include "bake/respond/SkinFaithful.h"
#include "bake/respond/SkinFoundation.h"
#include "bake/respond/SkinNormals.h"
#include "bake/table/SkinTable.h"

#include <memory>

namespace tss {

/// How a skin behaves (METHOD 6.5). Compliances and other values between 0 and 1e12 and beyond throw nothing.
struct SkinParameters {
    double stretchCompliance = 0; ///< of the sheet that answers contacts, >= 0; at 1 it is half as stiff
    double bendCompliance = 0;    ///< the same of its bending, >= 0
    /// #bodies: what each moves with, -1: with the skin itself. Bodies of one frame move together. Empty: a
    /// bone with itself alone, a muscle with the skin.
    std::vector<int> frames;
    /// #bodies: of a muscle between two bones a body that moves with the one at its insertion, else -1; it
    /// moves with the one at its origin. Empty: no muscle lies between two.
    std::vector<int> insertions;
    /// #frames of #V in [0,1], the shares of frames in each vertex; empty: found from where the bones lie
    std::vector<std::vector<double>> shares;
    std::vector<BoneSwing> swings; ///< of the bodies: which of them move at all, and where skin meets what
    std::vector<double> tether;    ///< #V in [0,1], how firmly a vertex keeps its rest place; empty: 0
    std::vector<double> attach;    ///< #V in [0,1], how firmly the muscle below carries it; empty: 1
    bool selfContact = false;      ///< the skin also keeps out of itself: lip against lip, lid against lid
    int iterations = 60; ///< most sweeps over the contacts that push, for each time they are looked up, >= 1
    bool faithful = false; ///< [paper] spheres push spheres out, no elastic sheet
};

inline int insertionOf(const SkinParameters& parameters, std::size_t body) {
    return parameters.insertions.empty() ? -1 : parameters.insertions[body];
}

constexpr int bodySteps = 16; ///< stretches of a muscle's range that its surface is tabulated over

/// Run-time lengths are floats in sizes of the skin, from its middle.
using Move = Eigen::Vector4f;

/// A muscle or a bone as the run time moves it.
struct SkinBody {
    std::uint32_t first = 0, count = 0; ///< its vertices among those of all bodies
    std::vector<Tri> triangles, across; ///< across: the one beyond each edge (k, k+1), -1: none
    std::vector<double> nodes;          ///< rising activations; one: a bone
    std::vector<Move> rest;             ///< #count, at activation 0, in the skin's frame
    std::vector<Move> places, normals;  ///< #nodes blocks of #count
    std::vector<float> strain;          ///< #nodes: most that an edge has changed, of its length at rest
    std::vector<std::uint32_t> blocks;  ///< of the skin, that it displaces
    int frame = -1;                     ///< that it moves with
    int insertion = -1;                 ///< body that its far end moves with, -1: all of it moves with one
    std::shared_ptr<const MuscleSpan> span;   ///< in run-time lengths; null where insertion is -1
    std::shared_ptr<const TriangleMesh> mesh; ///< of a bone, in run-time lengths; null: a muscle
    std::shared_ptr<const ClosestPointQuery> locator;

    bool bone() const { return mesh != nullptr; }
    /// The most that an edge has changed, of its length at rest. now: #count places.
    float strainOf(const Move* now) const;
};

/// A vertex of a muscle that moves a vertex of the skin by a share of its own move.
struct SkinPull {
    std::uint32_t from = 0; ///< among the vertices of all bodies
    float share = 0;
};

/// A frame's share in a vertex.
struct SkinFrameShare {
    std::uint32_t frame = 0;
    float share = 0;
};

/// What meets what in a row of contact.
enum class SkinMeeting : std::uint8_t {
    SkinOnBody, ///< a skin vertex a body's surface
    BodyOnSkin, ///< a body's vertex the skin from below
    SkinOnSkin, ///< a skin vertex another part of the skin
};

/// How the two of a row lie where its muscle alone has moved, and everything else is at rest.
struct SkinApart {
    /// x, y, z: what meets, from the place that it is before. w: while they are no farther off that than
    /// this, here or on the way to the next, nothing meets.
    Move lie = Move::Zero();

    Eigen::Vector3f relative() const { return lie.head<3>(); }
    float gap() const { return lie[3]; }
    float& gap() { return lie[3]; }
};

/// A possible contact. Where it is looked for starts from a triangle known beforehand, so that the answer has
/// no history.
struct SkinRow {
    SkinMeeting meeting = SkinMeeting::SkinOnBody;
    std::uint32_t vertex = 0; ///< of the skin; BodyOnSkin: among those of all bodies
    std::uint32_t body = 0;
    std::uint32_t first = 0, last = 0; ///< triangles to start from: range in SkinRig::starts
    bool within = false;               ///< at rest it is already on the wrong side, and is to get no deeper
    bool turned = false;               ///< within a body that overlaps itself: the surface beside it faces it
    Tri corners{0, 0, 0};              ///< of the place at rest that it is before, and its weights
    Eigen::Vector3f weights = Eigen::Vector3f::Zero();
    std::uint32_t apart = 0; ///< in SkinRig::apart: one at each of the muscle's nodes, else one at rest
    Eigen::Vector3f facing = Eigen::Vector3f::Zero(); ///< SkinOnBody: of a muscle's surface there, unit
    float offset = 0; ///< signed distance that is kept, at most 0: the overlap at rest
};

/// The part of a skin that never changes. Immutable once made, shared between instances (SkinResponse) and
/// threads. Indices of vertices are into `vertices`, the touched ones; the rest of the skin stays as
/// modelled.
struct SkinRig {
    SkinParameters parameters;
    double size = 0; ///< diagonal of the skin's bounds, scene units; 1 where it has none
    Vec3 centre = Vec3::Zero();
    float radius = 0; ///< of the skin, in sizes: how far contact beside a rim fades

    std::vector<std::uint32_t>
        vertices;                     ///< indices into the skin mesh, near ones beside each other, then twins
    std::vector<Vec3> rest;           ///< places of the vertices, scene units
    std::vector<Vec3> restNormals;    ///< unit; of the mesh as it is wound
    bool inverted = false;            ///< it is wound inwards, which what follows is not
    std::vector<std::uint32_t> twins; ///< of each vertex at the place of another one that other, touched one
    std::vector<Tri> triangles;       ///< of touched vertices only
    std::vector<Tri> across;          ///< beyond each of their edges, -1: none
    Lists<SkinFan> fans;              ///< all at a touched vertex, into vertices then borderPlaces

    std::vector<Move> places, placeNormals; ///< rest and normals outward as the run time has them
    std::vector<Move> borderPlaces;         ///< of the untouched corners of fans
    /// Touched vertices move in blocks of this many.
    static constexpr std::size_t block = 16;
    Lists<std::uint32_t> around; ///< of each block it and those with a normal that hangs on it
    std::vector<SkinBody> bodies;
    std::size_t bodyVertices = 0;
    Lists<SkinPull> pulls; ///< of each vertex
    std::size_t frames = 0;
    Lists<SkinFrameShare> frameShares;                   ///< of each vertex
    std::vector<std::vector<std::uint32_t>> frameBlocks; ///< #frames, that it moves
    std::vector<SkinRow> rows;
    std::vector<SkinApart> apart;
    std::vector<int> starts;
    SkinFoundation foundation;
    SkinSpheres spheres; ///< of the faithful mode

    /// A pose in the skin's frame, scene units, as the run time has it.
    Pose local(const Pose& pose) const;
    std::size_t blocks() const { return (places.size() + block - 1) / block; }
    std::size_t bytes() const;
};

/// Throws InputError for parameters that makeSkinRig() would refuse over so many muscles and bones.
void checkSkin(const TriangleMesh& skin, std::size_t bodies, const SkinParameters& parameters);

/// Makes a rig. skin: the mesh the table was made for. bodies: muscles and bones in the order the table knows
/// them, in the skin's frame. Throws InputError when they do not fit each other.
std::shared_ptr<const SkinRig> makeSkinRig(const TriangleMesh& skin,
                                           const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                                           const SkinTable& table, const SkinParameters& parameters);

} // namespace tss
