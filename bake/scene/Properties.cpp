#include "bake/scene/Properties.h"

#include "bake/scene/ValueType.h"

#include <cmath>

namespace tss {

namespace {

std::string rangeText(const Range& range) {
    const bool low = std::isfinite(range.lowest), high = std::isfinite(range.highest);
    if (low && high) return joined("a number from ", range.lowest, " to ", range.highest);
    if (low) return joined("a finite number of at least ", range.lowest);
    return high ? joined("a finite number of at most ", range.highest) : "a finite number";
}

bool inside(double value, const Range& range) {
    return std::isfinite(value) && value >= range.lowest && value <= range.highest;
}

Value numbersValue(std::vector<double> numbers, int width) {
    if (numbers.empty()) return Value(Value::Array());
    return Value(Numbers{std::move(numbers), width});
}

Value textsValue(const std::vector<std::string>& texts) {
    return Value(Value::Array(texts.begin(), texts.end()));
}

void conformTo(const Attribute& attribute, Value& value, const std::string& prim) {
    Problems problems("");
    conform(value, *valueType(attribute.typeName), {"", joined(prim, ".", attribute.name)}, problems);
}

} // namespace

Place PrimReader::placeOf(const Attribute& attribute, std::string_view field) const {
    const Place place = place_.property(attribute.name);
    return field.empty() ? place : place / field;
}

Place PrimReader::valuePlace(const Attribute& attribute) const {
    const Property* property = prim_.property(attribute.name);
    if (property && !property->defaultValue && !property->timeSamples.empty())
        return placeOf(attribute, "timeSamples") / 0 / 1;
    return placeOf(attribute, property && property->defaultValue ? "default" : "");
}

const Property* PrimReader::find(const Attribute& attribute) const {
    const Property* property = prim_.property(attribute.name);
    if (!property) return nullptr;
    if (property->isRelationship())
        problems_.add(placeOf(attribute), "expected an attribute of type ", attribute.typeName,
                      ", found a relationship");
    else if (property->typeName != attribute.typeName)
        problems_.add(placeOf(attribute, "typeName"), "expected type ", attribute.typeName, ", found \"",
                      property->typeName, "\"");
    else
        return property;
    return nullptr;
}

const Value* PrimReader::value(const Attribute& attribute) const {
    const Property* property = find(attribute);
    if (!property) return nullptr;
    const Value* value = property->defaultValue          ? &*property->defaultValue
                         : property->timeSamples.empty() ? nullptr
                                                         : &property->timeSamples.front().value;
    return value && !value->isNull() ? value : nullptr;
}

template <class T>
const T* PrimReader::single(const Attribute& attribute) const {
    const Value* found = value(attribute);
    return found ? found->as<T>() : nullptr;
}

double PrimReader::real(const Attribute& attribute, double fallback) const {
    const double* found = single<double>(attribute);
    if (!found) return fallback;
    if (inside(*found, attribute.range)) return *found;
    problem(attribute, "expected ", rangeText(attribute.range), ", found ", *found);
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

std::string PrimReader::choice(const Attribute& attribute) const {
    const std::string* found = single<std::string>(attribute);
    std::string first, list;
    for (std::string_view left = attribute.choices; !left.empty();) {
        const std::string_view token = left.substr(0, left.find(' '));
        left.remove_prefix(std::min(left.size(), token.size() + 1));
        if (found && *found == token) return *found;
        if (first.empty()) first = token;
        list.append(list.empty() ? "" : ", ").append(token);
    }
    if (found) problem(attribute, "expected one of ", list, ", found \"", *found, "\"");
    return first;
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
    if (!(std::abs(quaternion.norm() - 1) > slack)) return quaternion.normalized();
    problem(attribute, "expected a quaternion [w, x, y, z] of length 1, found one of length ",
            quaternion.norm());
    return Eigen::Quaterniond::Identity();
}

std::vector<double> PrimReader::reals(const Attribute& attribute) const {
    const auto* found = single<Numbers>(attribute);
    if (!found) return {};
    for (std::size_t i = 0; i < found->values.size(); ++i) {
        if (inside(found->values[i], attribute.range)) continue;
        Place place = valuePlace(attribute);
        place = found->width == 0 ? place / i : place / (i / found->width) / (i % found->width);
        problems_.add(place, "expected ", rangeText(attribute.range), ", found ", found->values[i]);
        return {};
    }
    return found->values;
}

std::vector<double> PrimReader::reals(const Attribute& attribute, std::size_t count) const {
    auto numbers = reals(attribute);
    if (!value(attribute) || numbers.size() == count) return numbers;
    problem(attribute, "expected ", count, " numbers, found ", numbers.size());
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
    Attribute whole = attribute;
    whole.range = between(0, 2147483647.0);
    const auto numbers = reals(whole);
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
            problems_.add(placeOf(attribute, "timeSamples") / i / 1, "expected a finite number, found ",
                          describe(sample.value));
        }
    }
    if (property->timeSamples.empty() && value(attribute)) {
        samples.times = {0};
        samples.values = {real(attribute, 0)};
    }
    return samples;
}

