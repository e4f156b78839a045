#include "bake/usd/MergePrims.h"

#include <algorithm>
#include <array>
#include <set>

namespace tss {

namespace {

constexpr std::array listKeys = {"apiSchemas",   "references",  "payload",
                                 "inheritPaths", "specializes", "variantSets"};

Value::Array itemsOf(const Value::Object& ops, const char* op) {
    const auto* items = member<Value::Array>(ops, op);
    return items ? *items : Value::Array();
}

/// The stronger list's operations on the weaker one: a list where that is one, operations on what is weaker
/// yet where it has operations itself.
Value joinedLists(const Value& stronger, const Value& weaker) {
    const auto *ops = stronger.as<Value::Object>(), *theirs = weaker.as<Value::Object>();
    if (!ops || ops->contains("explicit")) return stronger; // it says all there is
    std::set<std::string> said;
    for (const char* op : {"prepend", "append", "add", "delete"})
        for (const Value& item : itemsOf(*ops, op)) said.insert(*item.as<std::string>());
    const auto take = [&](const Value::Array& items, Value::Array& all) {
        for (const Value& item : items)
            if (!said.contains(*item.as<std::string>())) all.push_back(item);
    };
    Value::Array first = itemsOf(*ops, "prepend"), last, gone = itemsOf(*ops, "delete");
    if (theirs && !theirs->contains("explicit")) {
        take(itemsOf(*theirs, "prepend"), first);
        take(itemsOf(*theirs, "delete"), gone);
        for (const char* op : {"add", "append"}) take(itemsOf(*theirs, op), last);
    } else {
        const std::vector<std::string> items = listItems(weaker);
        take(Value::Array(items.begin(), items.end()), first);
    }
    for (const char* op : {"add", "append"})
        for (const Value& item : itemsOf(*ops, op)) last.push_back(item);
    if (!theirs || theirs->contains("explicit")) {
        first.insert(first.end(), last.begin(), last.end());
        return Value(std::move(first));
    }
    Value::Object joined;
    for (auto& [op, items] :
         {std::pair<const char*, Value::Array*>{"prepend", &first}, {"append", &last}, {"delete", &gone}})
        if (!items->empty()) joined.emplace(op, Value(std::move(*items)));
    return Value(std::move(joined));
}

void mergeDictionary(Value& stronger, Value& weaker) {
    auto *own = stronger.as<Value::Object>(), *theirs = weaker.as<Value::Object>();
    if (!own || !theirs) return;
    for (auto& [key, value] : *theirs)
        if (const auto [at, isNew] = own->try_emplace(key, std::move(value)); !isNew)
            mergeDictionary(at->second, value);
}

bool hasValue(const Property& property) {
    return property.defaultValue || !property.timeSamples.empty();
}

void mergeProperty(Property& own, Property weaker) {
    if (own.targetPaths && weaker.targetPaths)
        own.targetPaths = joinedLists(*own.targetPaths, *weaker.targetPaths);
    else if (!own.targetPaths && !weaker.targetPaths && !hasValue(own)) {
        own.typeName = weaker.typeName;
        own.defaultValue = std::move(weaker.defaultValue);
        own.timeSamples = std::move(weaker.timeSamples);
    } else if (!own.targetPaths && !weaker.targetPaths && !own.defaultValue) {
        own.defaultValue = std::move(weaker.defaultValue); // time samples say nothing of the default
    }
    own.other.merge(weaker.other);
}

} // namespace

void mergeMetadata(Value::Object& stronger, Value::Object weaker) {
    for (auto& [key, value] : weaker) {
        const auto [at, isNew] = stronger.try_emplace(key, std::move(value));
        if (isNew) continue;
        if (std::ranges::find(listKeys, key) != listKeys.end())
            at->second = joinedLists(at->second, value);
        else
            mergeDictionary(at->second, value);
    }
}

void mergeUnder(Prim& stronger, Prim weaker) {
    if (stronger.specifier == "over") stronger.specifier = weaker.specifier;
    if (stronger.typeName.empty()) stronger.typeName = weaker.typeName;
    mergeMetadata(stronger.metadata, std::move(weaker.metadata));
    for (auto& [name, property] : weaker.properties)
        if (const auto [at, isNew] = stronger.properties.try_emplace(name, std::move(property)); !isNew)
            mergeProperty(at->second, std::move(property));
    mergeChildren(
        stronger.children, std::move(weaker.children),
        [](const Prim& child) -> const std::string& { return child.name; }, mergeUnder);
}

void mapPaths(Prim& prim, const MapPath& map) {
    const std::function<void(Value&)> mapAll = [&](Value& paths) {
        if (auto* array = paths.as<Value::Array>()) {
            std::erase_if(*array, [&](Value& item) {
                const auto* path = item.as<std::string>();
                if (!path) return false;
                const std::optional<std::string> there = map(*path);
                if (there) item = Value(*there);
                return !there;
            });
        } else if (auto* ops = paths.as<Value::Object>()) {
            for (auto& [op, items] : *ops) mapAll(items);
        }
    };
    for (auto& [name, property] : prim.properties) {
        if (property.targetPaths) mapAll(*property.targetPaths);
        if (const auto found = property.other.find("connectionPaths"); found != property.other.end())
            mapAll(found->second);
    }
}

} // namespace tss
