#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// A layer as the tree that is written, JSON and CBOR alike: keys in the order of the file. Values are not
/// copied; the layer must outlive the tree.
struct TreeNode {
    enum class Kind { Leaf, Text, Time, Object, Array };
    Kind kind = Kind::Leaf;
    const Value* value = nullptr;                          ///< Leaf
    bool asFloat = false;                                  ///< Leaf: its numbers are floats
    std::string text;                                      ///< Text
    double time = 0;                                       ///< Time
    std::vector<std::pair<std::string, TreeNode>> members; ///< Object
    std::vector<TreeNode> elements;                        ///< Array
};

TreeNode layerTree(const Layer& layer);

} // namespace tss
