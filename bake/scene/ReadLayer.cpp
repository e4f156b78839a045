#include "bake/scene/ReadLayer.h"

#include "bake/base/AtomicFile.h"
#include "bake/scene/LayerReader.h"
#include "bake/scene/ReadTree.h"

#include <charconv>
#include <set>

namespace tss {

namespace {
constexpr int knownMajor = 1, knownMinor = 0;
} // namespace

Value::Object* LayerReader::object(Value& value, const Place& place) {
    auto* object = value.as<Value::Object>();
    if (!object) problems.add(place, "expected an object, found ", describe(value));
    return object;
}

/// The text under a key, `fallback` when it is absent, taken out of the keys.
std::string LayerReader::takeText(Value::Object& keys, const char* key, const char* fallback,
                                  const Place& place) {
    auto taken = keys.extract(key);
    if (!taken) return fallback;
    if (auto* text = taken.mapped().as<std::string>()) return std::move(*text);
    problems.add(place / key, "expected a string, found ", describe(taken.mapped()));
    return fallback;
}

void LayerReader::checkVersion(const std::string& version, const Place& place) {
    int major = 0, minor = 0;
    const char* const end = version.data() + version.size();
    const auto whole = std::from_chars(version.data(), end, major);
    const bool dotted = whole.ec == std::errc() && whole.ptr != end && *whole.ptr == '.';
    const auto part = dotted ? std::from_chars(whole.ptr + 1, end, minor) : whole;
    if (!dotted || part.ec != std::errc() || part.ptr != end || major < 0 || minor < 0)
        return problems.add(place, "expected a version \"major.minor\", found \"", version, "\"");
    if (major != knownMajor)
        problems.add(place, "expected version 1.x, found ", version, ": this program cannot read it");
    else if (minor > knownMinor)
        problems.warn(place, "version ", version,
                      " is newer than 1.0: what is new in it is kept but not used");
}

Value::Object LayerReader::takeMetadata(Value::Object& keys, const Place& place) {
    Value::Object metadata;
    auto taken = keys.extract("metadata");
    if (!taken) return metadata;
    const Place at = place / "metadata";
    if (auto* found = object(taken.mapped(), at)) metadata = std::move(*found);
    if (const auto schemas = metadata.find("apiSchemas"); schemas != metadata.end())
        checkList(schemas->second, at / "apiSchemas", "names of API schemas");
    for (const char* key :
         {"subLayers", "payload", "variantSets", "variantSelection", "inheritPaths", "specializes"})
        if (metadata.contains(key))
            problems.warn(at / key, key,
                          " is kept, but what it would bring into the scene does not count: references alone "
                          "are composed");
    if (const auto references = metadata.find("references"); references != metadata.end()) {
        checkList(references->second, at / "references", "paths");
        checkPaths(references->second, at / "references");
    }
    return metadata;
}

void LayerReader::takeProperties(Value::Object& keys, Prim& prim, const Place& place) {
    auto taken = keys.extract("properties");
    auto* properties = taken ? object(taken.mapped(), place / "properties") : nullptr;
    if (!properties) return;
    for (auto& [name, value] : *properties) {
        const Place of = place.property(name);
        if (!isPropertyName(name))
            problems.add(of, "expected a property name of words [A-Za-z_][A-Za-z0-9_]* with colons between");
        else if (auto* found = object(value, of))
            prim.properties.emplace(name, readProperty(std::move(*found), of));
    }
}

Prim LayerReader::readPrim(Value::Object& keys, const std::string& name, const Place& place) {
    Prim prim;
    prim.name = name;
    prim.specifier = takeText(keys, "specifier", "def", place);
    if (prim.specifier != "def" && prim.specifier != "over" && prim.specifier != "class")
        problems.add(place / "specifier", "expected \"def\", \"over\" or \"class\", found \"", prim.specifier,
                     "\"");
    prim.typeName = takeText(keys, "typeName", "", place);
    if (!prim.typeName.empty() && !isPrimName(prim.typeName))
        problems.add(place / "typeName", "expected a schema name, found \"", prim.typeName, "\"");
    prim.metadata = takeMetadata(keys, place);
    takeProperties(keys, prim, place);
    prim.children = takeChildren(keys, place);
    prim.other = std::move(keys);
    return prim;
}

std::vector<Prim> LayerReader::takeChildren(Value::Object& keys, const Place& place) {
    std::vector<Prim> prims;
    auto taken = keys.extract("primChildren");
    if (!taken) return prims;
    const Place at = place / "primChildren";
    auto* array = taken.mapped().as<Value::Array>();
    if (const auto* numbers = taken.mapped().as<Numbers>())
        problems.add(at / 0, "expected an object, found ", describe(numbers->element(0)));
    else if (!array)
        problems.add(at, "expected an array of prims, found ", describe(taken.mapped()));
    std::set<std::string> names;
    for (std::size_t i = 0; array && i < array->size(); ++i) {
        auto* child = object((*array)[i], at / i);
        if (!child) continue;
        const std::string name = takeText(*child, "name", "", at / i);
        const Place of = place.child(i, name);
        if (!isPrimName(name))
            problems.add(of / "name", "expected a prim name [A-Za-z_][A-Za-z0-9_]*, found \"", name, "\"");
        else if (!names.insert(name).second)
            problems.add(of / "name", "expected a name that no sibling has, found \"", name, "\"");
        else
            prims.push_back(readPrim(*child, name, of));
    }
    return prims;
}

Layer LayerReader::readLayer(Value root) {
    Layer layer;
    const Place top;
    auto* keys = object(root, top);
    if (!keys) return layer;
    if (auto list = keys->extract("buffers"); list && buffers)
        buffers->readAll(list.mapped(), top / "buffers");
    if (takeText(*keys, "format", "", top) != "osgtss") {
        problems.add(top / "format", "expected \"osgtss\": this is not a scene file of osgTSS");
        return layer;
    }
    layer.formatVersion = takeText(*keys, "formatVersion", "", top);
    checkVersion(layer.formatVersion, top / "formatVersion");
    layer.metadata = takeMetadata(*keys, top);
    layer.children = takeChildren(*keys, top);
    layer.other = std::move(*keys);
    return layer;
}

Layer parseLayer(std::string_view text, const std::string& fileName, Problems& problems) {
    if (text.starts_with("#usda"))
        throw InputError(Where{fileName, "", ""},
                         "is a layer of USD; `tss convert` or `tss make` makes a scene of it, a .tss");
    Value root = looksLikeCbor(text) ? parseCbor(text, fileName) : parseJson(text, fileName);
    BufferReader buffers(fileName, problems);
    return LayerReader{problems, &buffers}.readLayer(std::move(root));
}

Layer parseLayer(std::string_view text, const std::string& fileName) {
    Problems problems(fileName);
    return parseLayer(text, fileName, problems);
}

Layer readLayer(const std::string& file) {
    return parseLayer(readWholeFile(file), file);
}

} // namespace tss
