#pragma once
#include "bake/motion/BoneSwing.h"
#include "bake/motion/MuscleTrack.h"
#include "bake/respond/SkinSolver.h"
#include "bake/respond/SkinWeave.h"
#include "bake/table/SkinTable.h"

#include <memory>

namespace tss {

/// How a skin behaves (METHOD 6.3). Compliances are relative to the hold: every vertex of mean area is held
/// to its rest place by a spring of stiffness 1. Everything between 0 and 1e12 and beyond is stable.
struct SkinParameters {
    double stretchCompliance = 0; ///< of each edge, >= 0; 0: as stiff as the solver resolves (its floor)
    double bendCompliance = 0;    ///< of each vertex's Laplacian, >= 0; 0: the floor
    double fascia = 1;            ///< stiffness of the weak hold of skin on the muscle right below it, >= 0
    double attachment = 20;       ///< stiffness where attach is 1, >= 0
    std::vector<double> carry; ///< #muscles in [0,1], how firmly each carries skin at all; empty: 1. A body
                               ///< that only pushes has 0
    std::vector<BoneSwing> swings; ///< of the bones; the skin between them gives way over as long a way
    std::vector<double> tether;    ///< #V in [0,1], how firmly a vertex keeps its rest place; empty: 0
    std::vector<double> attach;    ///< #V in [0,1], how firmly the muscle below carries it; empty: falls off
                                   ///< smoothly around the end of the fibre that moves
    bool selfContact = false;      ///< the skin also keeps out of itself: lip against lip, lid against lid
    int iterations = 8;            ///< most sweeps an update over the constraints of what moves, >= 1
    bool faithful = false;         ///< [paper] spheres push spheres out, no elastic sheet
};

/// A hold of a skin vertex on a muscle.
struct SkinCarry {
    std::uint32_t vertex = 0; ///< index into SkinRig::vertices
    float pull = 0;           ///< share of the muscle's move that the vertex makes without any sheet, 0..1
};

/// How a muscle alone moves the skin through its holds, without contact, tabulated over its activation: the
/// problem is linear there, so muscles add up. Only vertices that it moves.
struct SkinDrag {
    std::vector<double> nodes;
    std::vector<std::uint32_t> vertices; ///< indices into SkinRig::vertices
    std::vector<Move> moves;             ///< #nodes blocks of #vertices, scene units
};

/// What a rig keeps of one muscle. Everything in the skin's frame.
struct SkinMuscle {
    std::vector<Tri> triangles;
    std::vector<Vec3> rest;         ///< #V
    MuscleTrack surface;            ///< #V of the muscle
    MuscleTrack spheres;            ///< the spheres of the table that are its own
    MuscleTrack skin;               ///< the skin vertices that it carries
    std::vector<double> radii;      ///< #spheres, at activation 0
    std::vector<int> behind;        ///< #spheres, the triangle nearest to each at activation 0
    std::vector<Tri> across;        ///< per triangle the one beyond each edge (k, k+1), -1: none
    std::vector<SkinCarry> carried; ///< one a point of `skin`
    SkinDrag drag;
};

/// A row of the table, as far as it meets one muscle: a skin vertex and its tests. And the muscle triangle
/// that it is in front of at each node of the muscle's drag, -1 where there is none.
struct SkinRow {
    std::uint32_t vertex = 0; ///< index into SkinRig::vertices
    std::uint32_t muscle = 0;
    std::uint32_t first = 0, last = 0; ///< range in SkinRig::tests
    std::uint32_t triangles = 0;       ///< in SkinRig::rowTriangles, one a node
    double radius = 0;
    bool met = false;      ///< some node of the drag has the muscle before it
    int restTriangle = -1; ///< that it is in front of at rest, -1: none is near
    Vec3 restWeights = Vec3::Zero();
    double restHeight = 0;
    Vec3 facing =
        Vec3::UnitZ(); ///< unit: the muscle's normal before it at rest, or its own where none is near
};

struct SkinTest {
    std::uint32_t sphere = 0; ///< index among the muscle's own
    double restGap = 0;
};

/// A muscle vertex that could poke through between skin vertices, with the skin triangle nearest to it at
/// each node of its muscle's drag, -1 where none is within reach.
struct SkinPoke {
    std::uint32_t muscle = 0, vertex = 0;
    std::uint32_t triangles = 0; ///< in SkinRig::pokeTriangles, one a node
    double radius = 0;
};

/// A skin vertex that may meet another part of the skin (SkinParameters::selfContact), and the triangles that
/// it was before somewhere in the motion.
struct SkinFold {
    std::uint32_t vertex = 0;          ///< index into SkinRig::vertices
    std::uint32_t first = 0, last = 0; ///< range in SkinRig::foldTriangles
};

/// The part of a skin that never changes: which vertices may move, what holds them, which tests they take.
/// Immutable once made, shared between instances (SkinResponse) and threads. Indices of vertices are into
/// `vertices`, the touched ones; the rest of the skin stays as modelled.
struct SkinRig {
    SkinParameters parameters;
    double size = 0;   ///< diagonal of the skin's bounds, scene units
    double travel = 0; ///< of the table

