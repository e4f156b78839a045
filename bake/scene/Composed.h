#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

#include <map>

namespace tss {

/// A prim with what the prims that it references give it, as in USD: its own type, metadata, properties and
/// children are stronger than theirs, and their paths inside of themselves become paths inside of it.
struct Composed {
    Prim prim; ///< without children
    Place place;
    std::vector<Composed> children;
};

/// The prim has internal references: metadata "references", paths of prims of the same layer.
bool hasReferences(const Prim& prim);

/// Composes prims of one layer. What one layer can make of itself by references is bounded, so that a small
/// file cannot fill the memory.
class Composer {
public:
    Composer(const Layer& layer, Problems& problems) : layer_(layer), problems_(problems) {}

    /// A reference to a prim that is not there, or that leads back to the prim, is a problem and left out.
    Composed compose(const Prim& prim, const Place& place);

private:
    void copy(const Prim& prim, Composed& to);
    void addBelow(const std::vector<Prim>& prims, const Place& place);
    void addReference(const std::string& target, const Place& at, Composed& to);

    const Layer& layer_;
    Problems& problems_;
    std::map<std::string, std::pair<const Prim*, Place>> all_; ///< every prim by its path, once one is needed
    std::vector<const Prim*> open_;                            ///< whose references are being composed
    std::size_t prims_ = 0, numbers_ = 0;
    bool full_ = false;
};

} // namespace tss
