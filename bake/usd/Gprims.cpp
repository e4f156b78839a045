#include "bake/usd/UsdParts.h"

#include "bake/robot/Shapes.h"

#include <array>

namespace tss {

namespace {

constexpr Attribute size{"size", "double"}, radius{"radius", "double"}, radiusTop{"radiusTop", "double"},
    radiusBottom{"radiusBottom", "double"}, height{"height", "double"},
    axisOf = declared("token axis", "", anyNumber, "Z X Y");

/// Of a Capsule_1 or Cylinder_1, which have one at each end.
double sameRadius(const PrimReader& prim, double fallback) {
    const double top = prim.real(radiusTop, fallback), bottom = prim.real(radiusBottom, fallback);
    if (top != bottom) throw InputError("expected radiusTop and radiusBottom to be the same");
    return top;
}

/// Along z, with USD's fallbacks.
RobotShape shapeOf(const PrimReader& prim) {
    const std::string& type = prim.prim().typeName;
    RobotShape shape;
    if (type == "Cube") {
        shape.kind = RobotShape::Kind::Box;
        shape.size = Vec3::Constant(prim.real(size, 2));
    } else if (type == "Sphere") {
        shape.kind = RobotShape::Kind::Sphere;
        shape.size[0] = prim.real(radius, 1);
    } else {
        const bool capsule = type.starts_with("Capsule");
        shape.kind = capsule                        ? RobotShape::Kind::Capsule
                     : type.starts_with("Cylinder") ? RobotShape::Kind::Cylinder
                                                    : RobotShape::Kind::Cone;
        const double fallback = capsule ? 0.5 : 1;
        shape.size[0] = type.ends_with("_1") ? sameRadius(prim, fallback) : prim.real(radius, fallback);
        shape.size[1] = prim.real(height, capsule ? 1 : 2);
    }
    return shape;
}

/// From along z to along the axis that the prim names.
Eigen::Matrix3d turnTo(const PrimReader& prim) {
    const std::string axis = prim.choice(axisOf);
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (axis == "X") turn << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    if (axis == "Y") turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    return turn;
}

} // namespace

bool isGprim(const Prim& prim) {
    static constexpr std::array types = {"Mesh",    "Cube", "Sphere",    "Cylinder",
                                         "Capsule", "Cone", "Capsule_1", "Cylinder_1"};
    return std::ranges::find(types, prim.typeName) != types.end();
}

bool isUnreadSurface(const Prim& prim) {
    static constexpr std::array types = {"PointInstancer", "NurbsPatch", "TetMesh", "Plane"};
    return std::ranges::find(types, prim.typeName) != types.end();
}

TriangleMesh meshOfGprim(const PrimReader& prim, const Eigen::Affine3d& place) {
    TriangleMesh mesh;
    Eigen::Affine3d whole = place;
    if (prim.prim().typeName == "Mesh") {
        mesh = readMesh(prim, {});
    } else {
        mesh = meshOf(shapeOf(prim));
        const bool turns = prim.prim().typeName != "Cube" && prim.prim().typeName != "Sphere";
        if (turns) whole.linear() = whole.linear() * turnTo(prim);
    }
    for (Vec3& v : mesh.vertices) v = whole * v;
    if (whole.linear().determinant() < 0)
        for (Tri& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

} // namespace tss
