#include "bake/usd/UsdParts.h"

#include "bake/scene/Schema.h"
#include "bake/scene/ValueType.h"

#include <array>
#include <cmath>

namespace tss {

namespace {

constexpr std::array attributes = {schema::points,
                                   schema::faceVertexCounts,
                                   schema::faceVertexIndices,
                                   schema::displayColor,
                                   schema::localPos0,
                                   schema::localPos1,
                                   schema::localRot0,
                                   schema::localRot1,
                                   schema::lowerLimit,
                                   schema::upperLimit,
                                   schema::coneAngle0,
                                   schema::coneAngle1,
                                   Attribute{"size", "double"},
                                   Attribute{"radius", "double"},
                                   Attribute{"height", "double"}};

/// Names that types had before USD 0.7.
std::string_view plainType(const std::string& name) {
    for (const char* index : {"PointIndex", "EdgeIndex", "FaceIndex"})
        if (name.starts_with(index)) return name.ends_with("[]") ? "int[]" : "int";
    return name;
}

/// What stands for three numbers of an operation, whatever they are called.
std::string_view operationType(const ValueType& type) {
    if (!type.isReal() || type.array || type.width != 3 || type.rows != 1) return {};
    return type.base == ValueType::Base::Double ? "double3" : "float3";
}

std::string_view schemaType(const std::string& name) {
    for (const Attribute& attribute : attributes)
        if (name == attribute.name) return attribute.typeName;
    if (name.starts_with("limit:") || name.starts_with("physxMimicJoint:") ||
        name.starts_with("newton:mimic") ||
        (name.starts_with("drive:") && name.ends_with(":physics:targetPosition")))
        return "float";
    return {};
}

bool sameForm(const ValueType& a, const ValueType& b) {
    const bool numbers = a.base != ValueType::Base::Bool && a.base != ValueType::Base::Text && b.isReal();
    return a.array == b.array && a.width == b.width && a.rows == b.rows && (numbers || a.base == b.base);
}

/// True where it was of another length.
bool normalize(Value& value) {
    auto* numbers = value.as<Numbers>();
    if (!numbers || numbers->values.size() != 4) return false;
    double square = 0;
    for (double x : numbers->values) square += x * x;
    const double length = std::sqrt(square);
    if (!(length > 0) || !std::isfinite(length) || std::abs(length - 1) < 1e-3) return false;
    for (double& x : numbers->values) x /= length;
    return true;
}

/// As in USD, an operation without its property does nothing.
void dropLostOperations(Prim& prim, const std::string& path, LeftOut& leftOut) {
    const auto order = prim.properties.find("xformOpOrder");
    if (order == prim.properties.end() || !order->second.defaultValue) return;
    auto* names = order->second.defaultValue->as<Value::Array>();
    if (!names) return;
    std::erase_if(*names, [&](const Value& value) {
        const auto* name = value.as<std::string>();
        if (!name || name->starts_with("!reset")) return false;
        const bool lost = !prim.property(name->starts_with("!invert!") ? name->substr(8) : *name);
        if (lost) leftOut.add("left out: operations of which there is no property", path + "." + *name);
        return lost;
    });
}

/// Of a number that does not fit the property stays as it is: who reads it says so.
void adaptType(Property& property, const ValueType& wanted) {
    Property adapted = property;
    Problems problems("");
    try {
        adapted.typeName = wanted.name;
        if (adapted.defaultValue) conform(*adapted.defaultValue, wanted, {}, problems);
        for (Property::Sample& sample : adapted.timeSamples) conform(sample.value, wanted, {}, problems);
        property = std::move(adapted);
    } catch (const InputError&) {
    }
}

void adapt(Prim& prim, const std::string& parent, LeftOut& leftOut) {
    const std::string path = parent + "/" + prim.name;
    dropLostOperations(prim, path, leftOut);
    for (auto& [name, property] : prim.properties) {
        const ValueType* const type = valueType(plainType(property.typeName));
        if (!type || property.isRelationship()) continue;
        const std::string_view wanted =
            name.starts_with("xformOp:") ? operationType(*type) : schemaType(name);
        if (!wanted.empty() && property.typeName != wanted && sameForm(*type, *valueType(wanted)))
            adaptType(property, *valueType(wanted));
        if (!property.typeName.starts_with("quat")) continue;
        bool changed = property.defaultValue && normalize(*property.defaultValue);
        for (Property::Sample& sample : property.timeSamples) changed = normalize(sample.value) || changed;
        if (changed)
            leftOut.add("quaternions of another length than 1 are taken as the turn they are",
                        path + "." + name);
    }
    for (Prim& child : prim.children) adapt(child, path, leftOut);
}

} // namespace

void adaptTypes(Layer& layer, LeftOut& leftOut) {
    for (Prim& prim : layer.children) adapt(prim, "", leftOut);
}

} // namespace tss
