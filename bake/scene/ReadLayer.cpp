#include "bake/scene/ReadLayer.h"

#include "bake/base/AtomicFile.h"
#include "bake/scene/Buffers.h"
#include "bake/scene/ReadTree.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

namespace tss {

namespace {

constexpr int knownMajor = 1, knownMinor = 0;

constexpr std::array listOps = {"prepend", "append", "delete", "explicit", "add", "reorder"};

/// /Name/Name, perhaps with .property behind it.
bool isPath(std::string_view path) {
    const auto dot = path.find('.');
    if (dot != std::string_view::npos && !isPropertyName(path.substr(dot + 1))) return false;
    path = path.substr(0, dot);
    if (!path.starts_with('/')) return false;
    while (!path.empty()) {
        const auto end = std::min(path.find('/', 1), path.size());
        if (!isPrimName(path.substr(1, end - 1))) return false;
        path.remove_prefix(end);
    }
    return true;
}

void checkVersion(const std::string& version, const Place& place, Problems& problems) {
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

/// Checks an array of strings or a list op of such: {"prepend": [...], "append": ..., "delete": ...,
/// "explicit": ...}. Paths are absolute ones, of prims or properties.
void checkList(const Value& value, const Place& place, bool ofPaths, Problems& problems) {
    const char* const wanted = ofPaths ? "paths" : "names of API schemas";
    if (const auto* ops = value.as<Value::Object>()) {
        for (const auto& [key, items] : *ops) {
            if (std::ranges::find(listOps, key) == listOps.end())
                problems.add(place / key, "expected prepend, append, delete or explicit, found \"", key,
                             "\"");
            else if (items.as<Value::Object>())
                problems.add(place / key, "expected an array of ", wanted, ", found ", describe(items));
            else
                checkList(items, place / key, ofPaths, problems);
        }
        return;
    }
    if (const auto* numbers = value.as<Numbers>())
        return problems.add(place / 0, "expected a string, found ", describe(numbers->element(0)));
    const auto* array = value.as<Value::Array>();
    if (!array) return problems.add(place, "expected an array of ", wanted, ", found ", describe(value));
    for (std::size_t i = 0; i < array->size(); ++i) {
        const auto* text = (*array)[i].as<std::string>();
        if (!text)
            problems.add(place / i, "expected a string, found ", describe((*array)[i]));
        else if (ofPaths && !isPath(*text))
            problems.add(place / i, "expected an absolute path such as /Scene/Body, found \"", *text, "\"");
    }
}

/// Splits [[t, v], ...], in whatever form the parser found for it.
std::vector<Property::Sample> splitSamples(Value& value, const Place& place, Problems& problems) {
    std::vector<Property::Sample> samples;
    if (const Numbers* pairs = value.as<Numbers>(); pairs && pairs->width == 2) {
        for (std::size_t i = 0; i < pairs->values.size(); i += 2)
            samples.push_back({pairs->values[i], Value(pairs->values[i + 1])});
        return samples;
    }
    const auto wrong = [&](std::size_t i, const Value& found) {
        problems.add(place / i, "expected a [time, value] pair, found ", describe(found));
    };
    auto* array = value.as<Value::Array>();
    if (const Numbers* numbers = value.as<Numbers>())
        wrong(0, numbers->element(0));
    else if (!array)
        problems.add(place, "expected an array of [time, value] pairs, found ", describe(value));
    for (std::size_t i = 0; array && i < array->size(); ++i) {
        Value& item = (*array)[i];
        const Numbers* numbers = item.as<Numbers>();
        auto* pair = item.as<Value::Array>();
        const double* time = pair && pair->size() == 2 ? (*pair)[0].as<double>() : nullptr;
        if (numbers && numbers->width == 0 && numbers->count() == 2)
            samples.push_back({numbers->values[0], Value(numbers->values[1])});
        else if (time)
            samples.push_back({*time, std::move((*pair)[1])});
        else
            wrong(i, item);
    }
    return samples;
}

/// The tree as parsed, as a layer. Values are moved out of it.
struct LayerReader {
    Problems& problems;
    BufferReader* buffers = nullptr; ///< for values that stand in them

    Value::Object* object(Value& value, const Place& place) {
        auto* object = value.as<Value::Object>();
        if (!object) problems.add(place, "expected an object, found ", describe(value));
        return object;
    }

    /// The text under a key, `fallback` when it is absent, taken out of the keys.
    std::string takeText(Value::Object& keys, const char* key, const char* fallback, const Place& place) {
        auto taken = keys.extract(key);
        if (!taken) return fallback;
        if (auto* text = taken.mapped().as<std::string>()) return std::move(*text);
        problems.add(place / key, "expected a string, found ", describe(taken.mapped()));
        return fallback;
    }

    Value::Object takeMetadata(Value::Object& keys, const Place& place) {
        Value::Object metadata;
        auto taken = keys.extract("metadata");
        if (!taken) return metadata;
        const Place at = place / "metadata";
        if (auto* found = object(taken.mapped(), at)) metadata = std::move(*found);
        if (const auto schemas = metadata.find("apiSchemas"); schemas != metadata.end())
            checkList(schemas->second, at / "apiSchemas", false, problems);
        for (const char* key :
             {"subLayers", "payload", "variantSets", "variantSelection", "inheritPaths", "specializes"})
            if (metadata.contains(key))
                problems.warn(
                    at / key, key,
                    " is kept, but what it would bring into the scene does not count: references alone "
                    "are composed");
        if (const auto references = metadata.find("references"); references != metadata.end())
            checkList(references->second, at / "references", true, problems);
        return metadata;
    }

    /// A value of an attribute, in the form that its type has.
    void readValue(Value& value, const std::string& typeName, const Place& place) {
        const ValueType* const type = valueType(typeName);
        if (!type) return;
        if (buffers) buffers->fill(value, *type, place);
        conform(value, *type, place, problems);
    }

    void readAttribute(Value::Object& keys, Property& property, const Place& place) {
        const auto* text = member<std::string>(keys, "typeName");
        if (!text || text->empty())
            problems.add(keys.contains("typeName") ? place / "typeName" : place,
                         "expected \"typeName\" (of an attribute) or \"targetPaths\" (of a relationship)");
        else
            property.typeName = *text;
        keys.erase("typeName");
        if (auto value = keys.extract("default")) {
            readValue(value.mapped(), property.typeName, place / "default");
            property.defaultValue = std::move(value.mapped());
        }
        auto samples = keys.extract("timeSamples");
        if (!samples) return;
        const Place at = place / "timeSamples";
        property.timeSamples = splitSamples(samples.mapped(), at, problems);
        for (std::size_t i = 0; i < property.timeSamples.size(); ++i) {
            Property::Sample& sample = property.timeSamples[i];
            if (i > 0 && !(sample.time > property.timeSamples[i - 1].time))
                problems.add(at / i / 0, "expected a time after ", property.timeSamples[i - 1].time,
                             ", found ", describe(Value(sample.time)));
            readValue(sample.value, property.typeName, at / i / 1);
        }
    }

    Property readProperty(Value::Object keys, const Place& place) {
        Property property;
        if (auto targets = keys.extract("targetPaths")) {
            if (keys.contains("typeName"))
                problems.add(place, "expected \"typeName\" or \"targetPaths\", found both");
            checkList(targets.mapped(), place / "targetPaths", true, problems);
            property.targetPaths = std::move(targets.mapped());
        } else {
            readAttribute(keys, property, place);
        }
        property.other = std::move(keys);
        return property;
    }

    void takeProperties(Value::Object& keys, Prim& prim, const Place& place) {
        auto taken = keys.extract("properties");
        auto* properties = taken ? object(taken.mapped(), place / "properties") : nullptr;
        if (!properties) return;
        for (auto& [name, value] : *properties) {
            const Place of = place.property(name);
            if (!isPropertyName(name))
                problems.add(of,
                             "expected a property name of words [A-Za-z_][A-Za-z0-9_]* with colons between");
            else if (auto* found = object(value, of))
                prim.properties.emplace(name, readProperty(std::move(*found), of));
        }
    }

    Prim readPrim(Value::Object& keys, const std::string& name, const Place& place) {
        Prim prim;
        prim.name = name;
        prim.specifier = takeText(keys, "specifier", "def", place);
        if (prim.specifier != "def" && prim.specifier != "over" && prim.specifier != "class")
            problems.add(place / "specifier", "expected \"def\", \"over\" or \"class\", found \"",
                         prim.specifier, "\"");
        prim.typeName = takeText(keys, "typeName", "", place);
        if (!prim.typeName.empty() && !isPrimName(prim.typeName))
            problems.add(place / "typeName", "expected a schema name, found \"", prim.typeName, "\"");
        prim.metadata = takeMetadata(keys, place);
        takeProperties(keys, prim, place);
        prim.children = takeChildren(keys, place);
        prim.other = std::move(keys);
        return prim;
    }

    std::vector<Prim> takeChildren(Value::Object& keys, const Place& place) {
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
                problems.add(of / "name", "expected a prim name [A-Za-z_][A-Za-z0-9_]*, found \"", name,
                             "\"");
            else if (!names.insert(name).second)
                problems.add(of / "name", "expected a name that no sibling has, found \"", name, "\"");
            else
                prims.push_back(readPrim(*child, name, of));
        }
        return prims;
    }

    Layer readLayer(Value root) {
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
        checkVersion(layer.formatVersion, top / "formatVersion", problems);
        layer.metadata = takeMetadata(*keys, top);
        layer.children = takeChildren(*keys, top);
        layer.other = std::move(*keys);
        return layer;
    }
};

} // namespace

bool isPropertyName(std::string_view name) {
    while (true) {
        const auto colon = name.find(':');
        if (!isPrimName(name.substr(0, colon))) return false;
        if (colon == std::string_view::npos) return true;
        name.remove_prefix(colon + 1);
    }
}

Layer parseLayer(std::string_view text, const std::string& fileName, Problems& problems) {
    if (text.starts_with("#usda"))
        throw InputError(Where{fileName},
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

Property readProperty(Value object, const Place& place, Problems& problems) {
    return LayerReader{problems}.readProperty(std::move(*object.as<Value::Object>()), place);
}

} // namespace tss
