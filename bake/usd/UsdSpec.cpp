#include "bake/usd/UsdSpec.h"

#include "bake/usd/MergePrims.h"

#include <algorithm>

namespace tss {

namespace {

/// About what a value takes in memory, in bytes.
std::size_t costOf(const Value& value) {
    std::size_t cost = sizeof(Value);
    if (const auto* numbers = value.as<Numbers>()) cost += sizeof(double) * numbers->values.size();
    if (const auto* text = value.as<std::string>()) cost += text->size();
    if (const auto* array = value.as<Value::Array>())
        for (const Value& item : *array) cost += costOf(item);
    if (const auto* object = value.as<Value::Object>())
        for (const auto& [key, item] : *object) cost += 64 + key.size() + costOf(item);
    return cost;
}

} // namespace

std::size_t costOf(const Prim& prim) {
    std::size_t cost = sizeof(Prim) + 128 + costOf(Value(prim.metadata));
    for (const auto& [name, property] : prim.properties) {
        cost += sizeof(Property) + 160 + name.size();
        if (property.defaultValue) cost += costOf(*property.defaultValue);
        if (property.targetPaths) cost += costOf(*property.targetPaths);
        for (const Property::Sample& sample : property.timeSamples)
            cost += sizeof(double) + costOf(sample.value);
        for (const auto& [key, value] : property.other) cost += 64 + key.size() + costOf(value);
    }
    return cost;
}

std::size_t costOf(const UsdSpec& spec) {
    std::size_t cost = costOf(spec.prim);
    for (const UsdSpec& child : spec.children) cost += costOf(child);
    for (const UsdVariantSet& set : spec.variantSets)
        for (const UsdSpec& variant : set.variants) cost += costOf(variant);
    return cost;
}

std::vector<std::string> arcsOf(const Prim& prim, const char* key) {
    const auto found = prim.metadata.find(key);
    return found == prim.metadata.end() ? std::vector<std::string>() : listItems(found->second);
}

static void mergeSpec(UsdSpec& stronger, UsdSpec weaker) {
    mergeUnder(stronger.prim, std::move(weaker.prim));
    mergeSpecs(stronger.children, std::move(weaker.children));
    for (UsdVariantSet& set : weaker.variantSets) {
        const auto same = std::ranges::find_if(stronger.variantSets,
                                               [&](const UsdVariantSet& s) { return s.name == set.name; });
        if (same == stronger.variantSets.end())
            stronger.variantSets.push_back(std::move(set));
        else
            mergeSpecs(same->variants, std::move(set.variants));
    }
}

void mergeSpecs(std::vector<UsdSpec>& stronger, std::vector<UsdSpec> weaker) {
    mergeChildren(
        stronger, std::move(weaker),
        [](const UsdSpec& child) -> const std::string& { return child.prim.name; }, mergeSpec);
}

bool needsComposition(const UsdSpec& spec) {
    if (!spec.variantSets.empty()) return true;
    for (const char* key : {"payload", "inheritPaths", "specializes", "variantSelection", "variantSets"})
        if (spec.prim.metadata.contains(key)) return true;
    for (const std::string& arc : arcsOf(spec.prim, "references"))
        if (arc.starts_with('@')) return true;
    return std::ranges::any_of(spec.children, needsComposition);
}

} // namespace tss
