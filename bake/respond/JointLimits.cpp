// The limits of a joint, and the metric of its values.
#include "bake/motion/WholeTurn.h"
#include "bake/respond/JointModel.h"

#include <algorithm>
#include <cmath>

namespace tss {

double shareOfRange(const JointModel& model, const DofValues& step) {
    double share = 0;
    for (int l = 0; l < model.dofCount; ++l)
        if (model.range[l] > 0) share = std::max(share, std::abs(step[l]) / model.range[l]);
    return share;
}

void addLimits(const JointModel& model, const DofValues& q, double trust, const DofValues& goal,
               QpRows& rows) {
    const int n = model.dofCount;
    for (int l = 0; l < n; ++l) {
        const double travel = trust * model.range[l];
        for (double sign : {1.0, -1.0}) {
            const double end =
                sign > 0 ? std::max(model.lower[l], q[l] - travel) : std::min(model.upper[l], q[l] + travel);
            double* row = rows.add();
            std::fill_n(row, n, 0.0);
            row[l] = sign;
            row[n] = sign * model.weights[l] * (end - goal[l]);
        }
    }
    for (const LimitPlane& plane : model.planes) {
        double* row = rows.add();
        const double value = excess(plane, {goal.data(), std::size_t(n)});
        double squared = 0;
        for (int l = 0; l < n; ++l) {
            row[l] = -plane.coefficients[l] * model.perWeight[l];
            squared += row[l] * row[l];
        }
        const double scale = 1 / std::sqrt(squared);
        for (int l = 0; l < n; ++l) row[l] *= scale;
        row[n] = value * scale;
    }
}

DofValues clampToLimits(const JointModel& model, const double* asked, ResponseBuffers& ws) {
    const int n = model.dofCount;
    DofValues q{};
    for (int l = 0; l < n; ++l) q[l] = std::clamp(asked[l], model.lower[l], model.upper[l]);
    const std::span<const double> values(q.data(), std::size_t(n)), rest(model.rest.data(), std::size_t(n));
    const auto holds = [&](const LimitPlane& plane) { return excess(plane, values) <= 0; };
    if (std::all_of(model.planes.begin(), model.planes.end(), holds)) return q;
    ws.rows.clear(n);
    addLimits(model, q, 1, q, ws.rows);
    DofValues y;
    if (nearestToOrigin(ws.rows, 1e-12 * model.scale, y))
        for (int l = 0; l < n; ++l)
            q[l] = std::clamp(q[l] + y[l] / model.weights[l], model.lower[l], model.upper[l]);
    // Where ranges differ by many orders of magnitude this may find nothing, or a point beyond a plane by
    // more than rounding. Then q moves straight towards rest until it meets the planes.
    double share = 0;
    for (const LimitPlane& plane : model.planes) {
        double size = 0;
        for (int l = 0; l < n; ++l) size += std::abs(plane.coefficients[l]) * model.range[l];
        if (const double over = excess(plane, values); over > 1e-9 * size)
            share = std::max(share, over / (over - std::min(0.0, excess(plane, rest))));
    }
    for (int l = 0; l < n; ++l) q[l] += std::min(share, 1.0) * (model.rest[l] - q[l]);
    return q;
}

void wrapTurns(const JointModel& model, DofValues& q) {
    for (int l = 0; l < model.dofCount; ++l)
        if (model.periodic[l] && (q[l] < model.first[l] || q[l] > model.first[l] + model.range[l]))
            q[l] = nearestTurn(q[l], model.first[l] + 0.5 * model.range[l]);
}

double weightedDistance(const JointModel& model, const DofValues& x, const DofValues& y) {
    double sum = 0;
    for (int l = 0; l < model.dofCount; ++l) {
        const double d = model.weights[l] * (x[l] - y[l]);
        sum += d * d;
    }
    return std::sqrt(sum);
}

} // namespace tss
