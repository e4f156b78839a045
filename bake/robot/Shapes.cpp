#include "bake/robot/Shapes.h"

#include "bake/base/Error.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace tss {

namespace {

constexpr int aroundCount = 48, ringCount = 24; ///< the latter from pole to pole

/// A closed surface of turning about z: rings of points (radius, height) from the top to the bottom; a radius
/// of 0 is a pole.
TriangleMesh turned(const std::vector<std::pair<double, double>>& rings) {
    TriangleMesh mesh;
    std::vector<int> first;
    for (const auto& [radius, height] : rings) {
        first.push_back(static_cast<int>(mesh.vertices.size()));
        for (int k = 0; k < (radius == 0 ? 1 : aroundCount); ++k) {
            const double angle = 2 * std::numbers::pi * k / aroundCount;
            mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
        }
    }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i)
        for (int k = 0; k < aroundCount; ++k) {
            const int next = (k + 1) % aroundCount;
            const bool top = rings[i].first == 0, bottom = rings[i + 1].first == 0;
            const int a = first[i] + (top ? 0 : k), b = first[i] + (top ? 0 : next);
            const int c = first[i + 1] + (bottom ? 0 : k), d = first[i + 1] + (bottom ? 0 : next);
            if (!bottom) mesh.triangles.emplace_back(a, c, d);
            if (!top) mesh.triangles.emplace_back(a, d, b);
        }
    return mesh;
}

/// How far the faces of a mesh about the origin stay from it at least.
double innerRadius(const TriangleMesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
        least = std::min(least, (b - a).cross(c - a).normalized().dot(a));
    }
    return least;
}

/// The rings of a ball whose halves are pulled apart by `length`.
TriangleMesh capsule(double radius, double length) {
    std::vector<std::pair<double, double>> rings;
    for (int i = 0; i <= ringCount; ++i) {
        const double angle = std::numbers::pi * i / ringCount;
        const bool pole = i == 0 || i == ringCount;
        const double around = pole ? 0 : std::sin(angle), up = i == ringCount / 2 ? 0 : std::cos(angle);
        if (2 * i <= ringCount) rings.emplace_back(radius * around, radius * up + length / 2);
        if (2 * i == ringCount && length == 0) continue;
        if (2 * i >= ringCount) rings.emplace_back(radius * around, radius * up - length / 2);
    }
    return turned(rings);
}

/// By how much a ball of these rings has to grow so that its faces lie outside of the ball.
double growth() {
    static const double factor = 1 / innerRadius(capsule(1, 0));
    return factor;
}

TriangleMesh box(const Vec3& edges) {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.vertices.emplace_back(
            Vec3(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5).cwiseProduct(edges));
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

void expectLengths(const RobotShape& shape, int count, double least) {
    for (int k = 0; k < count; ++k)
        if (!(shape.size[k] > 0) && !(k == 1 && shape.size[k] >= least))
            throw InputError("expected lengths above 0");
}

} // namespace

TriangleMesh meshOf(const RobotShape& shape) {
    const Vec3& size = shape.size;
    switch (shape.kind) {
    case RobotShape::Kind::Box:
        expectLengths(shape, 3, 1e300);
        return box(size);
    case RobotShape::Kind::Sphere:
        expectLengths(shape, 1, 1e300);
        return capsule(size[0] * growth(), 0);
    case RobotShape::Kind::Capsule:
        expectLengths(shape, 2, 0);
        return capsule(size[0] * growth(), size[1]);
    case RobotShape::Kind::Ellipsoid: {
        expectLengths(shape, 3, 1e300);
        TriangleMesh mesh = capsule(growth(), 0);
        for (Vec3& v : mesh.vertices) v = v.cwiseProduct(size);
        return mesh;
    }
    case RobotShape::Kind::Cylinder: {
        expectLengths(shape, 2, 1e300);
        const double radius = size[0] / std::cos(std::numbers::pi / aroundCount), half = size[1] / 2;
        return turned({{0, half}, {radius, half}, {radius, -half}, {0, -half}});
    }
    case RobotShape::Kind::Cone: {
        expectLengths(shape, 2, 1e300);
        const double radius = size[0] / std::cos(std::numbers::pi / aroundCount), half = size[1] / 2;
        return turned({{0, half}, {radius, -half}, {0, -half}});
    }
    case RobotShape::Kind::Mesh:
        break;
    }
    throw std::logic_error("a shape that is a mesh is read from its file");
}

} // namespace tss
