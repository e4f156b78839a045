#include "bake/scene/Transforms.h"

#include "bake/base/Degrees.h"
#include "bake/base/NearestFloat.h"
#include "bake/motion/SmallSystems.h"

namespace tss {

namespace {

constexpr const char* resetToken = "!resetXformStack!";
constexpr const char* invertToken = "!invert!";
constexpr Attribute translate = declared("double3 xformOp:translate");
constexpr Attribute orient = declared("quatd xformOp:orient");

/// An operation may be of half, float or double precision: the attribute as the file has it, if of these
/// types.
Attribute attributeOf(const PrimReader& prim, std::string_view name,
                      std::initializer_list<const char*> types) {
    const Property* property = prim.prim().property(name);
    for (const char* type : types)
        if (property && property->typeName == type) return {name, type};
    return {name, *types.begin()};
}

Eigen::Affine3d rotationAbout(int axis, double degrees) {
    return Eigen::Affine3d(Eigen::AngleAxisd(toRadians(degrees), Vec3::Unit(axis)));
}

/// rotateX, ..., rotateXYZ, ...: the axis named first acts on the point first.
Eigen::Affine3d rotation(const PrimReader& prim, const std::string& name, const std::string& axes) {
    Eigen::Affine3d turn = Eigen::Affine3d::Identity();
    if (axes.size() == 1)
        return rotationAbout(axes[0] - 'X',
                             prim.real(attributeOf(prim, name, {"float", "double", "half"}), 0));
    const Vec3 degrees = prim.vector(attributeOf(prim, name, {"float3", "double3", "half3"}), Vec3::Zero());
    for (char axis : axes) turn = rotationAbout(axis - 'X', degrees[axis - 'X']) * turn;
    return turn;
}

bool isRotation(const std::string& kind) {
    static const char* const kinds[] = {"X", "Y", "Z", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    if (!kind.starts_with("rotate")) return false;
    for (const char* axes : kinds)
        if (kind.substr(6) == axes) return true;
    return false;
}

Xform matrix(const PrimReader& prim, const std::string& name) {
    Xform xform;
    const auto rows = prim.reals(attributeOf(prim, name, {"matrix4d"}));
    if (rows.size() != 16) return xform;
    // The file has row vectors: its rows are our columns.
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) xform.matrix(column, row) = rows[4 * row + column];
    const Attribute attribute{name, "matrix4d"};
    if (xform.matrix.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        prim.problem(attribute, "expected a last column of 0, 0, 0, 1");
    xform.matrix.makeAffine();
    xform.rigid = (xform.matrix.linear() - Eigen::Matrix3d::Identity()).isZero(0);
    return xform;
}

Xform operation(const PrimReader& prim, const std::string& name) {
    const auto first = name.find(':');
    const std::string kind = name.substr(first + 1, name.find(':', first + 1) - first - 1);
    Xform xform;
    if (kind == "translate")
        xform.matrix.translation() =
            prim.vector(attributeOf(prim, name, {"double3", "float3", "half3"}), Vec3::Zero());
    else if (kind == "orient")
        xform.matrix.linear() =
            prim.rotation(attributeOf(prim, name, {"quatf", "quatd", "quath"})).toRotationMatrix();
    else if (isRotation(kind))
        xform.matrix = rotation(prim, name, kind.substr(6));
    else if (kind == "transform")
        return matrix(prim, name);
    else if (kind == "scale") {
        const Vec3 factors =
            prim.vector(attributeOf(prim, name, {"float3", "double3", "half3"}), Vec3::Ones());
        if ((factors.array() == 0).any())
            prim.problem(attributeOf(prim, name, {"float3", "double3", "half3"}),
                         "expected scales that are not 0");
        else
            xform.matrix.linear() = factors.asDiagonal();
        xform.rigid = factors == Vec3::Ones();
    } else
        prim.problem(schema::xformOpOrder,
                     "expected translate, orient, rotate..., scale or transform, found \"", name, "\"");
    return xform;
}

} // namespace

Xform localXform(const PrimReader& prim) {
    Xform local;
    for (std::string name : prim.texts(schema::xformOpOrder)) {
        if (name == resetToken) {
            local = {};
            continue;
        }
        const bool inverted = name.starts_with(invertToken);
        if (inverted) name = name.substr(std::string(invertToken).size());
        if (!prim.prim().property(name)) {
            prim.problem(schema::xformOpOrder, "expected the operation \"", name, "\" among the properties");
            continue;
        }
        const Xform next = operation(prim, name);
        if (inverted && !(std::abs(next.matrix.linear().determinant()) > 0))
            prim.problem(schema::xformOpOrder, "expected an operation that can be inverted, found ", name);
        else
            local.matrix = local.matrix * (inverted ? next.matrix.inverse() : next.matrix);
        local.rigid = local.rigid && next.rigid;
    }
    return local;
}

bool resetsXformStack(const PrimReader& prim) {
    for (const std::string& name : prim.texts(schema::xformOpOrder))
        if (name == resetToken) return true;
    return false;
}

Vec3 stretched(const SplitXform& xform, const Vec3& point) {
    return xform.stretched ? Vec3((xform.stretch * point).unaryExpr(&nearestFloat)) : point;
}

SplitXform split(const Xform& xform) {
    SplitXform result;
    result.placement.translation() = xform.matrix.translation();
    if (xform.rigid) {
        result.placement.linear() = xform.matrix.linear();
        return result;
    }
    const Eigen::Matrix3d linear = xform.matrix.linear();
    const SingularValues svd = singularValues(linear);
    Eigen::Matrix3d turn = svd.u * svd.v.transpose();
    if (turn.determinant() < 0) turn = -turn;
    result.placement.linear() = turn;
    result.stretch = turn.transpose() * linear;
    constexpr double noise = 1e-9; // a matrix that is a rotation up to rounding
    result.stretched = !(result.stretch - Eigen::Matrix3d::Identity()).isZero(noise);
    if (!result.stretched) result.stretch.setIdentity();
    return result;
}

void writePlacement(PrimWriter& prim, const Pose& placement) {
    std::vector<std::string> order;
    if (placement.translation() != Vec3::Zero()) {
        prim.set(translate, Vec3(placement.translation()));
        order.emplace_back(translate.name);
    }
    if (placement.linear() != Eigen::Matrix3d::Identity()) {
        prim.set(orient, Eigen::Quaterniond(placement.linear()).normalized());
        order.emplace_back(orient.name);
    }
    if (!order.empty()) prim.set(schema::xformOpOrder, order);
}

} // namespace tss
