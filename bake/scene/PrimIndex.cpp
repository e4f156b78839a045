#include "bake/scene/PrimIndex.h"

#include "bake/scene/Schema.h"

#include <algorithm>

namespace tss {

namespace {

constexpr std::size_t mostPrims = 65536, mostNumbers = 8388608, deepest = 64;

std::vector<std::string> references(const Prim& prim) {
    const auto found = prim.metadata.find("references");
    return found == prim.metadata.end() ? std::vector<std::string>() : listItems(found->second);
}

bool flagOf(const Prim& prim, const char* key, bool fallback) {
    const bool* flag = member<bool>(prim.metadata, key);
    return flag ? *flag : fallback;
}

/// A path at or below one prim as the same below another; any other path stays.
void moveBelow(std::string& path, const std::string& from, const std::string& to) {
    if (path.starts_with(from) &&
        (path.size() == from.size() || path[from.size()] == '/' || path[from.size()] == '.'))
        path.replace(0, from.size(), to);
}

void moveBelow(Value& paths, const std::string& from, const std::string& to) {
    if (auto* array = paths.as<Value::Array>()) {
        for (Value& item : *array)
            if (auto* path = item.as<std::string>()) moveBelow(*path, from, to);
    } else if (auto* ops = paths.as<Value::Object>()) {
        for (auto& [op, items] : *ops) moveBelow(items, from, to);
    }
}

void moveAll(Composed& prim, const std::string& from, const std::string& to) {
    moveBelow(prim.place.path, from, to);
    for (auto& [name, property] : prim.prim.properties)
        if (property.targetPaths) moveBelow(*property.targetPaths, from, to);
    for (Composed& child : prim.children) moveAll(child, from, to);
}

bool hasValue(const Property& property) {
    return property.defaultValue || !property.timeSamples.empty() || property.targetPaths;
}

/// Schemas of both, less those that the stronger one takes away.
Value joinedSchemas(const Value& stronger, const Value& weaker) {
    std::vector<std::string> items = listItems(stronger), taken;
    if (const auto* ops = stronger.as<Value::Object>()) {
        if (ops->contains("explicit")) return stronger;
        if (const auto op = ops->find("delete"); op != ops->end()) taken = listItems(op->second);
    }
    const auto has = [](const std::vector<std::string>& list, const std::string& item) {
        return std::ranges::find(list, item) != list.end();
    };
    for (const std::string& item : listItems(weaker))
        if (!has(items, item) && !has(taken, item)) items.push_back(item);
    return Value(Value::Array(items.begin(), items.end()));
}

void merge(Composed& stronger, Composed weaker) {
    Prim &prim = stronger.prim, &below = weaker.prim;
    if (prim.specifier == "over") prim.specifier = below.specifier;
    if (prim.typeName.empty()) prim.typeName = below.typeName;
    if (const auto own = prim.metadata.find("apiSchemas"), theirs = below.metadata.find("apiSchemas");
        own != prim.metadata.end() && theirs != below.metadata.end())
        own->second = joinedSchemas(own->second, theirs->second);
    prim.metadata.merge(below.metadata);
    for (auto& [name, property] : below.properties) {
        const auto own = prim.properties.find(name);
        if (own != prim.properties.end() && hasValue(own->second)) continue;
        if (own != prim.properties.end())
            property.other.swap(own->second.other), property.other.merge(own->second.other);
        prim.properties[name] = std::move(property);
    }
    mergeChildren(
        stronger.children, std::move(weaker.children),
        [](const Composed& child) -> const std::string& { return child.prim.name; }, merge);
}

bool takesPart(const Prim& prim) {
    return prim.specifier == "def" && flagOf(prim, "active", true);
}

bool saysInvisible(const Prim& prim) {
    const Property* property = prim.property(schema::visibility.name);
    const auto* token =
        property && property->defaultValue ? property->defaultValue->as<std::string>() : nullptr;
    return token && *token == "invisible";
}

} // namespace

/// Composes prims of one layer. What one layer can make of itself by references is bounded, so that a small
/// file cannot fill the memory.
class Composer {
public:
    Composer(const Layer& layer, Problems& problems) : layer_(layer), problems_(problems) {}

    /// A reference to a prim that is not there, or that leads back to the prim, is a problem and left out.
    Composed compose(const Prim& prim, const Place& place) {
        Composed composed;
        composed.place = place;
        copy(prim, composed);
        if (full_) return composed;
        const auto targets = references(prim);
        open_.push_back(&prim);
        if (targets.empty() ||
            !flagOf(prim, "instanceable", false)) // what stands below an instance does not count
            for (std::size_t i = 0; i < prim.children.size() && !full_; ++i)
                composed.children.push_back(compose(prim.children[i], place.child(i, prim.children[i].name)));
        for (std::size_t i = 0; i < targets.size() && !full_; ++i) addReference(targets[i], place, composed);
        open_.pop_back();
        return composed;
    }

private:
    void copy(const Prim& prim, Composed& to) {
        ++prims_;
        for (const auto& [name, property] : prim.properties) numbers_ += numbersIn(property);
        if (prims_ > mostPrims || numbers_ > mostNumbers) {
            if (!full_)
                problems_.add(to.place / "metadata" / "references", "expected references that make at most ",
                              mostPrims, " prims and ", mostNumbers, " numbers in all");
            full_ = true;
            return;
        }
        to.prim = {prim.specifier, prim.typeName, prim.name, prim.metadata, prim.properties, {}, prim.other};
    }

    void addBelow(const std::vector<Prim>& prims, const Place& place) {
        for (std::size_t i = 0; i < prims.size(); ++i) {
            const Place at = place.child(i, prims[i].name);
            all_[at.path] = {&prims[i], at};
            addBelow(prims[i].children, at);
        }
    }

    void addReference(const std::string& target, const Place& at, Composed& to) {
        const Place place = at / "metadata" / "references";
        if (all_.empty()) addBelow(layer_.children, {});
        const auto found = all_.find(target);
        const Prim* const base = found == all_.end() ? nullptr : found->second.first;
        if (!base)
            problems_.add(place, "expected the path of a prim of this file, found \"", target, "\"");
        else if (std::ranges::find(open_, base) != open_.end())
            problems_.add(place, "expected a reference that does not lead back to this prim, found \"",
                          target, "\"");
        else if (open_.size() >= deepest)
            problems_.add(place, "expected at most ", deepest, " levels of references");
        else {
            Composed weaker = compose(*base, found->second.second);
            moveAll(weaker, target, at.path);
            merge(to, std::move(weaker));
        }
    }

    const Layer& layer_;
    Problems& problems_;
    std::map<std::string, std::pair<const Prim*, Place>> all_; ///< every prim by its path, once one is needed
    std::vector<const Prim*> open_;                            ///< whose references are being composed
    std::size_t prims_ = 0, numbers_ = 0;
    bool full_ = false;
};

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
        if (prims[i].metadata.contains("references") && prims[i].specifier == "def") {
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
