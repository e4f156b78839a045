#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/pipeline/FreeingMove.h"

#include <Eigen/Core>

#include <chrono>

namespace tss {

/// What is moved: the shift of B, then that of the axes.
using JointMove = Eigen::Matrix<double, 6, 1>;

/// Two bodies at poses spread over the limits of their joint, tried with its B and its axes moved.
class FreeingTrial {
public:
    /// seconds: for all of it; later no pose counts as free any more.
    FreeingTrial(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double seconds);

    bool late() const { return Clock::now() - start_ > std::chrono::duration<double>(seconds_); }

    double size() const { return size_; }     ///< bounding diagonal of the smaller body
    double margin() const { return margin_; } ///< what counts as apart
    std::size_t poseCount() const { return values_.size(); }
    bool overlapsAtRest() const;
    std::optional<TouchingElsewhere> touchingElsewhere() const;
    std::optional<ApartElsewhere> apartElsewhere() const;

    /// For each pose whether the bodies meet there elsewhere than where they overlap at rest.
    const std::vector<char>& stops() const { return stops_; }

    /// The poses wanted are free; stops at the first that is not.
    bool frees(const JointMove& move, const std::vector<char>& wanted);
    std::size_t freeOf(const JointMove& move, const std::vector<char>& wanted) const;

    /// By how much B lies elsewhere than without the move: root of the mean square over the poses.
    double moved(const JointMove& move) const;

    Motion moveMotion(const JointMove& move) const;
    FreeingMove measured(const JointMove& move) const;

    /// Adds those of many more poses, along each DOF by itself, that are wanted and not free, as long as
    /// their neighbours are wanted. Returns how many.
    std::size_t addMissed(const JointMove& move, std::vector<char>& wanted);

private:
    using Clock = std::chrono::steady_clock;

    bool touches(std::size_t pose) const;
    void addSweeps(int steps, std::vector<std::vector<double>>& into) const;
    /// How far apart values of the joint are, as shares of its limits, added up.
    double apartInLimits(const std::vector<double>& p, const std::vector<double>& q) const;
    void findStops(const TriangleMesh& a, const TriangleMesh& b);
    std::vector<StopBeyond> stopsBeyond(const Motion& motion) const;

    const Clock::time_point start_ = Clock::now();
    const double seconds_;
    MeshQuery a_, b_;
    Motion motion_;
    double size_, margin_;
    std::vector<std::vector<double>> values_; ///< of the poses, rest first
    std::vector<Pose> unmoved_;
    std::vector<char> stops_;
    std::vector<std::size_t> order_; ///< of trying poses: what was in the way last comes first
    std::size_t lookedAt_ = 0;       ///< poses from the beginning that measured() counts
};

} // namespace tss
