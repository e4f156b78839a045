#include "bake/scene/PrimIndex.h"

#include "bake/scene/Schema.h"

namespace tss {

namespace {

bool takesPart(const Prim& prim) {
    const auto active = prim.metadata.find("active");
    const bool* flag = active == prim.metadata.end() ? nullptr : active->second.as<bool>();
    return prim.specifier == "def" && (!flag || *flag);
}

bool saysInvisible(const Prim& prim) {
    const Property* property = prim.property(schema::visibility.name);
    const auto* token =
        property && property->defaultValue ? property->defaultValue->as<std::string>() : nullptr;
    return token && *token == "invisible";
}

} // namespace

PrimIndex::PrimIndex(const Layer& layer) {
    add(layer.children, {}, -1);
}

void PrimIndex::add(const std::vector<Prim>& prims, const Place& place, int parent) {
    for (std::size_t i = 0; i < prims.size(); ++i) {
        if (!takesPart(prims[i])) continue;
        Place at = place / std::string("primChildren") / i;
        at.path += "/" + prims[i].name;
        const int index = static_cast<int>(entries.size());
        const bool visible = (parent < 0 || entries[parent].visible) && !saysInvisible(prims[i]);
        entries.push_back({&prims[i], at, parent, visible});
        byPath_.emplace(at.path, index);
        add(prims[i].children, at, index);
    }
}

int PrimIndex::find(const std::string& path) const {
    const auto found = byPath_.find(path);
    return found == byPath_.end() ? -1 : found->second;
}

} // namespace tss
