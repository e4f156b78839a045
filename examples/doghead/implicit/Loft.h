#pragma once
#include "examples/doghead/implicit/Curve.h"

namespace doghead {

/// A cross-section at x: between a floor and a roof, with a half-width at mid height that is narrowed towards
/// the roof and widened towards the floor by a taper (0 none, 1 down to a ridge), cornered by an exponent
/// (2 an ellipse, 4 nearly a rectangle).
struct Section {
    double x;
    double floor;
    double roof;
    double halfWidth;
    double taper = 0;
    double exponent = 2;
};

/// A solid, symmetric about y = 0, lofted along x through sections at rising x; its ends are closed by
/// planes.
Field loft(const std::vector<Section>& sections);

} // namespace doghead
