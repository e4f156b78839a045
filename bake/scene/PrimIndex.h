#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

namespace tss {

/// A prim of the scene with where it stands.
struct PrimEntry {
    const Prim* prim = nullptr;
    Place place;
    int parent = -1;     ///< index of the parent's entry
    bool visible = true; ///< neither it nor a parent says `invisible`
};

/// All prims that take part in the scene, parents before children, in the order of the file. Classes, overs
/// and what is not active do not take part, nor what is below them.
class PrimIndex {
public:
    explicit PrimIndex(const Layer& layer);

    std::vector<PrimEntry> entries;

    /// Index of the entry with this path, -1 when there is none.
    int find(const std::string& path) const;

private:
    void add(const std::vector<Prim>& prims, const Place& place, int parent);
    std::map<std::string, int> byPath_;
};

} // namespace tss
