#include "bake/motion/MuscleTrack.h"

#include <algorithm>
#include <cmath>

namespace tss {

std::vector<double> activationNodes(double lower, double upper, int steps) {
    std::vector<double> nodes;
    const auto span = [&](double from, double to, int count) {
        for (int i = 0; i < count; ++i) nodes.push_back(from + (to - from) * i / count);
    };
    if (lower < 0 && upper > 0) {
        const int below =
            std::clamp(static_cast<int>(std::lround(steps * -lower / (upper - lower))), 1, steps - 1);
        span(lower, 0, below);
        span(0, upper, steps - below);
    } else if (upper > lower) {
        span(lower, upper, steps);
    }
    nodes.push_back(upper);
    return nodes;
}

MuscleTrack makeTrack(const MuscleDeformer& muscle, std::span<const MusclePoint> points,
                      const std::vector<double>& nodes) {
    MuscleTrack track{nodes, points.size(), {}, {}, 0};
    track.positions.reserve(nodes.size() * points.size());
    track.thicknesses.reserve(nodes.size() * points.size());
    for (const double a : nodes) {
        const MuscleState state = muscle.state(a);
        for (const MusclePoint& p : points) {
            track.positions.push_back(muscle.map(p, state));
            track.thicknesses.push_back(muscle.thickness(p.s, state));
        }
    }
    for (std::size_t n = 0; n + 1 < nodes.size(); ++n) {
        const MuscleState state = muscle.state((nodes[n] + nodes[n + 1]) / 2);
        for (std::size_t i = 0; i < points.size(); ++i)
            track.error = std::max(track.error,
                                   (trackPosition(track, {n, 0.5}, i) - muscle.map(points[i], state)).norm());
    }
    return track;
}

TrackPlace locate(const std::vector<double>& nodes, double activation) {
    if (std::isnan(activation)) activation = 0;
    if (nodes.size() < 2 || activation <= nodes.front()) return {0, 0};
    if (activation >= nodes.back()) return {nodes.size() - 1, 0};
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), activation);
    const auto n = static_cast<std::size_t>(above - nodes.begin()) - 1;
    return {n, (activation - nodes[n]) / (nodes[n + 1] - nodes[n])};
}

} // namespace tss
