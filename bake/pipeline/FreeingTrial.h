#pragma once
#include "bake/base/Stopwatch.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/pipeline/FreeingMove.h"

#include <Eigen/Core>

namespace tss {

/// A move to try: the shift of B in its own frame, then that of the joint's axes in A's frame, scene units.
using JointMove = Eigen::Matrix<double, 6, 1>;

/// Tries moves of B and of the joint's axes: whether they bring two bodies apart at poses spread over the
/// limits.
class FreeingTrial {
public:
    /// seconds: the time limit; after it no pose counts as free any more.
    FreeingTrial(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double seconds);

    bool late() const { return watch_.seconds() > seconds_; }

    double size() const { return size_; } ///< bounding diagonal of the smaller body, scene units
    bool overlapsAtRest() const;
    std::optional<TouchingElsewhere> touchingElsewhere() const;
    std::optional<ApartElsewhere> apartElsewhere() const;

    /// #poses: whether the bodies meet there at other places than where they overlap at rest.
    const std::vector<char>& stops() const { return stops_; }

    /// Whether the move frees all wanted poses; stops at the first that is not free. wanted: #poses.
    bool frees(const JointMove& move, const std::vector<char>& wanted);
    /// How many of the wanted poses are free.
    std::size_t countFree(const JointMove& move, const std::vector<char>& wanted) const;

    /// How far the move displaces B: root mean square over the poses, scene units.
    double displacement(const JointMove& move) const;

    /// The joint's motion with the move.
    Motion movedMotion(const JointMove& move) const;
    FreeingMove measured(const JointMove& move) const;

    /// Looks at poses between, along each DOF by itself, and adds those that the move does not free though
    /// the nearest pose is wanted. Returns how many.
    std::size_t addBlocked(const JointMove& move, std::vector<char>& wanted);

private:
    bool touches(std::size_t pose) const;
    void addSweeps(int steps, std::vector<std::vector<double>>& into) const;
    /// The sum over the DOFs of the difference of two poses, as a share of the DOF's range.
    double poseDistance(const std::vector<double>& p, const std::vector<double>& q) const;
    void findStops(const TriangleMesh& a, const TriangleMesh& b);
    std::vector<StopBeyond> stopsBeyond(const Motion& motion) const;

    const Stopwatch watch_;
    const double seconds_;
    MeshQuery a_, b_;
    Motion motion_;
    double size_, margin_;
    std::vector<std::vector<double>> values_; ///< #poses: DOF values, rest first
    std::vector<Pose> unmoved_;               ///< #poses: of B without a move
    std::vector<char> stops_;                 ///< #poses
    std::vector<std::size_t>
        order_;                  ///< in which frees() tries poses: the one that was blocked last comes first
    std::size_t firstPoses_ = 0; ///< number of poses without those of addBlocked(); measured() counts these
};

} // namespace tss
