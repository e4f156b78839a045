#pragma once
#include "bake/motion/MuscleDeformer.h"

#include <span>

namespace tss {

/// What a muscle carries, tabulated over its activation and linear between the nodes: what the run time
/// moves, and what the search proves its table for (METHOD 6.1, 6.2). One block of positions a node.
struct MuscleTrack {
    std::vector<double> nodes; ///< rising; the ends of the activation range, and 0 where it lies inside
    std::size_t points = 0;
    std::vector<Vec3> positions;     ///< #nodes blocks of #points
    std::vector<double> thicknesses; ///< #nodes blocks of #points: factor on the local thickness
    double error = 0; ///< largest distance to the exact deformation half way between the nodes, scene units
};

/// A place between two nodes: positions are (1 - t) * node + t * (node + 1). Exact at the nodes.
struct TrackPlace {
    std::size_t node = 0;
    double t = 0;
};

/// Nodes of an activation range: steps of equal width on either side of 0.
std::vector<double> activationNodes(double lower, double upper, int steps = 32);

/// Follows the points over the activation range of the muscle.
MuscleTrack makeTrack(const MuscleDeformer& muscle, std::span<const MusclePoint> points,
                      const std::vector<double>& nodes);

/// Clamped into the range of the nodes; NaN counts as 0.
TrackPlace locate(const std::vector<double>& nodes, double activation);

inline Vec3 trackPosition(const MuscleTrack& track, const TrackPlace& place, std::size_t point) {
    const Vec3& from = track.positions[place.node * track.points + point];
    if (place.t == 0) return from;
    return (1 - place.t) * from + place.t * track.positions[(place.node + 1) * track.points + point];
}

inline double trackThickness(const MuscleTrack& track, const TrackPlace& place, std::size_t point) {
    const double from = track.thicknesses[place.node * track.points + point];
    if (place.t == 0) return from;
    return (1 - place.t) * from + place.t * track.thicknesses[(place.node + 1) * track.points + point];
}

} // namespace tss
