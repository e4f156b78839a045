#pragma once
#include "bake/compare/CollisionMethod.h"
#include "bake/compare/MeshTruth.h"
#include "bake/geometry/Solid.h"

namespace tss::reporting {

/// Poses with what the meshes say there. Poses at which a closed part of one body is wholly inside the other,
/// surfaces apart, are left out: that is no contact of the meshes, and contact for everything that fills
/// them. Depths and distances are found when first asked for and kept.
class JudgedPoses {
public:
    JudgedPoses(const compare::ComparedPair& problem, const compare::MeshTruth& truth,
                const std::vector<std::vector<double>>& values);

    const std::vector<compare::PoseQuery>& queries() const { return queries_; }
    std::size_t leftOut() const { return leftOut_; }
    bool touches(std::size_t pose) const { return touches_[pose] != 0; }
    std::size_t touching() const { return touching_; }

    /// Distance of the meshes at a free pose, scene units. This and depth() may be asked by several threads,
    /// each for other poses.
    double clearance(std::size_t pose) const;

    /// At how many of the free poses the meshes are nearer than this.
    std::size_t freeWithin(double distance) const;

    /// How deep the deepest vertex of one mesh lies inside the other at a touching pose: no more than the
    /// true depth, 0 where only edges cross.
    double depth(std::size_t pose) const;

private:
    const compare::ComparedPair& problem_;
    const compare::MeshTruth& truth_;
    Solid solidA_, solidB_;
    std::vector<compare::PoseQuery> queries_;
    std::vector<char> touches_;
    std::size_t touching_ = 0, leftOut_ = 0;
    mutable std::vector<double> known_; ///< depth or clearance, -1: not asked yet
};

/// What a method says wrongly on a set of poses (METHOD 8). Lengths in scene units.
struct ErrorFigures {
    std::size_t poses = 0;
    std::size_t touching = 0;
    std::size_t missed = 0; ///< false negatives
    std::size_t early = 0;  ///< false positives
    double deepestMiss = 0; ///< depth of the meshes at the worst of those looked at, see JudgedPoses
    double meanMiss = 0;
    double farthestEarly = 0; ///< clearance at which it fired
    double meanEarly = 0;
    bool sampled = false; ///< depths of some of the misses only, evenly taken
};

/// count: how many of the poses, from the first on. most: of how many misses the depth is measured at most.
ErrorFigures measureError(const compare::CollisionMethod& method, const JudgedPoses& poses, std::size_t count,
                          std::size_t most);

/// Where contact begins along a way from a free pose to a touching one, by the meshes and by a method.
struct ClosingMotion {
    std::vector<double> from, to;
    double contact = 0; ///< share of the way at which the meshes first touch
};

/// From the free to the touching poses of a set, in their order, as many as there are of both but not more
/// than `count`. Contact is looked for in `steps` steps and bisected.
std::vector<ClosingMotion> closingMotions(const compare::ComparedPair& problem,
                                          const compare::MeshTruth& truth, const JudgedPoses& poses,
                                          std::size_t count, int steps);

/// First-contact error of a method over closing motions: positive is early.
struct FirstContact {
    std::size_t motions = 0;
    std::size_t never = 0;           ///< the method saw no contact at all
    double worstAngle = 0;           ///< of the leading DOF, in its own unit (radians), absolute
    double meanAngle = 0;            ///< absolute
    double worstLength = 0;          ///< how far the farthest point of B moves in between, scene units
    double earliest = 0, latest = 0; ///< signed lengths: early and late by so much
};
FirstContact measureFirstContact(const compare::ComparedPair& problem, const compare::CollisionMethod& method,
                                 std::span<const ClosingMotion> motions, int steps);

} // namespace tss::reporting
