#include "bake/scene/Layer.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tss {

namespace {

/// Cuts the first name off a path: "/Jaw/Hinge" gives "Jaw" and leaves "/Hinge".
std::string_view takeName(std::string_view& path) {
    if (path.empty() || path[0] != '/') return {};
    const auto end = path.find('/', 1);
    const std::string_view name = path.substr(1, end == std::string_view::npos ? end : end - 1);
    path = end == std::string_view::npos ? std::string_view() : path.substr(end);
    return name;
}

const Prim* named(const std::vector<Prim>& prims, std::string_view name) {
    const auto found = std::ranges::find(prims, name, &Prim::name);
    return found == prims.end() ? nullptr : &*found;
}

void appendItems(const Value::Object& ops, const char* key, std::vector<std::string>& items) {
    const auto op = ops.find(key);
    if (op == ops.end()) return;
    for (const std::string& item : listItems(op->second))
        if (std::ranges::find(items, item) == items.end()) items.push_back(item);
}

} // namespace

const Property* Prim::property(std::string_view name) const {
    const auto it = properties.find(std::string(name));
    return it == properties.end() ? nullptr : &it->second;
}

const Prim* Prim::child(std::string_view name) const {
    return named(children, name);
}

const Prim* findPrim(const Layer& layer, std::string_view path) {
    const std::vector<Prim>* level = &layer.children;
    const Prim* found = nullptr;
    while (!path.empty()) {
        found = named(*level, takeName(path));
        if (!found) return nullptr;
        level = &found->children;
    }
    return found;
}
Prim* findPrim(Layer& layer, std::string_view path) {
    return const_cast<Prim*>(findPrim(std::as_const(layer), path));
}

Prim& makePrim(Layer& layer, std::string_view path, const std::string& typeName) {
    std::vector<Prim>* level = &layer.children;
    Prim* prim = nullptr;
    const std::string_view whole = path;
    while (!path.empty()) {
        const std::string_view name = takeName(path);
        if (!isPrimName(name))
            throw InputError({"", "", std::string(whole)},
                             "expected a prim path of names [A-Za-z_][A-Za-z0-9_]*");
        auto it = std::ranges::find(*level, name, &Prim::name);
        if (it == level->end()) {
            Prim made;
            made.name = name;
            made.typeName = path.empty() ? typeName : "Xform";
            it = level->insert(level->end(), std::move(made));
        }
        prim = &*it;
        level = &prim->children;
    }
    if (!prim) throw std::logic_error("makePrim: empty path");
    return *prim;
}

void removePrim(Layer& layer, std::string_view path) {
    const auto slash = path.rfind('/');
    if (slash == std::string_view::npos) return;
    Prim* parent = slash == 0 ? nullptr : findPrim(layer, path.substr(0, slash));
    if (slash != 0 && !parent) return;
    std::erase_if(parent ? parent->children : layer.children,
                  [&](const Prim& prim) { return prim.name == path.substr(slash + 1); });
}

std::vector<std::string> listItems(const Value& value) {
    std::vector<std::string> items;
    if (const auto* array = value.as<Value::Array>()) {
        for (const Value& item : *array)
            if (const auto* text = item.as<std::string>()) items.push_back(*text);
    } else if (const auto* ops = value.as<Value::Object>()) {
        for (const char* key : {"explicit", "prepend", "add", "append"}) appendItems(*ops, key, items);
    }
    return items;
}

bool hasApi(const Prim& prim, std::string_view api) {
    const auto schemas = prim.metadata.find("apiSchemas");
    if (schemas == prim.metadata.end()) return false;
    const auto items = listItems(schemas->second);
    return std::ranges::find(items, api) != items.end();
}

void addApi(Prim& prim, const std::string& api) {
    if (hasApi(prim, api)) return;
    Value& schemas = prim.metadata["apiSchemas"];
    if (!schemas.as<Value::Object>()) {
        const auto items = listItems(schemas);
        Value::Object ops;
        if (!items.empty()) ops["explicit"] = schemas;
        schemas = Value(std::move(ops));
    }
    auto& ops = *schemas.as<Value::Object>();
    Value& list = ops[ops.contains("explicit") ? "explicit" : "prepend"];
    if (!list.as<Value::Array>()) list = Value(Value::Array());
    list.as<Value::Array>()->emplace_back(api);
}

std::size_t numbersIn(const Property& property) {
    const auto count = [](const Value& value) {
        const Numbers* numbers = value.as<Numbers>();
        const auto* array = value.as<Value::Array>();
        return numbers ? numbers->values.size() : array ? array->size() : 1;
    };
    std::size_t sum = property.defaultValue ? count(*property.defaultValue) : 0;
    for (const Property::Sample& sample : property.timeSamples) sum += count(sample.value);
    return sum;
}

bool isPrimName(std::string_view name) {
    const auto letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; };
    if (name.empty() || !letter(name[0])) return false;
    return std::ranges::all_of(name, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

} // namespace tss
