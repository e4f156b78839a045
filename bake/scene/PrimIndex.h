#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

#include <deque>
#include <map>

namespace tss {

/// A prim with what the prims that it references give it, as in USD: its own type, metadata, properties and
/// children are stronger than theirs, and their paths inside of themselves become paths inside of it.
struct Composed {
    Prim prim; ///< without children
    Place place;
    std::vector<Composed> children;
};

/// A prim of the scene with where it stands.
struct PrimEntry {
    const Prim* prim = nullptr;
    Place place;
    int parent = -1;       ///< index of the parent's entry
    bool visible = true;   ///< neither it nor a parent says `invisible`
    bool composed = false; ///< it or a parent has references
};

class Composer;

/// All prims that take part in the scene, parents before children, in the order of the file, with what their
/// references give them. Classes, overs and what is not active do not take part, nor what is below them.
class PrimIndex {
public:
    /// References that cannot be followed go to the problems.
    PrimIndex(const Layer& layer, Problems& problems);
    PrimIndex(const PrimIndex&) = delete;

    std::vector<PrimEntry> entries;

    /// Index of the entry with this path, -1 when there is none.
    int find(const std::string& path) const;

private:
    void add(const std::vector<Prim>& prims, const Place& place, int parent, Composer& composer);
    void add(const Composed& composed, int parent);
    int addEntry(const Prim& prim, const Place& place, int parent, bool composed);

    std::deque<Composed> composed_; ///< what entries with references point into
    std::map<std::string, int> byPath_;
};

} // namespace tss
