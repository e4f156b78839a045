#include "bake/table/GapRanges.h"

#include "bake/base/Order.h"
#include "bake/table/RoundingBand.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

GapRanges::GapRanges(const Motion& motion, std::span<const TablePair> pairs)
    : motion_(motion), pairs_(pairs), dofs_(motion.dofCount()) {
    for (const Dof& dof : motion.dofs) {
        turns_.push_back(turnBound(dof));
        rounding_.push_back(4 * std::numeric_limits<double>::epsilon() *
                            std::max(std::abs(dof.lower), std::abs(dof.upper)));
        paths_ = paths_ || dof.kind == DofKind::Path;
    }
    speeds_.resize(pairs.size() * dofs_);
    std::vector<double> reaches;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        speedBounds(motion, pairs[p].b, &speeds_[p * dofs_]);
        for (std::size_t k = 0; k < dofs_; ++k) weights_[k] = std::max(weights_[k], speeds_[p * dofs_ + k]);
        reaches.push_back(std::abs(pairs[p].contactDistance));
        slack_ = std::max(slack_, pairs[p].a.norm() + pairs[p].b.norm() + reaches.back());
    }
    slack_ = 1e-13 * (slack_ + motionSize(motion));
    if (!reaches.empty()) middleReach_ = median(reaches);
}

double GapRanges::wholeMove() const {
    double move = 0;
    for (std::size_t k = 0; k < dofs_; ++k)
        move += weights_[k] * (motion_.dofs[k].upper - motion_.dofs[k].lower);
    return move;
}

GapRanges::Range GapRanges::range(std::size_t p, const MotionFrame& frame, const DofValues& given) const {
    DofValues half{};
    for (std::size_t k = 0; k < dofs_; ++k) half[k] = given[k] + rounding_[k];
    const TablePair& pair = pairs_[p];
    const double* speed = &speeds_[p * dofs_];
    const Vec3 centre = frame.pose * pair.b, apart = centre - pair.a;
    const double distance = apart.norm(), gap = distance - pair.contactDistance;
    double move = 0;
    for (std::size_t k = 0; k < dofs_; ++k) move += speed[k] * half[k];
    const double off = move * wider + slack_;
    Range found{gap - move - off, gap + move + off};
    if (paths_ || !(distance > move)) return found;
    // To second order: a gap bends down no more than its point's way does, and up by what goes past it.
    double slope = 0, bend = 0, turning = 0;
    for (std::size_t k = 0; k < dofs_; ++k) {
        slope += std::abs(apart.dot(frame.twists[k].velocity(centre))) * half[k];
        const double turn = turns_[k] * half[k];
        bend += speed[k] * half[k] * (turn + 2 * turning);
        turning += turn;
    }
    slope /= distance;
    found.low = std::max(found.low, gap - slope - 0.5 * bend - off);
    found.high = std::min(found.high, gap + slope + 0.5 * (bend + move * move / (distance - move)) + off);
    return found;
}

} // namespace tss
