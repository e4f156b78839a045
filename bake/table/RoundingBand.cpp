#include "bake/table/RoundingBand.h"

#include "bake/motion/MotionFrame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

namespace {

/// Room for terms of second order in u and for the rounding of the bounds themselves.
constexpr double room = 1 + 1e-5;

} // namespace

double sumError(double u, double constant, std::span<const double> products, double result) {
    double after = 0;
    for (double c : products) after += c;
    // The constant rounds once, each product's factors once each, and the product once where not fused.
    double error = std::abs(constant) + 3 * after;
    double before = std::abs(constant);
    for (double c : products) {
        before += c;
        after -= c;
        error += std::min(before, std::abs(result) + std::max(after, 0.0));
    }
    return room * u * error;
}

double rangeError(double u, double products, double factors) {
    constexpr double large = 1e30; // as a float, with room for sums
    if (u < floatRoundoff) return std::numeric_limits<double>::min() * (products + factors);
    if (!(factors < large)) return std::numeric_limits<double>::infinity();
    return double(std::numeric_limits<float>::min()) * (products + factors);
}

double directError(double u, double a, double b, double t, double distance, double contactDistance) {
    // Where the pair is at this distance, t is no longer than a, b and it together.
    t = std::min(t, a + b + distance);
    // Per axis: t and a round, their difference rounds, three products (2 factors, 1 product each; by Cauchy
    // no longer than b together) and three sums round.
    const double axis = u * (5 * (t + a) + 6 * b);
    const double vector = std::sqrt(3.0) * axis;
    const double squares =
        u * (4 * (distance + vector) * (distance + vector) + 2 * contactDistance * contactDistance);
    return room * (2 * distance * vector + vector * vector + squares) +
           rangeError(u, 15, 8 * (a + b + t + distance));
}

double motionSize(const Motion& motion) {
    double size = motion.base.translation().norm();
    for (const Dof& dof : motion.dofs) {
        double far = 0;
        for (const PathRow& row : dof.path) far = std::max(far, row.translation.norm());
        switch (dof.kind) {
        case DofKind::Rotation:
            size += 2 * dof.origin.norm();
            break;
        case DofKind::Translation:
            size += dof.axis.norm() * std::max(std::abs(dof.lower), std::abs(dof.upper));
            break;
        case DofKind::Path:
            size += 2 * dof.frame.translation().norm() + far;
            break;
        }
    }
    return size;
}

double poseError(const Motion& motion, double u, double farthest) {
    double off = 0;
    for (const Dof& dof : motion.dofs) {
        for (const PathRow& row : dof.path) off += std::abs(row.rotation.norm() - 1);
        if (dof.kind == DofKind::Rotation) off += std::abs(dof.axis.norm() - 1);
    }
    // Per DOF a rotation from sines and cosines and some dozens of products and sums of numbers up to that
    // size.
    const double size = 2 * farthest + motionSize(motion);
    return (128 * double(motion.dofCount() + 2) * u + 8 * off) * size * room;
}

double turnError(const Motion& motion, const Vec3& point) {
    constexpr double counted = 8;
    DofValues speeds{};
    speedBounds(motion, point, speeds.data());
    double error = 0;
    for (std::size_t k = 0; k < motion.dofCount(); ++k)
        if (motion.dofs[k].kind == DofKind::Rotation)
            error += speeds[k] * std::max(0.0, 0.5 * (motion.dofs[k].upper - motion.dofs[k].lower) - counted);
    return doubleRoundoff * room * error;
}

double gapBand(double u, double error, double contactDistance, double gap) {
    const double distance = std::max(contactDistance + gap, 0.0);
    const double squared = distance * distance;
    const double whole = error + u * (squared + error);
    const double root = distance + std::sqrt(std::max(0.0, squared - whole));
    const double off = root > 0 ? whole / root : std::sqrt(whole);
    return room * (off + 2 * u * (distance + std::abs(contactDistance) + std::abs(gap)));
}

double signBand(double error, double contactDistance) {
    const double squared = contactDistance * contactDistance;
    const double root = std::abs(contactDistance) + std::sqrt(std::max(0.0, squared - error));
    return root > 0 ? error / root : std::sqrt(error);
}

} // namespace tss
