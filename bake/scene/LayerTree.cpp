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

void addMember(TreeNode& to, const std::string& key, TreeNode value) {
    value.key = key;
    to.elements.push_back(std::move(value));
}

void addAll(TreeNode& to, const Value::Object& object) {
    for (const auto& [key, value] : object) addMember(to, key, leaf(value));
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
        addMember(to, "targetPaths", leaf(*property.targetPaths));
    } else {
        const auto type = valueType(property.typeName);
        const bool asFloat = type && type->isFloat();
        addMember(to, "typeName", text(property.typeName));
        if (property.defaultValue) addMember(to, "default", leaf(*property.defaultValue, asFloat));
        if (!property.timeSamples.empty()) addMember(to, "timeSamples", samples(property, asFloat));
    }
    addAll(to, property.other);
    return to;
}

TreeNode primTrees(const std::vector<Prim>& prims);

TreeNode primTree(const Prim& prim) {
    TreeNode to = node(Kind::Object);
    addMember(to, "specifier", text(prim.specifier));
    if (!prim.typeName.empty()) addMember(to, "typeName", text(prim.typeName));
    addMember(to, "name", text(prim.name));
    if (!prim.metadata.empty()) addMember(to, "metadata", object(prim.metadata));
    if (!prim.properties.empty()) {
        TreeNode properties = node(Kind::Object);
        for (const auto& [name, property] : prim.properties)
            addMember(properties, name, propertyTree(property));
        addMember(to, "properties", std::move(properties));
    }
    addAll(to, prim.other);
    if (!prim.children.empty()) addMember(to, "primChildren", primTrees(prim.children));
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
    addMember(to, "format", text("osgtss"));
    addMember(to, "formatVersion", text(layer.formatVersion));
    if (!layer.metadata.empty()) addMember(to, "metadata", object(layer.metadata));
    addAll(to, layer.other);
    if (!layer.children.empty()) addMember(to, "primChildren", primTrees(layer.children));
    return to;
}

} // namespace tss
