#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/ValueType.h"

namespace tss {

/// What a layer is written as, JSON and CBOR alike: objects and arrays, keys in the order of the file. A
/// value whose numbers are floats, or not:
struct TypedValue {
    const Value& value;
    bool asFloat = false;
};
/// [[time, value], ...]
struct TypedSamples {
    const std::vector<Property::Sample>& samples;
    bool asFloat = false;
};
struct TypedSample {
    const Property::Sample& sample;
    bool asFloat = false;
};

/// Each calls visit(key, node) for the members of an object until it returns false; true when it never does.
template <class Visit>
bool forMembers(const Value::Object& object, const Visit& visit) {
    for (const auto& [key, value] : object)
        if (!visit(key, TypedValue{value})) return false;
    return true;
}

template <class Visit>
bool forMembers(const std::map<std::string, Property>& properties, const Visit& visit) {
    for (const auto& [name, property] : properties)
        if (!visit(name, property)) return false;
    return true;
}

template <class Visit>
bool forMembers(const Property& property, const Visit& visit) {
    if (property.targetPaths)
        return visit("targetPaths", TypedValue{*property.targetPaths}) && forMembers(property.other, visit);
    const auto type = valueType(property.typeName);
    const bool asFloat = type && type->isFloat();
    const auto& value = property.defaultValue;
    return visit("typeName", property.typeName) &&
           (!value || visit("default", TypedValue{*value, asFloat})) &&
           (property.timeSamples.empty() ||
            visit("timeSamples", TypedSamples{property.timeSamples, asFloat})) &&
           forMembers(property.other, visit);
}

template <class Visit>
bool forMembers(const Prim& prim, const Visit& visit) {
    return visit("specifier", prim.specifier) &&
           (prim.typeName.empty() || visit("typeName", prim.typeName)) && visit("name", prim.name) &&
           (prim.metadata.empty() || visit("metadata", prim.metadata)) &&
           (prim.properties.empty() || visit("properties", prim.properties)) &&
           forMembers(prim.other, visit) && (prim.children.empty() || visit("primChildren", prim.children));
}

template <class Visit>
bool forMembers(const Layer& layer, const Visit& visit) {
    return visit("format", std::string("osgtss")) && visit("formatVersion", layer.formatVersion) &&
           (layer.metadata.empty() || visit("metadata", layer.metadata)) && forMembers(layer.other, visit) &&
           (layer.children.empty() || visit("primChildren", layer.children));
}

template <class Node>
concept isObject = requires(const Node& node) {
    forMembers(node, [](const auto&...) { return true; });
};

/// The same for the elements of an array: visit(node).
template <class Visit>
bool forElements(const std::vector<Prim>& prims, const Visit& visit) {
    for (const Prim& prim : prims)
        if (!visit(prim)) return false;
    return true;
}

template <class Visit>
bool forElements(const TypedSamples& typed, const Visit& visit) {
    for (const Property::Sample& sample : typed.samples)
        if (!visit(TypedSample{sample, typed.asFloat})) return false;
    return true;
}

template <class Visit>
bool forElements(const TypedSample& typed, const Visit& visit) {
    const Value time(typed.sample.time);
    return visit(TypedValue{time}) && visit(TypedValue{typed.sample.value, typed.asFloat});
}

/// Of a value that is an array.
template <class Visit>
bool forElements(const TypedValue& typed, const Visit& visit) {
    for (const Value& element : *typed.value.as<Value::Array>())
        if (!visit(TypedValue{element, typed.asFloat})) return false;
    return true;
}

} // namespace tss
