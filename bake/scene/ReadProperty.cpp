#include "bake/scene/LayerReader.h"
#include "bake/scene/ValueType.h"

#include <algorithm>
#include <array>

namespace tss {

namespace {

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

} // namespace

bool isPropertyName(std::string_view name) {
    while (true) {
        const auto colon = name.find(':');
        if (!isPrimName(name.substr(0, colon))) return false;
        if (colon == std::string_view::npos) return true;
        name.remove_prefix(colon + 1);
    }
}

void LayerReader::checkList(const Value& value, const Place& place, const char* wanted) {
    if (const auto* ops = value.as<Value::Object>()) {
        for (const auto& [key, items] : *ops) {
            if (std::ranges::find(listOps, key) == listOps.end())
                problems.add(place / key, "expected prepend, append, delete or explicit, found \"", key,
                             "\"");
            else if (items.as<Value::Object>())
                problems.add(place / key, "expected an array of ", wanted, ", found ", describe(items));
            else
                checkList(items, place / key, wanted);
        }
        return;
    }
    if (const auto* numbers = value.as<Numbers>())
        return problems.add(place / 0, "expected a string, found ", describe(numbers->element(0)));
    const auto* array = value.as<Value::Array>();
    if (!array) return problems.add(place, "expected an array of ", wanted, ", found ", describe(value));
    for (std::size_t i = 0; i < array->size(); ++i)
        if (!(*array)[i].as<std::string>())
            problems.add(place / i, "expected a string, found ", describe((*array)[i]));
}

void LayerReader::checkPaths(const Value& value, const Place& place) {
    if (const auto* ops = value.as<Value::Object>()) {
        for (const auto& [key, items] : *ops)
            if (items.as<Value::Array>()) checkPaths(items, place / key);
        return;
    }
    const auto* array = value.as<Value::Array>();
    for (std::size_t i = 0; array && i < array->size(); ++i)
        if (const auto* path = (*array)[i].as<std::string>(); path && !isPath(*path))
            problems.add(place / i, "expected an absolute path such as /Scene/Body, found \"", *path, "\"");
}

void LayerReader::readValue(Value& value, const std::string& typeName, const Place& place) {
    const auto type = valueType(typeName);
    if (!type) return;
    if (buffers) buffers->fill(value, *type, typeName, place);
    conform(value, *type, typeName, place, problems);
}

std::vector<Property::Sample> LayerReader::splitSamples(Value& value, const Place& place) {
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

void LayerReader::readAttribute(Value::Object& keys, Property& property, const Place& place) {
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
    property.timeSamples = splitSamples(samples.mapped(), at);
    for (std::size_t i = 0; i < property.timeSamples.size(); ++i) {
        Property::Sample& sample = property.timeSamples[i];
        if (i > 0 && !(sample.time > property.timeSamples[i - 1].time))
            problems.add(at / i / 0, "expected a time after ", property.timeSamples[i - 1].time, ", found ",
                         describe(Value(sample.time)));
        readValue(sample.value, property.typeName, at / i / 1);
    }
}

Property LayerReader::readProperty(Value::Object keys, const Place& place) {
    Property property;
    if (auto targets = keys.extract("targetPaths")) {
        const Place at = place / "targetPaths";
        if (keys.contains("typeName"))
            problems.add(place, "expected \"typeName\" or \"targetPaths\", found both");
        checkList(targets.mapped(), at, "paths");
        checkPaths(targets.mapped(), at);
        property.targetPaths = std::move(targets.mapped());
    } else {
        readAttribute(keys, property, place);
    }
    property.other = std::move(keys);
    return property;
}

Property readProperty(Value object, const Place& place, Problems& problems) {
    return LayerReader{problems}.readProperty(std::move(*object.as<Value::Object>()), place);
}

} // namespace tss
