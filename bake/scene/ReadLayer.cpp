#include "bake/scene/ReadLayer.h"

#include "bake/base/AtomicFile.h"
#include "bake/scene/Buffers.h"
#include "bake/scene/ReadProperty.h"
#include "bake/scene/ReadTree.h"

#include <charconv>
#include <set>

namespace tss {

namespace {

constexpr int knownMajor = 1, knownMinor = 0;

Value::Object* objectAt(Value& value, const Place& place, Problems& problems) {
    auto* object = value.as<Value::Object>();
    if (!object) problems.add(place, "expected an object, found " + describe(value));
    return object;
}

/// The text under a key, `fallback` when it is absent.
std::string textAt(const Value::Object& object, const char* key, const char* fallback, const Place& place,
                   Problems& problems) {
    const auto it = object.find(key);
    if (it == object.end()) return fallback;
    if (const auto* text = it->second.as<std::string>()) return *text;
    problems.add(place / std::string(key), "expected a string, found " + describe(it->second));
    return fallback;
}

void checkVersion(const std::string& version, const Place& place, Problems& problems) {
    int major = 0, minor = 0;
    const char* const end = version.data() + version.size();
    const auto whole = std::from_chars(version.data(), end, major);
    const bool dotted = whole.ec == std::errc() && whole.ptr != end && *whole.ptr == '.';
    const auto part = dotted ? std::from_chars(whole.ptr + 1, end, minor) : whole;
    if (!dotted || part.ec != std::errc() || part.ptr != end || major < 0 || minor < 0)
        return problems.add(place, "expected a version \"major.minor\", found \"" + version + "\"");
    if (major != knownMajor)
        problems.add(place, "expected version 1.x, found " + version + ": this program cannot read it");
    else if (minor > knownMinor)
        problems.warn(place,
                      "version " + version + " is newer than 1.0: what is new in it is kept but not used");
}

void takeMetadata(Value::Object& keys, Value::Object& metadata, const Place& place, Problems& problems) {
    const auto it = keys.find("metadata");
    if (it == keys.end()) return;
    const Place at = place / std::string("metadata");
    if (auto* object = objectAt(it->second, at, problems)) metadata = std::move(*object);
    keys.erase(it);
    if (const auto schemas = metadata.find("apiSchemas"); schemas != metadata.end())
        checkList(schemas->second, at / std::string("apiSchemas"), "names of API schemas", problems);
    for (const char* key :
         {"subLayers", "payload", "variantSets", "variantSelection", "inheritPaths", "specializes"})
        if (metadata.contains(key))
            problems.warn(at / std::string(key),
                          std::string(key) + " is kept, but what it would bring into the scene does not "
                                             "count: references alone are composed");
    if (const auto references = metadata.find("references"); references != metadata.end()) {
        checkList(references->second, at / std::string("references"), "paths", problems);
        checkPaths(references->second, at / std::string("references"), problems);
    }
}

std::vector<Prim> takeChildren(Value::Object& keys, const Place& place, Problems& problems);

void takeProperties(Value::Object& keys, Prim& prim, const Place& place, Problems& problems) {
    const auto it = keys.find("properties");
    if (it == keys.end()) return;
    const Place at = place / std::string("properties");
    if (auto* properties = objectAt(it->second, at, problems))
        for (auto& [name, value] : *properties) {
            Place of = at / name;
            of.path = place.path + "." + name;
            if (!isPropertyName(name))
                problems.add(of,
                             "expected a property name of words [A-Za-z_][A-Za-z0-9_]* with colons between");
            else if (objectAt(value, of, problems))
                prim.properties.emplace(name, readProperty(std::move(value), of, problems));
        }
    keys.erase(it);
}

/// A key of text, taken out of the keys.
std::string takeText(Value::Object& keys, const char* key, const char* fallback, const Place& place,
                     Problems& problems) {
    std::string text = textAt(keys, key, fallback, place, problems);
    keys.erase(key);
    return text;
}

Prim primFromKeys(Value::Object& keys, const std::string& name, const Place& place, Problems& problems) {
    Prim prim;
    prim.name = name;
    keys.erase("name");
    prim.specifier = takeText(keys, "specifier", "def", place, problems);
    if (prim.specifier != "def" && prim.specifier != "over" && prim.specifier != "class")
        problems.add(place / std::string("specifier"),
                     "expected \"def\", \"over\" or \"class\", found \"" + prim.specifier + "\"");
    prim.typeName = takeText(keys, "typeName", "", place, problems);
    if (!prim.typeName.empty() && !isPrimName(prim.typeName))
        problems.add(place / std::string("typeName"),
                     "expected a schema name, found \"" + prim.typeName + "\"");
    takeMetadata(keys, prim.metadata, place, problems);
    takeProperties(keys, prim, place, problems);
    prim.children = takeChildren(keys, place, problems);
    prim.other = std::move(keys);
    return prim;
}

std::vector<Prim> takeChildren(Value::Object& keys, const Place& place, Problems& problems) {
    std::vector<Prim> prims;
    const auto it = keys.find("primChildren");
    if (it == keys.end()) return prims;
    const Place at = place / std::string("primChildren");
    auto* array = it->second.as<Value::Array>();
    if (const auto* numbers = it->second.as<Numbers>())
        problems.add(at / std::size_t(0), "expected an object, found " + describe(numbers->element(0)));
    else if (!array)
        problems.add(at, "expected an array of prims, found " + describe(it->second));
    std::set<std::string> names;
    for (std::size_t i = 0; array && i < array->size(); ++i) {
        Place of = at / i;
        Value::Object* child = objectAt((*array)[i], of, problems);
        if (!child) continue;
        const std::string name = textAt(*child, "name", "", of, problems);
        of.path += "/" + name;
        if (!isPrimName(name))
            problems.add(of / std::string("name"),
                         "expected a prim name [A-Za-z_][A-Za-z0-9_]*, found \"" + name + "\"");
        else if (!names.insert(name).second)
            problems.add(of / std::string("name"),
                         "expected a name that no sibling has, found \"" + name + "\"");
        else
            prims.push_back(primFromKeys(*child, name, of, problems));
    }
    keys.erase(it);
    return prims;
}

} // namespace

Layer layerFromValue(Value root, Problems& problems) {
    Layer layer;
    const Place top;
    auto* keys = objectAt(root, top, problems);
    if (!keys) return layer;
    if (textAt(*keys, "format", "", top, problems) != "osgtss") {
        problems.add(top / std::string("format"), "expected \"osgtss\": this is not a scene file of osgTSS");
        return layer;
    }
    keys->erase("format");
    layer.formatVersion = takeText(*keys, "formatVersion", "", top, problems);
    checkVersion(layer.formatVersion, top / std::string("formatVersion"), problems);
    takeMetadata(*keys, layer.metadata, top, problems);
    layer.children = takeChildren(*keys, top, problems);
    layer.other = std::move(*keys);
    return layer;
}

Layer parseLayer(std::string_view text, const std::string& fileName, Problems& problems) {
    if (text.starts_with("#usda"))
        throw InputError(Where{fileName, "", ""},
                         "is a layer of USD; `tss convert` or `tss make` makes a scene of it, a .tss");
    Value root = looksLikeCbor(text) ? parseCbor(text, fileName) : parseJson(text, fileName);
    inlineBuffers(root, fileName, problems);
    return layerFromValue(std::move(root), problems);
}

Layer parseLayer(std::string_view text, const std::string& fileName) {
    Problems problems(fileName);
    return parseLayer(text, fileName, problems);
}

Layer readLayer(const std::string& file) {
    return parseLayer(readWholeFile(file), file);
}

} // namespace tss
