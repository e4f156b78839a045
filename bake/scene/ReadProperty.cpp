#include "bake/scene/ReadProperty.h"

#include "bake/scene/ValueType.h"

#include <algorithm>
#include <array>

namespace tss {

namespace {

constexpr std::array listOps = {"prepend", "append", "delete", "explicit", "add", "reorder"};

/// Splits [[t, v], ...], in whatever form the parser found for it.
std::vector<Property::Sample> splitSamples(Value& value, const Place& place, Problems& problems) {
    std::vector<Property::Sample> samples;
    if (const Numbers* pairs = value.as<Numbers>(); pairs && pairs->width == 2) {
        for (std::size_t i = 0; i < pairs->values.size(); i += 2)
            samples.push_back({pairs->values[i], Value(pairs->values[i + 1])});
        return samples;
    }
    if (const Numbers* numbers = value.as<Numbers>()) {
        problems.add(place / std::size_t(0),
                     "expected a [time, value] pair, found " + describe(numbers->element(0)));
        return samples;
    }
    auto* array = value.as<Value::Array>();
    if (!array) {
        problems.add(place, "expected an array of [time, value] pairs, found " + describe(value));
        return samples;
    }
    for (std::size_t i = 0; i < array->size(); ++i) {
        if (Numbers* numbers = (*array)[i].as<Numbers>();
            numbers && numbers->width == 0 && numbers->count() == 2) {
            samples.push_back({numbers->values[0], Value(numbers->values[1])});
            continue;
        }
        auto* pair = (*array)[i].as<Value::Array>();
        const double* time = pair && pair->size() == 2 ? (*pair)[0].as<double>() : nullptr;
        if (time)
            samples.push_back({*time, std::move((*pair)[1])});
        else
            problems.add(place / i, "expected a [time, value] pair, found " + describe((*array)[i]));
    }
    return samples;
}

void readSamples(Value& value, Property& property, const Place& place, Problems& problems) {
    property.timeSamples = splitSamples(value, place, problems);
    const auto type = valueType(property.typeName);
    for (std::size_t i = 0; i < property.timeSamples.size(); ++i) {
        Property::Sample& sample = property.timeSamples[i];
        if (i > 0 && !(sample.time > property.timeSamples[i - 1].time))
            problems.add(place / i / std::size_t(0),
                         "expected a time after " +
                             describe(Value(property.timeSamples[i - 1].time)).substr(7) + ", found " +
                             describe(Value(sample.time)));
        if (type) conform(sample.value, *type, property.typeName, place / i / std::size_t(1), problems);
    }
}

void readAttribute(Value::Object& keys, Property& property, const Place& place, Problems& problems) {
    const auto typeName = keys.find("typeName");
    const auto* text = typeName == keys.end() ? nullptr : typeName->second.as<std::string>();
    if (!text || text->empty()) {
        problems.add(typeName == keys.end() ? place : place / std::string("typeName"),
                     "expected \"typeName\" (of an attribute) or \"targetPaths\" (of a relationship)");
    } else {
        property.typeName = *text;
    }
    keys.erase("typeName");
    if (const auto value = keys.find("default"); value != keys.end()) {
        if (const auto type = valueType(property.typeName))
            conform(value->second, *type, property.typeName, place / std::string("default"), problems);
        property.defaultValue = std::move(value->second);
        keys.erase(value);
    }
    if (const auto value = keys.find("timeSamples"); value != keys.end()) {
        readSamples(value->second, property, place / std::string("timeSamples"), problems);
        keys.erase(value);
    }
}

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

} // namespace

bool isPropertyName(std::string_view name) {
    while (true) {
        const auto colon = name.find(':');
        if (!isPrimName(name.substr(0, colon))) return false;
        if (colon == std::string_view::npos) return true;
        name.remove_prefix(colon + 1);
    }
}

void checkList(const Value& value, const Place& place, const std::string& wanted, Problems& problems) {
    if (const auto* ops = value.as<Value::Object>()) {
        for (const auto& [key, items] : *ops) {
            if (std::find(listOps.begin(), listOps.end(), key) == listOps.end())
                problems.add(place / key,
                             "expected prepend, append, delete or explicit, found \"" + key + "\"");
            else if (items.as<Value::Object>())
                problems.add(place / key, "expected an array of " + wanted + ", found " + describe(items));
            else
                checkList(items, place / key, wanted, problems);
        }
        return;
    }
    if (const auto* numbers = value.as<Numbers>())
        return problems.add(place / std::size_t(0),
                            "expected a string, found " + describe(numbers->element(0)));
    const auto* array = value.as<Value::Array>();
    if (!array) return problems.add(place, "expected an array of " + wanted + ", found " + describe(value));
    for (std::size_t i = 0; i < array->size(); ++i)
        if (!(*array)[i].as<std::string>())
            problems.add(place / i, "expected a string, found " + describe((*array)[i]));
}

void checkPaths(const Value& value, const Place& place, Problems& problems) {
    if (const auto* ops = value.as<Value::Object>()) {
        for (const auto& [key, items] : *ops)
            if (items.as<Value::Array>()) checkPaths(items, place / key, problems);
        return;
    }
    const auto* array = value.as<Value::Array>();
    for (std::size_t i = 0; array && i < array->size(); ++i)
        if (const auto* path = (*array)[i].as<std::string>(); path && !isPath(*path))
            problems.add(place / i, "expected an absolute path such as /Scene/Body, found \"" + *path + "\"");
}

Property readProperty(Value object, const Place& place, Problems& problems) {
    Property property;
    auto& keys = *object.as<Value::Object>();
    if (const auto targets = keys.find("targetPaths"); targets != keys.end()) {
        const Place at = place / std::string("targetPaths");
        if (keys.contains("typeName"))
            problems.add(place, "expected \"typeName\" or \"targetPaths\", found both");
        checkList(targets->second, at, "paths", problems);
        checkPaths(targets->second, at, problems);
        property.targetPaths = std::move(targets->second);
        keys.erase(targets);
    } else {
        readAttribute(keys, property, place, problems);
    }
    property.other = std::move(keys);
    return property;
}

} // namespace tss
