#pragma once
#include "bake/motion/Motion.h"

#include <span>

namespace tss {

/// Unit roundoffs.
inline constexpr double floatRoundoff = 0x1p-24, doubleRoundoff = 0x1p-53;

/// Lengths that are served, scene units: kernels in float square them, and add up some.
inline constexpr double shortestLength = 1e-12, longestLength = 1e15;

/// Bound of the rounding error of constant + sum_k w_k f_k summed in that order with weights, features and
/// constant each rounded once, with or without fused products (METHOD 4, Float). products: |w_k| max |f_k|
/// for each k in the order of summation; result: the largest |sum| of interest, which bounds the late partial
/// sums. The error of values whose exact |sum| is larger is not bounded by this.
double sumError(double u, double constant, std::span<const double> products, double result);

/// What the range of numbers of roundoff u adds to the error of a sum of so many products: those below the
/// least normal number may become 0. factors: the sum of the magnitudes of all factors; infinite where one
/// may be so large that floats do not hold it.
double rangeError(double u, double products, double factors);

/// sumError() for a sum of 12 + 3 products as the direct kernel takes it: |R b + t - a|^2 -
/// contactDistance^2, with lengths of a, b and t as given, for squared distances up to distance^2.
double directError(double u, double a, double b, double t, double distance, double contactDistance);

/// T(q) takes no point, anywhere in the limits, farther from A's origin than this and its distance from B's.
double motionSize(const Motion& motion);

/// How far T(q) y may come out from where it is when it is worked out with roundoff u, whichever way the
/// DOFs' matrices are multiplied: axes far away leave their roundoffs behind. farthest: no point y of B is
/// farther from B's origin, and no origin that coordinates are taken from is farther from its body's.
double poseError(const Motion& motion, double u, double farthest);

/// How far turns of many radians may take a point of B off, as angles from the middle of the limits round by
/// more the larger they are. The other bounds here have room for 8 radians either way; 0 where none go
/// farther.
double turnError(const Motion& motion, const Vec3& point);

/// By how much a gap found from a squared distance d^2 with error E is off: sqrt(d^2) - contact distance,
/// with gaps up to |gap|.
double gapBand(double u, double error, double contactDistance, double gap);

/// The gaps at which the sign of d^2 - contactDistance^2 known to E may be wrong.
double signBand(double error, double contactDistance);

} // namespace tss
