#include "bake/scene/PrimReader.h"

#include <cmath>

namespace tss {

namespace {

std::string number(double value) {
    return describe(Value(value)).substr(7);
}

std::string rangeText(const Range& range) {
    const bool low = std::isfinite(range.lowest), high = std::isfinite(range.highest);
    if (low && high) return "a number from " + number(range.lowest) + " to " + number(range.highest);
    if (low) return "a finite number of at least " + number(range.lowest);
    return high ? "a finite number of at most " + number(range.highest) : "a finite number";
}

bool inside(double value, const Range& range) {
    return std::isfinite(value) && value >= range.lowest && value <= range.highest;
}

} // namespace

Place PrimReader::placeOf(const std::string& property, const char* field) const {
    Place place = place_ / std::string("properties") / property;
    place.path += "." + property;
    return *field ? place / std::string(field) : place;
}

Place PrimReader::valuePlace(const Attribute& attribute) const {
    const Property* property = prim_.property(attribute.name);
    if (property && !property->defaultValue && !property->timeSamples.empty())
        return placeOf(attribute.name, "timeSamples") / std::size_t(0) / std::size_t(1);
    return placeOf(attribute.name, property && property->defaultValue ? "default" : "");
}

void PrimReader::problem(const Attribute& attribute, const std::string& message) const {
    if (prim_.property(attribute.name))
        problems_.add(valuePlace(attribute), message);
    else
        problems_.add(place_, std::string(attribute.name) + ": " + message);
}

const Property* PrimReader::find(const Attribute& attribute) const {
    const Property* property = prim_.property(attribute.name);
    if (!property) return nullptr;
    if (property->isRelationship()) {
        problems_.add(placeOf(attribute.name), std::string("expected an attribute of type ") +
                                                   attribute.typeName + ", found a relationship");
        return nullptr;
    }
    if (property->typeName != attribute.typeName) {
        problems_.add(placeOf(attribute.name, "typeName"), std::string("expected type ") +
                                                               attribute.typeName + ", found \"" +
                                                               property->typeName + "\"");
        return nullptr;
    }
    return property;
}

const Value* PrimReader::value(const Attribute& attribute) const {
    const Property* property = find(attribute);
    if (!property) return nullptr;
    const Value* value = nullptr;
    if (property->defaultValue)
        value = &*property->defaultValue;
    else if (!property->timeSamples.empty())
        value = &property->timeSamples.front().value;
    return value && !value->isNull() ? value : nullptr;
}

template <class T>
const T* PrimReader::single(const Attribute& attribute) const {
    const Value* found = value(attribute);
    return found ? found->as<T>() : nullptr;
}

double PrimReader::real(const Attribute& attribute, double fallback, Range range) const {
    const double* found = single<double>(attribute);
    if (!found) return fallback;
    if (inside(*found, range)) return *found;
    problem(attribute, "expected " + rangeText(range) + ", found " + number(*found));
    return fallback;
}

double PrimReader::limit(const Attribute& attribute, double fallback) const {
    const double* found = single<double>(attribute);
    if (!found) return fallback;
    if (!std::isnan(*found)) return *found;
    problem(attribute, "expected a number, found nan");
    return fallback;
}

std::uint64_t PrimReader::count(const Attribute& attribute, std::uint64_t fallback) const {
    const Value* found = value(attribute);
    if (!found) return fallback;
    if (const auto* small = found->as<double>()) return static_cast<std::uint64_t>(*small);
    if (const auto* big = found->as<std::int64_t>()) return static_cast<std::uint64_t>(*big);
    const auto* huge = found->as<std::uint64_t>();
    return huge ? *huge : fallback;
}

bool PrimReader::flag(const Attribute& attribute, bool fallback) const {
    const bool* found = single<bool>(attribute);
    return found ? *found : fallback;
}

std::string PrimReader::text(const Attribute& attribute, const std::string& fallback) const {
    const std::string* found = single<std::string>(attribute);
    return found ? *found : fallback;
}

std::string PrimReader::choice(const Attribute& attribute, std::initializer_list<const char*> allowed) const {
    const std::string* found = single<std::string>(attribute);
    if (!found) return *allowed.begin();
    std::string list;
    for (const char* token : allowed) {
        if (*found == token) return *found;
        list += std::string(list.empty() ? "" : ", ") + token;
    }
    problem(attribute, "expected one of " + list + ", found \"" + *found + "\"");
    return *allowed.begin();
}

std::vector<std::string> PrimReader::texts(const Attribute& attribute) const {
    const Value* found = value(attribute);
    return found ? listItems(*found) : std::vector<std::string>();
}

Vec3 PrimReader::vector(const Attribute& attribute, const Vec3& fallback) const {
    const auto numbers = reals(attribute);
    return numbers.size() == 3 ? Vec3(numbers[0], numbers[1], numbers[2]) : fallback;
}

Eigen::Quaterniond PrimReader::rotation(const Attribute& attribute) const {
    const auto wxyz = reals(attribute);
    if (wxyz.size() != 4) return Eigen::Quaterniond::Identity();
    const Eigen::Quaterniond quaternion(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    constexpr double slack = 1e-3; // what hand-written digits and half precision leave
    if (std::abs(quaternion.norm() - 1) > slack) {
        problem(attribute, "expected a quaternion [w, x, y, z] of length 1, found one of length " +
                               number(quaternion.norm()));
        return Eigen::Quaterniond::Identity();
    }
    return quaternion.normalized();
}

std::vector<double> PrimReader::reals(const Attribute& attribute, Range range) const {
    const auto* found = single<Numbers>(attribute);
    if (!found) return {};
    for (std::size_t i = 0; i < found->values.size(); ++i) {
        if (inside(found->values[i], range)) continue;
        Place place = valuePlace(attribute);
        place = found->width == 0 ? place / i : place / (i / found->width) / (i % found->width);
        problems_.add(place, "expected " + rangeText(range) + ", found " + number(found->values[i]));
        return {};
    }
    return found->values;
}

std::vector<double> PrimReader::reals(const Attribute& attribute, std::size_t count, Range range) const {
    auto numbers = reals(attribute, range);
    if (!value(attribute) || numbers.size() == count) return numbers;
    problem(attribute,
            "expected " + std::to_string(count) + " numbers, found " + std::to_string(numbers.size()));
    return {};
}

std::vector<Vec3> PrimReader::vectors(const Attribute& attribute) const {
    const auto numbers = reals(attribute);
    std::vector<Vec3> vectors;
    vectors.reserve(numbers.size() / 3);
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return vectors;
}

std::vector<std::uint32_t> PrimReader::indices(const Attribute& attribute) const {
    const auto numbers = reals(attribute, Range{0, 2147483647.0});
    return {numbers.begin(), numbers.end()};
}

TimeSamples PrimReader::samples(const Attribute& attribute) const {
    TimeSamples samples;
    const Property* property = find(attribute);
    if (!property) return samples;
    for (std::size_t i = 0; i < property->timeSamples.size(); ++i) {
        const auto& sample = property->timeSamples[i];
        const double* at = sample.value.as<double>();
        if (at && std::isfinite(*at)) {
            samples.times.push_back(sample.time);
            samples.values.push_back(*at);
        } else {
            problems_.add(placeOf(attribute.name, "timeSamples") / i / std::size_t(1),
                          "expected a finite number, found " + describe(sample.value));
        }
    }
    if (property->timeSamples.empty() && value(attribute)) {
        samples.times = {0};
        samples.values = {real(attribute, 0)};
    }
    return samples;
}

std::vector<std::string> PrimReader::targets(const std::string& relationship) const {
    const Property* property = prim_.property(relationship);
    if (!property) return {};
    if (property->isRelationship()) return listItems(*property->targetPaths);
    problems_.add(placeOf(relationship), "expected a relationship (targetPaths), found an attribute");
    return {};
}

std::string PrimReader::target(const std::string& relationship) const {
    const auto paths = targets(relationship);
    if (paths.size() > 1)
        problems_.add(placeOf(relationship, "targetPaths"),
                      "expected one path, found " + std::to_string(paths.size()));
    return paths.empty() ? std::string() : paths.front();
}

} // namespace tss
