#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// A layer as the tree that is written, JSON and CBOR alike: keys in the order of the file. Values are not
/// copied; the layer must outlive the tree.
struct TreeNode {
    enum class Kind { Leaf, Text, Time, Object, Array };
    Kind kind = Kind::Leaf;
    const Value* value = nullptr;   ///< Leaf
    bool asFloat = false;           ///< Leaf: its numbers are floats
    std::string text;               ///< Text
    double time = 0;                ///< Time
    std::string key;                ///< of a member of an object
    std::vector<TreeNode> elements; ///< Array, or the members of an Object
};

/// Members of an object, of the tree or of a value, in one way.
inline const std::string& memberKey(const TreeNode& member) {
    return member.key;
}
inline const TreeNode& memberValue(const TreeNode& member) {
    return member;
}
inline const std::string& memberKey(const Value::Object::value_type& member) {
    return member.first;
}
inline const Value& memberValue(const Value::Object::value_type& member) {
    return member.second;
}

TreeNode layerTree(const Layer& layer);

} // namespace tss
