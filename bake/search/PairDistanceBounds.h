#pragma once
#include "bake/motion/MotionBound.h"

#include <cmath>

namespace tss {

/// A sphere pair at the centre of a cell, with what bounds its distance over the whole cell. x is the centre
/// of the sphere of B in A's frame; with y = x - c_i:
///   |y| - move                               <= |y(q)| <= |y| + move
///   |y|^2 - 2|slope|.h - 2|y| remainder      <= |y(q)|^2 <= |y|^2 + 2|slope|.h + 2|y| remainder + move^2
/// mostDofs: of the cell, room for the slope.
template <std::size_t mostDofs = maxDofs>
struct PairDistanceBounds {
    Vec3 x, y;
    double squared, distance; ///< |y|^2 and |y|
    double move, remainder;
    double tilt;                        ///< |slope| . h
    std::array<double, mostDofs> slope; ///< y . J: half the slope of |y|^2

    PairDistanceBounds(const CellMotion& cell, const Vec3& x, const CellMotion::PointMotion& moved,
                       const Vec3& centreA)
        : x(x), y(x - centreA), squared(y.squaredNorm()), distance(std::sqrt(squared)), move(moved.move),
          remainder(moved.remainder), tilt(0) {
        cell.slope(x, y, slope.data());
        for (std::size_t k = 0; k < cell.dofs(); ++k) tilt += std::abs(slope[k]) * cell.half(k);
    }

    /// The pair's distance is larger than this all over the cell, whatever rounding did. limit >= 0.
    /// rounding: coordinateRounding() of the motion.
    bool staysAbove(double limit, double rounding) const {
        return distance - move > limit + rounding ||
               squared - 2 * tilt - 2 * distance * remainder - roundingOfSquares(limit, rounding) >
                   limit * limit;
    }
    /// The pair's distance is smaller than this all over the cell, whatever rounding did.
    bool staysBelow(double limit, double rounding) const {
        return limit > 0 && (distance + move + rounding < limit ||
                             squared + 2 * tilt + 2 * distance * remainder + move * move +
                                     roundingOfSquares(limit, rounding) <
                                 limit * limit);
    }

private:
    /// The error of a squared length, scene units squared, where each length that it is made of, a lever
    /// after half a turn among them, is off by at most `rounding`.
    double roundingOfSquares(double limit, double rounding) const {
        return 16 * rounding * (distance + move + limit + rounding);
    }
};

} // namespace tss
