#pragma once
#include "bake/base/Order.h"

namespace tss {

/// Disjoint sets (union-find, Tarjan 1975). The root of a set is its member of lowest index.
class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(indicesOf<std::size_t>(count)) {}

    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(std::size_t i, std::size_t j) {
        const std::size_t a = root(i), b = root(j);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parent_;
};

} // namespace tss
