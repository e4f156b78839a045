#pragma once
#include "bake/geometry/SurfacePart.h"
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tss {

/// Where the meshes of two jointed bodies overlap at rest: the parts of their surfaces between which contact
/// is exempt (METHOD 2.4). Contact of a part of `a` with a part of `b` is exempt; of either with anything
/// else it counts. Empty where the meshes are apart at rest, and where no exception is made.
struct RestRegion {
    std::vector<SurfacePart> a, b; ///< sorted, none twice and none inside another
    double depth = -1; ///< these parts touch when their spheres are deeper in each other than this, scene
                       ///< units; < 0: never (they are left out)

    bool empty() const { return a.empty() && b.empty(); }
};

/// How well the spheres of one body fit its mesh, over its whole surface, or over the contact zone when the
/// table was made from one (METHOD 1.5). Lengths in scene units; none: not known.
struct FitRecord {
    std::optional<double> coverage; ///< bound: no surface point is farther than this from the spheres' union
    std::optional<double> protrusion; ///< bound: no sphere sticks out of the solid by more than this
    std::optional<double> coverageMean, coverageP95;     ///< over the surface, sampled
    std::optional<double> protrusionMean, protrusionP95; ///< of the bounds of the spheres
    std::optional<double> volumeRatio;                   ///< union of the spheres to the whole body
};

/// What went into a table, for those who read about it; the query does not use it.
struct BakeRecord {
    std::uint64_t spheresA = 0; ///< generated (the paper's Ms)
    std::uint64_t spheresB = 0;
    std::uint64_t candidatePairs = 0; ///< pairs that can meet (the paper's Tc); 0: not counted
    std::uint64_t lowerBound = 0;     ///< no table with the same answers has fewer tests; 0: not known
    FitRecord fitA, fitB;
};

/// A Tabulated Sphere Subset (TSS): the few sphere pairs of two bodies that answer for all of them over every
/// pose the motion allows. Immutable once made; shared between threads and instances.
struct Table {
    SphereSet a; ///< the used spheres of body A, in A's frame
    SphereSet b; ///< the used spheres of body B, in B's frame

    /// CSR: the spheres of B to test against sphere i of A are columns[rowOffsets[i] .. rowOffsets[i+1]).
    std::vector<std::uint32_t> rowOffsets{0}; ///< #a + 1, starts at 0, never falls, ends at columns.size()
    std::vector<std::uint32_t> columns;       ///< < #b

    /// Per test: the gap below which it counts as contact; 0, or of spheres of the region that overlaps at
    /// rest -restRegion.depth (METHOD 2.4), each plus epsilon, so that no contact is missed by it (3.5).
    /// Empty: all 0.
    std::vector<double> restGaps;

    Motion motion; ///< the motion and limits it was made for

    double epsilon = 0;   ///< gap of the table <= gap of the sphere models + epsilon, at every pose (3.3)
    double gapDepth = 0;  ///< gap-true down to this depth ...
    double gapMargin = 0; ///< ... and up to this clearance (3.4); both 0: a yes/no table
    std::optional<double> boundMiss; ///< where the meshes touch the gap is no larger; 0: no contact is missed
    std::optional<double> boundEarly; ///< contact is reported only when the meshes are this near
    bool certified = false;           ///< the bounds hold for every pose of the limits, not for samples
    std::string method;               ///< how it was made, e.g. "medial/certified/cover"
    BakeRecord record;
    RestRegion restRegion; ///< parts of the surfaces that the bounds say nothing about

    std::size_t testCount() const { return columns.size(); }
};

/// A proof that the two bodies cannot meet anywhere in Q: no table, no callback.
struct NeverCollides {
    double clearance = 0;    ///< the surfaces stay farther apart than this at every pose, > 0
    std::uint64_t cells = 0; ///< cells of Q that the proof took
    std::string method;
    BakeRecord record;
    RestRegion restRegion; ///< parts of the surfaces that the proof says nothing about
};

/// Row and column of each test, in order.
struct SpherePair {
    std::uint32_t a = 0, b = 0;
    friend auto operator<=>(const SpherePair&, const SpherePair&) = default; // NOLINT(modernize-use-nullptr)
};
std::vector<SpherePair> tests(const Table& table);

/// Which spheres makeTable() keeps.
enum class Keep { Used, All };

/// Makes the CSR of a table from pairs of indices into whole sphere sets, the kept spheres in rising order of
/// their index. usedA, usedB when given receive the index in the whole set of each kept sphere. restGaps (one
/// a pair, or empty) follow their pairs.
Table makeTable(const SphereSet& a, const SphereSet& b, const std::vector<SpherePair>& pairs,
                const std::vector<double>& restGaps, const Motion& motion,
                std::vector<std::uint32_t>* usedA = nullptr, std::vector<std::uint32_t>* usedB = nullptr,
                Keep keep = Keep::Used);

/// How many spheres of each body some test names.
struct UsedSpheres {
    std::size_t a = 0, b = 0;
};
UsedSpheres usedSpheres(const Table& table);

/// Bytes of its spheres, rows, columns and rest gaps.
std::size_t tableBytes(const Table& table);

/// A bound of the distance of the two solids, openings filled, where contact is reported: both protrusions
/// and epsilon. It bounds the distance of the surfaces too, unless one body stands wholly inside the other;
/// Table::boundEarly holds in that case as well. None: not known.
inline std::optional<double> earlyOfSolids(const Table& table) {
    const std::optional<double> a = table.record.fitA.protrusion, b = table.record.fitB.protrusion;
    if (!table.certified || !a || !b) return std::nullopt;
    return *a + *b + table.epsilon;
}

/// The same where that is known, else boundEarly.
inline std::optional<double> earlyOfTable(const Table& table) {
    const std::optional<double> solids = earlyOfSolids(table);
    return solids ? solids : table.boundEarly;
}

/// The table of a skin over muscles: which skin spheres some muscle sphere can come to (METHOD 6.2). Skin
/// that is in no row is not touched at all.
struct SkinTable {
    Table table; ///< a: skin spheres, b: muscle spheres at activation 0, both in the skin's frame; no DOFs
    std::vector<std::uint32_t> skinVertices; ///< #a: the skin vertex that each skin sphere rides on
    std::vector<std::uint32_t> muscleOf;     ///< #b: index in the skin's list of muscles
    double travel =
        0; ///< how far a skin vertex may stray from rest for the table to be complete, scene units
};

} // namespace tss
