#include "bake/motion/MuscleEllipsoid.h"

#include "bake/base/Error.h"

#include <cmath>
#include <numbers>

namespace tss {

Muscle bentEllipsoid(const BentEllipsoid& shape) {
    const Vec3 chord = shape.insertion - shape.origin;
    const double half = chord.norm() / 2;
    const Vec3 along = chord.normalized();
    const Vec3 up = (shape.up - along.dot(shape.up) * along).normalized();
    if (!(half > 0) || !(up.norm() > 0.5) || !(shape.halfWidth > 0) || !(shape.halfHeight > 0) ||
        !std::isfinite(shape.bend))
        throw InputError(
            "a bent ellipsoid needs two different ends, positive axes and an up beside its chord");
    if (shape.rings < 2 || shape.sectors < 3)
        throw InputError("a bent ellipsoid needs at least 2 rings and 3 sectors");
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

} // namespace tss
