#pragma once
#include "bake/bind/SkinNormals.h"
#include "bake/bind/SkinParameters.h"
#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleTrack.h"
#include "bake/motion/PoseBlend.h"
#include "bake/respond/SkinFoundation.h"
#include "bake/table/Table.h"

#include <memory>

namespace tss {

/// A place or a displacement: x, y, z, and 0 unless a fourth value is named. "Run-time lengths" are floats in
/// units of the skin's size (SkinRig::size), places counted from its centre.
using Move = Eigen::Vector4f;

/// A muscle or a bone at run time, run-time lengths.
struct SkinBody {
    std::uint32_t first = 0, count = 0; ///< range of its vertices among those of all bodies
    std::vector<Tri> triangles;
    std::vector<Tri> across;           ///< per triangle: the neighbour beyond edge (k, k+1), -1: none
    std::vector<double> nodes;         ///< rising activations at which it is tabulated; one: a bone
    std::size_t restNode = 0;          ///< that of activation 0
    std::vector<Move> rest;            ///< #count vertices at activation 0, in the skin's frame
    std::vector<Move> places, normals; ///< #nodes blocks of #count: vertices and unit normals
    std::vector<float> room; ///< of a muscle, #count: radius of the ball inside that touches it there at rest
    std::vector<std::uint32_t> blocks;                ///< blocks of skin vertices that it displaces
    int frame = -1;                                   ///< see SkinParameters::frames
    std::vector<int> chain;                           ///< see SkinParameters::chains
    std::shared_ptr<const MuscleSpan> span;           ///< null where the chain is empty
    std::shared_ptr<const TriangleMesh> mesh;         ///< of a bone; null: a muscle
    std::shared_ptr<const ClosestPointQuery> locator; ///< on `mesh`

    bool bone() const { return mesh != nullptr; }
};

/// The two sides of a possible contact: a vertex against a surface.
enum class SkinContactKind : std::uint8_t {
    SkinOnBody, ///< a skin vertex against a body's surface
    BodyOnSkin, ///< a body's vertex against the skin, from below
    SkinOnSkin, ///< a skin vertex against another part of the skin
};

/// A possible contact of a vertex with a surface. Queries start from triangles tabulated here rather than
/// from the last result, so that the response has no history.
struct SkinRow {
    std::uint32_t vertex = 0; ///< of the skin; BodyOnSkin: among those of all bodies
    std::uint32_t body = 0;
    std::uint32_t first = 0,
                  last = 0; ///< start triangles of the query: range in SkinRig::starts; the anchor,
                            ///< the point of the surface that the vertex faces at rest, is in the first
    SkinContactKind kind = SkinContactKind::SkinOnBody;
    bool insideAtRest = false; ///< the vertex is on the wrong side of the surface at rest already, and is
                               ///< only kept from getting deeper
    bool fromOutside = false;  ///< SkinOnBody of a bone: that lies before the outer side of the skin at rest,
                               ///< as teeth do before the lining of a lip
    bool flipped = false; ///< the surface overlaps itself, and its side next to the vertex is wound the wrong
                          ///< way round: its normal counts negative
    Eigen::Vector3f weights{1 / 3.0f, 1 / 3.0f, 1 / 3.0f}; ///< of the anchor, barycentric
    std::uint32_t clearance = 0; ///< first in SkinRig::clearances: one per start, at each node of its muscle,
                                 ///< else at rest
    Eigen::Vector3f facing = Eigen::Vector3f::Zero(); ///< SkinOnBody: unit normal at the anchor at rest
    float offset = 0; ///< least signed distance to keep, <= 0: the overlap at rest, run-time lengths
};

/// The part of a skin that never changes. Immutable once made, shared between instances (SkinResponse) and
/// threads. "Touched" vertices are those that anything can move, or whose normals turn; indices of vertices
/// are into `vertices`, which lists them. The rest of the skin stays as modelled.
struct SkinRig {
    SkinParameters parameters;
    double size = 0; ///< diagonal of the skin's bounds, scene units; 1 where it has none
    Vec3 centre = Vec3::Zero();
    float radius = 0; ///< thickness of the skin, run-time length: over which contact beside a rim fades out

    std::vector<std::uint32_t> vertices; ///< indices into the skin mesh, in the order of a space-filling
                                         ///< curve, then twins
    std::vector<Vec3> rest;              ///< positions of the vertices, scene units
    std::vector<Vec3> restNormals;       ///< unit, by the mesh's own winding
    bool inverted = false;               ///< the mesh is wound inwards; all members below are as if outwards
    std::vector<std::uint32_t> twins; ///< for each of the last vertices, duplicates along seams: the one at
                                      ///< the same position that it follows
    std::vector<Tri> triangles;       ///< those of touched vertices only, by their first corners
    std::vector<Tri> across;          ///< per triangle: the neighbour beyond edge (k, k+1), -1: none
    Lists<std::uint32_t> rings; ///< skinRings() of touched vertices; those of vertices, then borderPlaces

    std::vector<Move> places, placeNormals; ///< rest positions and outward normals, run-time lengths
    std::vector<Move> borderPlaces;         ///< untouched corners of rings, run-time lengths
    /// Touched vertices are updated in blocks of this many.
    static constexpr std::size_t block = 16;
    Lists<std::uint32_t> around; ///< per block: the blocks whose normals depend on it, itself included
    std::vector<SkinBody> bodies;
    std::size_t bodyVertices = 0; ///< of all bodies together
    Lists<SkinEntry> pulls; ///< per vertex: of all bodies' vertices those whose displacements are added to
                            ///< its own, and by what share
    std::size_t frames = 0;
    Lists<SkinEntry> frameShares;                        ///< per vertex: frames and their skinning weights
    std::vector<std::vector<std::uint32_t>> frameBlocks; ///< #frames: blocks that each moves
    std::vector<SkinRow> rows;                           ///< all possible contacts
    /// Of the rows: where the vertex is against one start of the row at one node of its muscle's activation,
    /// everything else at rest, so that mayTouch() rules out contact without a query. x, y, z: offset from
    /// the start to the vertex. w, with the row's first start: gap of the row; while the offset from no start
    /// differs by more than a share of it, here or between this node and the next, the two do not touch.
    std::vector<Move> clearances;
    std::vector<int> starts; ///< start triangles of the rows' queries
    SkinFoundation foundation;
    Lists<std::uint32_t> nodeBlocks; ///< per node of it: blocks that it moves

    /// A pose in the skin's frame, scene units, as the run time has it.
    Pose local(const Pose& pose) const;
    std::size_t blocks() const { return (places.size() + block - 1) / block; }
    /// The first vertex of a block, and the one after its last.
    std::pair<std::size_t, std::size_t> verticesOf(std::size_t b) const {
        return {b * block, std::min((b + 1) * block, places.size())};
    }
    std::size_t bytes() const;
};

/// Makes a rig. skin: the mesh the table was made for. bodies: muscles and bones in the order the table knows
/// them, in the skin's frame. Throws InputError when they do not fit each other.
std::shared_ptr<const SkinRig> makeSkinRig(const TriangleMesh& skin,
                                           const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                                           const SkinTable& table, const SkinParameters& parameters);

} // namespace tss
