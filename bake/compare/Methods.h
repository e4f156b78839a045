#pragma once
#include "bake/compare/CollisionMethod.h"
#include "bake/compare/MinBall.h"

#include <functional>
#include <memory>

/// The methods of METHOD 7, each made by one function and living in a file of its name. They keep what they
/// need by reference to the problem, which must outlive them.
namespace tss::compare {

// Spheres against spheres ------------------------------------------------------------------------------

/// All n x m sphere tests, in order, first hit out. Gap: all of them.
std::unique_ptr<CollisionMethod> makeAllPairs(const ComparedPair& problem);

/// The same in float, as many spheres of B at once as the machine's vectors hold.
std::unique_ptr<CollisionMethod> makeAllPairsSimd(const ComparedPair& problem);

/// The table's pairs as the paper runs them: through indices, scalar, first hit out.
std::unique_ptr<CollisionMethod> makePairList(const ComparedPair& problem);

/// The table by its plain query, with the gap.
std::unique_ptr<CollisionMethod> makePlainTable(const ComparedPair& problem);

/// The table as applications ask it: PreparedTable with the kernels of this machine.
std::unique_ptr<CollisionMethod> makeKernelTable(const ComparedPair& problem);

/// The same in float, whatever the table's epsilon; null where that is what it is anyway.
std::unique_ptr<CollisionMethod> makeFloatTable(const ComparedPair& problem);

enum class TreeOf {
    All, ///< the paper's case 1: every sphere
    Used ///< case 2: the spheres that the table uses
};

/// A tree over the spheres. arity 2, 4 or 8.
std::unique_ptr<CollisionMethod> makeSphereTree(const ComparedPair& problem, TreeOf of, int arity,
                                                Enclosure enclosure);

// Sphere trees made from the meshes --------------------------------------------------------------------

/// Octree: the circumscribed balls of the cubes that the surface passes, `levels` deep (Hubbard 1996;
/// Bradshaw and O'Sullivan 2004, their octree).
std::unique_ptr<CollisionMethod> makeOctree(const ComparedPair& problem, int levels);

/// Medial balls merged bottom up, 8 children a node (after Hubbard 1996).
std::unique_ptr<CollisionMethod> makeHubbard(const ComparedPair& problem, int levels);

/// Medial balls chosen anew for each region of the surface, top down (after Bradshaw and O'Sullivan 2004).
std::unique_ptr<CollisionMethod> makeAdaptiveMedial(const ComparedPair& problem, int levels);

/// Spheres that rest against surface points from inside (O'Rourke and Badler 1979), in a tree.
std::unique_ptr<CollisionMethod> makeOrourkeBadler(const ComparedPair& problem);

// Motion instead of shape ------------------------------------------------------------------------------

/// The answer at one pose, which the methods below sample when they are made.
using Oracle = std::function<bool(const PoseQuery&)>;
using GapOracle = std::function<double(const PoseQuery&)>;

/// Angular region of collision: the range of the leading DOF in which any of the samples collides is
/// contact, the rest is free.
std::unique_ptr<CollisionMethod> makeAngularRegion(const ComparedPair& problem, const Oracle& oracle,
                                                   int bins, int samples, std::uint64_t seed);

/// Slices of the leading DOF: where no sample collides the slice is free, where all do it is contact, and in
/// the others the method `inside` is asked.
std::unique_ptr<CollisionMethod> makeMixedRegion(const ComparedPair& problem, const Oracle& oracle, int bins,
                                                 int samples, std::uint64_t seed,
                                                 std::shared_ptr<const CollisionMethod> inside);

/// Allowed paths stored: along the leading DOF, for a grid of values of the others, the stretches that are
/// free. A query goes to the nearest path.
std::unique_ptr<CollisionMethod> makeAllowedPaths(const ComparedPair& problem, const Oracle& oracle,
                                                  int paths, int steps);

/// Gaps on a regular grid over Q with `points` values per DOF, linear between them.
std::unique_ptr<CollisionMethod> makeGapGrid(const ComparedPair& problem, const GapOracle& oracle, int points,
                                             const StatedError& ofOracle);

/// How far the farthest point of B's bounds moves from the one pose to the other, scene units.
double farthestMove(const ComparedPair& problem, const std::vector<double>& p, const std::vector<double>& q);

/// The DOF that moves the bodies most over its range.
std::size_t leadingDof(const ComparedPair& problem);

// Trees on the meshes ----------------------------------------------------------------------------------

/// FCL on the triangles. volume: of its trees, "obbrss", "obb" or "aabb".
std::unique_ptr<CollisionMethod> makeFcl(const ComparedPair& problem, const std::string& volume);

/// Bullet's GImpact, one pair of concave meshes, through its own dispatcher. Not to be shared by threads.
std::unique_ptr<CollisionMethod> makeGimpact(const ComparedPair& problem);

} // namespace tss::compare
