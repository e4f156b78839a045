#include "bake/scene/LayerTree.h"

#include "bake/scene/ValueType.h"

namespace tss {

namespace {

using Kind = TreeNode::Kind;

TreeNode leaf(const Value& value, bool asFloat = false) {
    TreeNode node;
    node.value = &value;
    node.asFloat = asFloat;
    return node;
}

TreeNode text(std::string text) {
    TreeNode node;
    node.kind = Kind::Text;
    node.text = std::move(text);
    return node;
}

TreeNode node(Kind kind) {
    TreeNode node;
    node.kind = kind;
    return node;
}

void addAll(TreeNode& to, const Value::Object& object) {
    for (const auto& [key, value] : object) to.members.emplace_back(key, leaf(value));
}

TreeNode object(const Value::Object& from) {
    TreeNode to = node(Kind::Object);
    addAll(to, from);
    return to;
}

TreeNode samples(const Property& property, bool asFloat) {
    TreeNode all = node(Kind::Array);
    for (const Property::Sample& sample : property.timeSamples) {
        TreeNode pair = node(Kind::Array);
        TreeNode time = node(Kind::Time);
        time.time = sample.time;
        pair.elements = {std::move(time), leaf(sample.value, asFloat)};
        all.elements.push_back(std::move(pair));
    }
    return all;
}

TreeNode propertyTree(const Property& property) {
    TreeNode to = node(Kind::Object);
    if (property.targetPaths) {
        to.members.emplace_back("targetPaths", leaf(*property.targetPaths));
    } else {
        const auto type = valueType(property.typeName);
        const bool asFloat = type && type->isFloat();
        to.members.emplace_back("typeName", text(property.typeName));
        if (property.defaultValue) to.members.emplace_back("default", leaf(*property.defaultValue, asFloat));
        if (!property.timeSamples.empty()) to.members.emplace_back("timeSamples", samples(property, asFloat));
    }
    addAll(to, property.other);
    return to;
}

TreeNode primTrees(const std::vector<Prim>& prims);

TreeNode primTree(const Prim& prim) {
    TreeNode to = node(Kind::Object);
    to.members.emplace_back("specifier", text(prim.specifier));
    if (!prim.typeName.empty()) to.members.emplace_back("typeName", text(prim.typeName));
    to.members.emplace_back("name", text(prim.name));
    if (!prim.metadata.empty()) to.members.emplace_back("metadata", object(prim.metadata));
    if (!prim.properties.empty()) {
        TreeNode properties = node(Kind::Object);
        for (const auto& [name, property] : prim.properties)
            properties.members.emplace_back(name, propertyTree(property));
        to.members.emplace_back("properties", std::move(properties));
    }
    addAll(to, prim.other);
    if (!prim.children.empty()) to.members.emplace_back("primChildren", primTrees(prim.children));
    return to;
}

TreeNode primTrees(const std::vector<Prim>& prims) {
    TreeNode to = node(Kind::Array);
    for (const Prim& prim : prims) to.elements.push_back(primTree(prim));
    return to;
}

} // namespace

TreeNode layerTree(const Layer& layer) {
    TreeNode to = node(Kind::Object);
    to.members.emplace_back("format", text("osgtss"));
    to.members.emplace_back("formatVersion", text(layer.formatVersion));
    if (!layer.metadata.empty()) to.members.emplace_back("metadata", object(layer.metadata));
    addAll(to, layer.other);
    if (!layer.children.empty()) to.members.emplace_back("primChildren", primTrees(layer.children));
    return to;
}

} // namespace tss
