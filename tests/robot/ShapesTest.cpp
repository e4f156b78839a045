#include "bake/robot/Shapes.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/MeshQuery.h"
#include "tests/robot/Robots.h"

#include <random>

using namespace tss;
using Kind = RobotShape::Kind;

namespace {

RobotShape shapeOf(Kind kind, const Vec3& size) {
    RobotShape shape;
    shape.kind = kind;
    shape.size = size;
    return shape;
}

/// How far a point is outside of the shape; below 0 inside.
double outside(const RobotShape& shape, const Vec3& p) {
    const Vec3& s = shape.size;
    switch (shape.kind) {
    case Kind::Box:
        return (p.cwiseAbs() - s / 2).maxCoeff();
    case Kind::Sphere:
        return p.norm() - s[0];
    case Kind::Cylinder:
        return std::max(p.head<2>().norm() - s[0], std::abs(p.z()) - s[1] / 2);
    case Kind::Capsule:
        return Vec3(p.x(), p.y(), std::max(0.0, std::abs(p.z()) - s[1] / 2)).norm() - s[0];
    case Kind::Cone:
        return std::max(p.head<2>().norm() - s[0] * (0.5 - p.z() / s[1]), std::abs(p.z()) - s[1] / 2);
    case Kind::Ellipsoid:
        return (p.cwiseQuotient(s).norm() - 1) * s.maxCoeff();
    case Kind::Mesh:
        break;
    }
    return 0;
}

} // namespace

TEST_CASE("a shape's mesh is closed, turned outwards, encloses it, and stands out of it by half a percent at "
          "most") {
    const RobotShape shape =
        GENERATE(shapeOf(Kind::Box, {0.2, 0.3, 0.4}), shapeOf(Kind::Sphere, {0.7, 0, 0}),
                 shapeOf(Kind::Cylinder, {0.3, 1.1, 0}), shapeOf(Kind::Capsule, {0.3, 1.1, 0}),
                 shapeOf(Kind::Ellipsoid, {0.3, 0.1, 0.9}), shapeOf(Kind::Cone, {0.3, 0.6, 0}));
    const TriangleMesh mesh = meshOf(shape);
    const MeshAudit audit = auditMesh(mesh);
    CHECK(audit.watertight);
    CHECK(audit.signedVolume > 0);
    CHECK(audit.components == 1);
    CHECK(audit.zeroAreaTriangles == 0);
    for (const Vec3& v : mesh.vertices) CHECK(outside(shape, v) <= 0.005 * shape.size.maxCoeff());
    const MeshQuery query(mesh);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int within = 0, lost = 0;
    for (int k = 0; k < 6000; ++k) {
        const Vec3 along(unit(random), unit(random), unit(random));
        const Vec3 p = bounds(mesh).min() + along.cwiseProduct(Vec3(bounds(mesh).sizes()));
        if (outside(shape, p) > 0) continue;
        ++within;
        lost += !query.inside(p);
    }
    CHECK(within > 1000);
    CHECK(lost == 0);
}

TEST_CASE("shapes without a length are refused") {
    CHECK_THROWS_AS(meshOf(shapeOf(Kind::Box, {1, 0, 1})), InputError);
    CHECK_THROWS_AS(meshOf(shapeOf(Kind::Sphere, {-1, 0, 0})), InputError);
    CHECK_THROWS_AS(meshOf(shapeOf(Kind::Cylinder, {1, 0, 0})), InputError);
    CHECK(auditMesh(meshOf(shapeOf(Kind::Capsule, {1, 0, 0}))).watertight); // a ball
}
