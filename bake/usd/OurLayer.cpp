#include "bake/usd/OurLayer.h"

#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/ReadTree.h"
#include "bake/scene/ValueType.h"
#include "bake/scene/WriteUsda.h"

namespace tss {

namespace {

bool isTss(const std::string& name) {
    return name.starts_with("Tss");
}

bool hasTss(const Prim& prim) {
    if (isTss(prim.typeName)) return true;
    if (const auto schemas = prim.metadata.find("apiSchemas"); schemas != prim.metadata.end())
        for (const std::string& api : listItems(schemas->second))
            if (isTss(api)) return true;
    for (const Prim& child : prim.children)
        if (hasTss(child)) return true;
    return false;
}

class Restoration {
public:
    explicit Restoration(std::string file) : file_(std::move(file)) {}

    void checkNames(const Prim& prim, const std::string& parent) const {
        const std::string path = parent + "/" + prim.name;
        if (!isPrimName(prim.name)) refuse(path, "expected a prim name [A-Za-z_][A-Za-z0-9_]*");
        for (const auto& [name, property] : prim.properties)
            if (!isPropertyName(name))
                refuse(path + "." + name,
                       "expected a property name of words [A-Za-z_][A-Za-z0-9_]* with colons between");
        for (const Prim& child : prim.children) checkNames(child, path);
    }

    void restore(Layer& layer) const {
        takeBack(layer.metadata, "customLayerData", usda::unknownMetadata, layer.metadata, "/");
        takeBack(layer.metadata, "customLayerData", usda::unknownKeys, layer.other, "/");
        for (Prim& prim : layer.children) restore(prim, "");
    }

private:
    [[noreturn]] void refuse(const std::string& path, const std::string& message) const {
        throw InputError(Where{file_, "", path}, message);
    }

    Value::Object object(const std::string& json, const std::string& path) const {
        try {
            Value value = parseJson(json, file_);
            if (auto* object = value.as<Value::Object>()) return std::move(*object);
        } catch (const InputError& error) {
            refuse(path, "what osgTSS keeps as JSON: " + error.message);
        }
        refuse(path, "what osgTSS keeps as JSON: expected an object");
    }

    /// Out of the dictionary, whose last entry it may be.
    void takeBack(Value::Object& holder, const char* dictionary, const char* key, Value::Object& to,
                  const std::string& path) const {
        const auto found = holder.find(dictionary);
        auto* data = found == holder.end() ? nullptr : found->second.as<Value::Object>();
        const auto json = data ? data->find(key) : Value::Object::iterator();
        if (!data || json == data->end()) return;
        const auto* text = json->second.as<std::string>();
        if (!text) return;
        Value::Object kept = object(*text, path);
        data->erase(json);
        if (data->empty()) holder.erase(found);
        to.merge(kept);
    }

    void restore(Prim& prim, const std::string& parent) const {
        const std::string path = parent + "/" + prim.name;
        takeBack(prim.metadata, "customData", usda::unknownMetadata, prim.metadata, path);
        takeBack(prim.metadata, "customData", usda::unknownKeys, prim.other, path);
        for (auto& [name, property] : prim.properties) restore(property, path + "." + name);
        for (Prim& child : prim.children) restore(child, path);
    }

    void restore(Property& property, const std::string& path) const {
        takeBack(property.other, "customData", usda::unknownMetadata, property.other, path);
        const auto* text = property.defaultValue ? property.defaultValue->as<std::string>() : nullptr;
        const auto custom = property.other.find("custom");
        if (!text || property.typeName != "string" || custom == property.other.end() ||
            !text->starts_with("{") || text->find("\"typeName\": \"") == text->npos)
            return;
        const Value kept(object(*text, path));
        const auto* name = member<std::string>(*kept.as<Value::Object>(), "typeName");
        if (!name || valueType(*name)) return; // a text that only looks like it
        Problems problems(file_);
        property = readProperty(kept, {"", path}, problems);
    }

    std::string file_;
};

} // namespace

bool restoreOurs(Layer& layer, const std::string& file) {
    const auto found = layer.metadata.find("customLayerData");
    auto* data = found == layer.metadata.end() ? nullptr : found->second.as<Value::Object>();
    const auto mark = data ? data->find(usda::mark) : Value::Object::iterator();
    const bool marked = data && mark != data->end() && mark->second.as<std::string>();
    bool ours = marked;
    for (const Prim& prim : layer.children) ours = ours || hasTss(prim);
    if (!ours) return false;
    const Restoration restoration(file);
    for (const Prim& prim : layer.children) restoration.checkNames(prim, "");
    if (marked) {
        layer.formatVersion = *mark->second.as<std::string>();
        data->erase(mark);
        if (data->empty()) layer.metadata.erase(found);
        restoration.restore(layer);
    }
    return true;
}

} // namespace tss