std::vector<std::string> PrimReader::targets(const Attribute& relationship) const {
    const Property* property = prim_.property(relationship.name);
    if (!property) return {};
    if (property->isRelationship()) return listItems(*property->targetPaths);
    problems_.add(placeOf(relationship), "expected a relationship (targetPaths), found an attribute");
    return {};
}

std::string PrimReader::target(const Attribute& relationship) const {
    const auto paths = targets(relationship);
    if (paths.size() > 1) targetProblem(relationship, "expected one path, found ", paths.size());
    return paths.empty() ? std::string() : paths.front();
}

void PrimWriter::set(const Attribute& attribute, Value value) {
    conformTo(attribute, value, prim_.name);
    Property& property = prim_.properties[std::string(attribute.name)];
    property.typeName = attribute.typeName;
    property.targetPaths.reset();
    property.defaultValue = std::move(value);
    property.timeSamples.clear();
    if (attribute.uniform) property.other["variability"] = "uniform";
}

void PrimWriter::setUnless(const Attribute& attribute, Value value, const Value& fallback) {
    conformTo(attribute, value, prim_.name);
    value == fallback ? remove(attribute) : set(attribute, std::move(value));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<double>& numbers) {
    set(attribute, numbersValue(numbers, 0));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<std::uint32_t>& numbers) {
    set(attribute, numbersValue({numbers.begin(), numbers.end()}, 0));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<std::string>& texts) {
    set(attribute, textsValue(texts));
}

void PrimWriter::set(const Attribute& attribute, const Vec3& vector) {
    set(attribute, numbersValue({vector.begin(), vector.end()}, 0));
}

void PrimWriter::set(const Attribute& attribute, const Eigen::Quaterniond& rotation) {
    set(attribute, numbersValue({rotation.w(), rotation.x(), rotation.y(), rotation.z()}, 0));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<Vec3>& vectors) {
    std::vector<double> numbers;
    numbers.reserve(3 * vectors.size());
    for (const Vec3& vector : vectors) numbers.insert(numbers.end(), vector.begin(), vector.end());
    set(attribute, numbersValue(std::move(numbers), 3));
}

void PrimWriter::set(const Attribute& attribute, const TimeSamples& samples) {
    if (samples.empty()) return;
    Property property;
    property.typeName = attribute.typeName;
    for (std::size_t i = 0; i < samples.times.size(); ++i) {
        Value value(samples.values[i]);
        conformTo(attribute, value, prim_.name);
        property.timeSamples.push_back({samples.times[i], std::move(value)});
    }
    prim_.properties[std::string(attribute.name)] = std::move(property);
}

void PrimWriter::setTargets(const Attribute& relationship, const std::vector<std::string>& paths) {
    Property& property = prim_.properties[std::string(relationship.name)];
    property.typeName.clear();
    property.targetPaths = textsValue(paths);
}

void PrimWriter::setMetadata(const Attribute& attribute, const std::string& key, Value value) {
    prim_.properties.at(std::string(attribute.name)).other[key] = std::move(value);
}

} // namespace tss
