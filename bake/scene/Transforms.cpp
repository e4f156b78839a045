#include "bake/scene/Transforms.h"

#include "bake/base/Degrees.h"
#include "bake/base/NearestFloat.h"
#include "bake/motion/SmallSystems.h"

#include <set>

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

/// The operations of this kind that have numbers: rotateX, rotateXYZ, ..., translate, translateX, ...,
/// scaleX. The axes that it names, XYZ where it names none; empty for others.
std::string axesOf(const std::string& kind, const std::string& of) {
    static const std::set<std::string> orders = {"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    if (!kind.starts_with(of)) return "";
    const std::string axes = kind.substr(of.size());
    if (axes == "X" || axes == "Y" || axes == "Z") return axes;
    if (of == "rotate") return orders.contains(axes) ? axes : "";
    return axes.empty() ? "XYZ" : "";
}

/// The attribute of the numbers of an operation: one where it names one axis, else three.
Attribute numbersOf(const PrimReader& prim, const std::string& name, const std::string& axes) {
    return axes.size() == 1 ? attributeOf(prim, name, {"float", "double", "half"})
                            : attributeOf(prim, name, {"float3", "double3", "half3"});
}

/// The same `otherwise` along axes that it does not name.
Vec3 numbers(const PrimReader& prim, const std::string& name, const std::string& axes, double otherwise) {
    Vec3 result = Vec3::Constant(otherwise);
    const Attribute attribute = numbersOf(prim, name, axes);
    if (axes.size() > 1) return prim.vector(attribute, result);
    result[axes[0] - 'X'] = prim.real(attribute, otherwise);
    return result;
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
    if (const auto axes = axesOf(kind, "translate"); !axes.empty()) {
        xform.matrix.translation() = numbers(prim, name, axes, 0);
    } else if (const auto axes = axesOf(kind, "rotate"); !axes.empty()) {
        const Vec3 degrees = numbers(prim, name, axes, 0);
        for (char axis : axes) // the one named first acts on the point first
            xform.matrix = rotationAbout(axis - 'X', degrees[axis - 'X']) * xform.matrix;
    } else if (const auto axes = axesOf(kind, "scale"); !axes.empty()) {
        const Vec3 factors = numbers(prim, name, axes, 1);
        if ((factors.array() == 0).any())
            prim.problem(numbersOf(prim, name, axes), "expected scales that are not 0");
        else
            xform.matrix.linear() = factors.asDiagonal();
        xform.rigid = factors == Vec3::Ones();
    } else if (kind == "orient") {
        xform.matrix.linear() =
            prim.rotation(attributeOf(prim, name, {"quatf", "quatd", "quath"})).toRotationMatrix();
    } else if (kind == "transform") {
        return matrix(prim, name);
    } else {
        prim.problem(schema::xformOpOrder,
                     "expected translate..., orient, rotate..., scale... or transform, found \"", name, "\"");
    }
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
