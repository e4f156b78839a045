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

/// Each calls visit(key, node) for the members of an object.
template <class Visit>
void forMembers(const Value::Object& object, const Visit& visit) {
    for (const auto& [key, value] : object) visit(key, TypedValue{value});
}

template <class Visit>
void forMembers(const std::map<std::string, Property>& properties, const Visit& visit) {
    for (const auto& [name, property] : properties) visit(name, property);
}

template <class Visit>
void forMembers(const Property& property, const Visit& visit) {
    const ValueType* const type = valueType(property.typeName);
    const bool asFloat = type && type->isFloat();
    if (property.targetPaths) {
        visit("targetPaths", TypedValue{*property.targetPaths});
    } else {
        visit("typeName", property.typeName);
        if (property.defaultValue) visit("default", TypedValue{*property.defaultValue, asFloat});
        if (!property.timeSamples.empty()) visit("timeSamples", TypedSamples{property.timeSamples, asFloat});
    }
    forMembers(property.other, visit);
}

template <class Visit>
void forMembers(const Prim& prim, const Visit& visit) {
    visit("specifier", prim.specifier);
    if (!prim.typeName.empty()) visit("typeName", prim.typeName);
    visit("name", prim.name);
    if (!prim.metadata.empty()) visit("metadata", prim.metadata);
    if (!prim.properties.empty()) visit("properties", prim.properties);
    forMembers(prim.other, visit);
    if (!prim.children.empty()) visit("primChildren", prim.children);
}

template <class Visit>
void forMembers(const Layer& layer, const Visit& visit) {
    visit("format", std::string("osgtss"));
    visit("formatVersion", layer.formatVersion);
    if (!layer.metadata.empty()) visit("metadata", layer.metadata);
    forMembers(layer.other, visit);
    if (!layer.children.empty()) visit("primChildren", layer.children);
}

template <class Node>
concept isObject = requires(const Node& node) {
    forMembers(node, [](const auto&...) {});
};

/// The same for the elements of an array: visit(node).
template <class Visit>
void forElements(const std::vector<Prim>& prims, const Visit& visit) {
    for (const Prim& prim : prims) visit(prim);
}

template <class Visit>
void forElements(const TypedSamples& typed, const Visit& visit) {
    for (const Property::Sample& sample : typed.samples) visit(TypedSample{sample, typed.asFloat});
}

template <class Visit>
void forElements(const TypedSample& typed, const Visit& visit) {
    const Value time(typed.sample.time);
    visit(TypedValue{time});
    visit(TypedValue{typed.sample.value, typed.asFloat});
}

/// Calls visit for each element of a value that is an array.
template <class Visit>
void forElements(const TypedValue& typed, const Visit& visit) {
    for (const Value& element : *typed.value.as<Value::Array>()) visit(TypedValue{element, typed.asFloat});
}

} // namespace tss
