#pragma once
#include "bake/motion/Muscle.h"

#include <cmath>
#include <numbers>

namespace tss::test {

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
/// their defaults. Sizes that make a solid are not
/// checked.
inline Muscle bentEllipsoid(const BentEllipsoid& shape) {
    const Vec3 chord = shape.insertion - shape.origin;
    const double half = chord.norm() / 2;
    const Vec3 along = chord.normalized();
    const Vec3 up = (shape.up - along.dot(shape.up) * along).normalized();
    const Vec3 side = up.cross(along);
    const Vec3 middle = (shape.origin + shape.insertion) / 2;
    const auto bent = [&](double t) -> Vec3 {
        return middle + half * t * along + shape.bend * (1 - t * t) * up;
    };

    Muscle muscle;
    TriangleMesh& mesh = muscle.surface;
    mesh.vertices.push_back(bent(-1));
    for (int r = 1; r <= shape.rings; ++r) {
        const double polar = std::numbers::pi * r / (shape.rings + 1);
        for (int s = 0; s < shape.sectors; ++s) {
            const double turn = 2 * std::numbers::pi * s / shape.sectors;
            mesh.vertices.push_back(bent(-std::cos(polar)) +
                                    std::sin(polar) * (shape.halfWidth * std::cos(turn) * side +
                                                       shape.halfHeight * std::sin(turn) * up));
        }
    }
    mesh.vertices.push_back(bent(1));
    const int last = static_cast<int>(mesh.vertices.size()) - 1;
    const auto at = [&](int r, int s) { return 1 + r * shape.sectors + s % shape.sectors; };
    for (int s = 0; s < shape.sectors; ++s) {
        mesh.triangles.emplace_back(0, at(0, s + 1), at(0, s));
        for (int r = 0; r + 1 < shape.rings; ++r) {
            mesh.triangles.emplace_back(at(r, s), at(r, s + 1), at(r + 1, s));
            mesh.triangles.emplace_back(at(r + 1, s), at(r, s + 1), at(r + 1, s + 1));
        }
        mesh.triangles.emplace_back(at(shape.rings - 1, s), at(shape.rings - 1, s + 1), last);
    }
    const int points = shape.rings + 1;
    for (int i = 0; i <= points; ++i) muscle.fibre.push_back(bent(-1 + 2.0 * i / points));
    return muscle;
}

} // namespace tss::test