    std::vector<std::uint32_t> vertices;     ///< indices into the skin mesh, near ones beside each other
    std::vector<Vec3> rest;                  ///< places of the touched vertices
    std::vector<Vec3> restNormals;           ///< unit
    SkinSheet sheet;                         ///< of the touched vertices; a fixed rim has inverse mass 0
    SheetPatch contactPatch;                 ///< the part of the sheet that contacts, and poses, move
    std::vector<std::uint32_t> contactIndex; ///< of each touched vertex in it, or `outside`
    static constexpr std::uint32_t outside = 0xffffffff;
    SkinWeave weave;                  ///< of the touched vertices; empty in the faithful mode
    std::vector<Tri> triangles;       ///< of touched vertices only
    std::vector<Tri> normalTriangles; ///< all that bear on a normal, into vertices then border
    std::vector<Vec3> border;         ///< places of the untouched corners of normalTriangles

    std::vector<SkinMuscle> muscles;
    std::vector<SkinRow> rows;
    std::vector<SkinTest> tests;
    std::vector<SkinPoke> pokes;
    std::vector<int> rowTriangles;  ///< into the triangles of the row's muscle
    std::vector<int> pokeTriangles; ///< into `triangles`
    std::vector<Tri> across;        ///< per triangle the one beyond each edge (k, k+1), -1: none
    std::vector<SkinFold> folds;
    std::vector<std::uint32_t> foldTriangles; ///< into `triangles`
    double foldRadius = 0, foldReach = 0; ///< scene units: how far contact across a fold fades, and is seen

    std::vector<double>
        rowOffsets; ///< signed distance that each row keeps, found by the run-time look-up at rest
    std::vector<double> pokeOffsets; ///< the same for the pokes
    std::vector<double> foldOffsets; ///< the same for the folds, at most 0: what touches may touch
};

/// Unit normals of all vertices, weighted by area: those of SkinResponse at rest.
std::vector<Vec3> skinNormals(const TriangleMesh& skin);

/// What muscles and bones do to the vertices of a skin, as SkinSearchOptions wants it: one list a muscle, #V
/// each.
struct SkinMoves {
    std::vector<std::vector<double>> stray;  ///< how far the contraction of the others may move the vertex
    std::vector<std::vector<double>> shares; ///< of the muscle's move that the vertex makes
};
SkinMoves skinMoves(const TriangleMesh& skin,
                    const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
                    const SkinParameters& parameters, double thickness);

/// Makes a rig. skin: the mesh the table was made for. muscles: in the order the table knows them, in the
/// skin's frame. Throws InputError when they do not fit each other.
std::shared_ptr<const SkinRig> makeSkinRig(const TriangleMesh& skin,
                                           const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
                                           const SkinTable& table, const SkinParameters& parameters);

} // namespace tss
