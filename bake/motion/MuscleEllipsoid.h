#pragma once
#include "bake/motion/Muscle.h"

namespace tss {

/// The paper's muscle shape: an ellipsoid bent along an arc. Its volume is 4/3 pi a b c whatever the bend.
struct BentEllipsoid {
    Vec3 origin{-1, 0, 0};   ///< one tip
    Vec3 insertion{1, 0, 0}; ///< the other tip, not the same point
    Vec3 up = Vec3::UnitZ(); ///< direction of the bulge of the bend, not along the chord
    double bend = 0;         ///< how far the middle of the fibre stands above the chord, scene units
    double halfWidth = 0.2;  ///< semi-axis across chord and up, > 0
    double halfHeight = 0.2; ///< semi-axis along up, > 0
    int rings = 24;          ///< >= 2, vertices along the fibre without the tips
    int sectors = 16;        ///< >= 3, around it
};

/// The surface, closed and outward, and the fibre of a bent ellipsoid, the other members of the muscle at
/// their defaults. Throws InputError for sizes that make no solid.
Muscle bentEllipsoid(const BentEllipsoid& shape);

} // namespace tss
