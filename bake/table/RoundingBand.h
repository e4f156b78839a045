#pragma once
#include "bake/motion/Motion.h"

#include <span>

namespace tss {

/// Unit roundoffs.
inline constexpr double floatRoundoff = 0x1p-24, doubleRoundoff = 0x1p-53;

/// The range of lengths that is supported, scene units: their squares and sums of these must be floats.
inline constexpr double shortestLength = 1e-12, longestLength = 1e15;

/// Bound of the rounding error of constant + sum_k w_k f_k summed in that order with weights, features and
/// constant each rounded once, with or without fused products (METHOD 4, Float). products: |w_k| max |f_k|
/// for each k in the order of summation; result: the largest |sum| of interest, which bounds the late partial
/// sums. The error of values whose exact |sum| is larger is not bounded by this.
double sumError(double u, double constant, std::span<const double> products, double result);

/// What underflow adds to the error of a sum of so many products in numbers of roundoff u: a product below
/// the least normal number may become 0. factors: the sum of the magnitudes of all factors. Infinite where
/// one of them may overflow.
double rangeError(double u, double products, double factors);

/// sumError() for a sum of 12 + 3 products as the direct kernel takes it: |R b + t - a|^2 -
/// contactDistance^2, with lengths of a, b and t as given, for squared distances up to distance^2.
double directError(double u, double a, double b, double t, double distance, double contactDistance);

/// At every pose within the limits |T(q) y| <= |y| + this, for every point y of B.
double motionSize(const Motion& motion);

/// A bound of the error of T(q) y computed with roundoff u, in whatever order the DOFs' matrices are
/// multiplied; axes far from the bodies make it large. farthest: bound of |y|, and of the distance of each
/// origin that coordinates are relative to from the origin of its body's frame.
double poseError(const Motion& motion, double u, double farthest);

/// A bound of how far the rounding of angles misplaces a point of B, for angles more than 8 radians from the
/// middle of their limits; up to that the other bounds here include it. 0 where no angle is farther from the
/// middle.
double turnError(const Motion& motion, const Vec3& point);

/// A bound of the error of a gap sqrt(d^2) - contactDistance whose d^2 has the error `error`, for gaps up to
/// |gap|.
double gapBand(double u, double error, double contactDistance, double gap);

/// The largest |gap| at which d^2 - contactDistance^2, off by up to `error`, may have the wrong sign.
double signBand(double error, double contactDistance);

} // namespace tss
