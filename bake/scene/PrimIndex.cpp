#include "bake/scene/PrimIndex.h"

#include "bake/scene/Schema.h"

namespace tss {

namespace {

bool takesPart(const Prim& prim) {
    const bool* flag = member<bool>(prim.metadata, "active");
    return prim.specifier == "def" && (!flag || *flag);
}

bool saysInvisible(const Prim& prim) {
    const Property* property = prim.property(schema::visibility.name);
    const auto* token =
        property && property->defaultValue ? property->defaultValue->as<std::string>() : nullptr;
    return token && *token == "invisible";
}

} // namespace

PrimIndex::PrimIndex(const Layer& layer, Problems& problems) {
    Composer composer(layer, problems);
    add(layer.children, {}, -1, composer);
}

int PrimIndex::addEntry(const Prim& prim, const Place& place, int parent, bool composed) {
    const int index = static_cast<int>(entries.size());
    const bool visible = (parent < 0 || entries[parent].visible) && !saysInvisible(prim);
    entries.push_back({&prim, place, parent, visible, composed});
    byPath_.emplace(place.path, index);
    return index;
}

void PrimIndex::add(const std::vector<Prim>& prims, const Place& place, int parent, Composer& composer) {
    for (std::size_t i = 0; i < prims.size(); ++i) {
        const Place at = place.child(i, prims[i].name);
        if (hasReferences(prims[i]) && prims[i].specifier == "def") {
            composed_.push_back(composer.compose(prims[i], at));
            add(composed_.back(), parent);
        } else if (takesPart(prims[i])) {
            add(prims[i].children, at, addEntry(prims[i], at, parent, false), composer);
        }
    }
}

void PrimIndex::add(const Composed& composed, int parent) {
    if (!takesPart(composed.prim)) return;
    const int index = addEntry(composed.prim, composed.place, parent, true);
    for (const Composed& child : composed.children) add(child, index);
}

int PrimIndex::find(const std::string& path) const {
    const auto found = byPath_.find(path);
    return found == byPath_.end() ? -1 : found->second;
}

} // namespace tss
