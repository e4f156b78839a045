#pragma once
#include "bake/motion/MotionFrame.h"
#include "bake/table/TablePairs.h"

#include <span>
#include <vector>

namespace tss {

/// Bounds of the gaps of sphere pairs over boxes of DOF values, to second order in the box's size. Keeps
/// references to the motion and the pairs.
class GapRanges {
public:
    GapRanges(const Motion& motion, std::span<const TablePair> pairs);

    /// A relative widening of boxes that is inside the bounds: for rounding when a box is looked up.
    static constexpr double wider = 1e-6;

    struct Range {
        double low = 0, high = 0; ///< scene units; rounding is inside
    };
    /// Of pair p over the box `half` wide on each side of the values that `frame` was made for, and a little
    /// wider: by what values as large as the limits may round.
    Range range(std::size_t p, const MotionFrame& frame, const DofValues& half) const;

    /// The most that a pair's gap changes per unit of DOF k, over all pairs.
    double weight(std::size_t k) const { return weights_[k]; }
    /// The most that gaps can change over the limits.
    double wholeMove() const;
    /// What rounding may add to a gap.
    double slack() const { return slack_; }
    /// The median of the reaches, by absolute value.
    double middleReach() const { return middleReach_; }

private:
    const Motion& motion_;
    std::span<const TablePair> pairs_;
    std::size_t dofs_;
    std::vector<double> speeds_;           ///< #pairs by #DOFs
    std::vector<double> turns_, rounding_; ///< one per DOF; of its values
    bool paths_ = false;
    DofValues weights_{};
    double slack_ = 0, middleReach_ = 0;
};

} // namespace tss
