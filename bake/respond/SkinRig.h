#pragma once
#include "bake/motion/MuscleTrack.h"
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
    std::vector<double> tether;   ///< #V in [0,1], how firmly a vertex keeps its rest place; empty: 0
    std::vector<double> attach;   ///< #V in [0,1], how firmly the muscle below carries it; empty: falls off
                                  ///< smoothly around the end of the fibre that moves
    int iterations = 12;          ///< sweeps over all constraints an update, >= 1
    bool faithful = false;        ///< [paper] spheres push spheres out, no elastic sheet
};

/// A hold of a skin vertex on a muscle.
struct SkinCarry {
    std::uint32_t vertex = 0; ///< index into SkinRig::vertices
    std::uint32_t point = 0;  ///< index into the muscle's skin track
    double share = 0;         ///< of this muscle in where the vertex is looked for, 0..1
    double stiffness = 0;     ///< relative to the hold
};

/// What a rig keeps of one muscle. Everything in the skin's frame.
struct SkinMuscle {
    std::vector<Tri> triangles;
    MuscleTrack surface;                    ///< #V of the muscle
    MuscleTrack spheres;                    ///< the spheres of the table that are its own
    MuscleTrack skin;                       ///< the skin vertices that it carries
    std::vector<double> radii;              ///< #spheres, at activation 0
    std::vector<std::uint32_t> behindStart; ///< #spheres + 1, CSR:
    std::vector<std::uint32_t> behind;      ///< ... triangles that reach into each sphere
    std::vector<SkinCarry> carried;
};

/// A row of the table: a skin vertex and its tests, grouped by muscle.
struct SkinRow {
    std::uint32_t vertex = 0;          ///< index into SkinRig::vertices
    std::uint32_t first = 0, last = 0; ///< range in SkinRig::tests
    double radius = 0;
};

struct SkinTest {
    std::uint32_t muscle = 0, sphere = 0; ///< sphere: index among the muscle's own
    double restGap = 0;
};

/// A muscle vertex that could poke through between skin vertices.
struct SkinPoke {
    std::uint32_t muscle = 0, vertex = 0;
    std::uint32_t first = 0, last = 0; ///< range in SkinRig::pokeTriangles
    double radius = 0;
};

struct SkinEdge {
    std::uint32_t i = 0, j = 0;
    Vec3 direction; ///< unit, at rest
    double compliance = 0;
};

struct SkinBend {
    std::uint32_t centre = 0, first = 0, last = 0; ///< ring: range in SkinRig::ring
    double compliance = 0, weight = 0;             ///< weight: sum of w times gradient squared
};

/// The part of a skin that never changes: which vertices may move, what holds them, which tests they take.
/// Immutable once made, shared between instances (SkinResponse) and threads. Indices of vertices are into
/// `vertices`, the touched ones; the rest of the skin stays as modelled.
struct SkinRig {
    SkinParameters parameters;
    double size = 0;   ///< diagonal of the skin's bounds, scene units
    double travel = 0; ///< of the table

    std::vector<std::uint32_t> vertices; ///< rising; indices into the skin mesh
    std::vector<Vec3> rest;              ///< places of the touched vertices
    std::vector<Vec3> restNormals;       ///< unit
    std::vector<double> inverseMass;     ///< with holds, tethers and attachments; 0 for the fixed rim
    std::vector<Tri> triangles;          ///< of touched vertices only
    std::vector<Tri> normalTriangles;    ///< all that bear on a normal, into vertices then border
    std::vector<Vec3> border;            ///< places of the untouched corners of normalTriangles

    std::vector<SkinMuscle> muscles;
    std::vector<SkinRow> rows;
    std::vector<SkinTest> tests;
    std::vector<SkinPoke> pokes;
    std::vector<std::uint32_t> pokeTriangles; ///< into triangles

    std::vector<SkinEdge> edges;
    std::vector<SkinBend> bends;
    std::vector<std::uint32_t> ring;

    std::vector<double>
        rowOffsets; ///< signed distance that each row keeps, found by the run-time look-up at rest
    std::vector<double> pokeOffsets; ///< the same for the pokes
};

/// Makes a rig. skin: the mesh the table was made for. muscles: in the order the table knows them, in the
/// skin's frame. Throws InputError when they do not fit each other.
std::shared_ptr<const SkinRig> makeSkinRig(const TriangleMesh& skin,
                                           const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
                                           const SkinTable& table, const SkinParameters& parameters);

} // namespace tss
