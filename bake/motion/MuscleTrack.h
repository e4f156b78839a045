#pragma once
#include "bake/motion/MuscleDeformer.h"

#include <span>

namespace tss {

/// Points bound to a muscle, tabulated over its activation and interpolated linearly between the nodes
/// (METHOD 6.1, 6.2): the run time moves by this table, and the search for contacts is about it.
struct MuscleTrack {
    std::vector<double> nodes; ///< rising; the ends of the activation range, and 0 where it lies inside
    std::size_t points = 0;
    std::vector<Vec3> positions;     ///< #nodes blocks of #points
    std::vector<double> thicknesses; ///< #nodes blocks of #points: factor on the local thickness
    double error = 0; ///< largest distance to the exact deformation half way between the nodes, scene units
};

/// Interpolation between two nodes: positions are (1 - t) * node + t * (node + 1). Exact at the nodes.
struct TrackPlace {
    std::size_t node = 0;
    double t = 0;
};

/// Nodes of an activation range: steps of equal width on either side of 0.
std::vector<double> activationNodes(double lower, double upper, int steps = 32);

/// Tabulates the points at these activations.
MuscleTrack makeTrack(const MuscleDeformer& muscle, std::span<const MusclePoint> points,
                      const std::vector<double>& nodes);

/// The interpolation at an activation, clamped into the range of the nodes; NaN counts as 0.
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
