#include "bake/scene/PrimWriter.h"

#include "bake/scene/ValueType.h"

namespace tss {

namespace {

Value numbersValue(std::vector<double> numbers, int width) {
    if (numbers.empty()) return Value(Value::Array());
    return Value(Numbers{std::move(numbers), width});
}

void conformTo(const Attribute& attribute, Value& value, const std::string& prim) {
    Problems problems("");
    conform(value, *valueType(attribute.typeName), attribute.typeName, {"", prim + "." + attribute.name},
            problems);
}

} // namespace

void PrimWriter::set(const Attribute& attribute, Value value) {
    conformTo(attribute, value, prim_.name);
    Property& property = prim_.properties[attribute.name];
    property.typeName = attribute.typeName;
    property.targetPaths.reset();
    property.defaultValue = std::move(value);
    property.timeSamples.clear();
    if (attribute.uniform) property.other["variability"] = "uniform";
}

void PrimWriter::setUnless(const Attribute& attribute, Value value, const Value& fallback) {
    conformTo(attribute, value, prim_.name);
    if (value == fallback)
        remove(attribute.name);
    else
        set(attribute, std::move(value));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<double>& numbers) {
    set(attribute, numbersValue(numbers, 0));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<std::uint32_t>& numbers) {
    set(attribute, numbersValue({numbers.begin(), numbers.end()}, 0));
}

void PrimWriter::set(const Attribute& attribute, const std::vector<std::string>& texts) {
    Value::Array array;
    for (const std::string& text : texts) array.emplace_back(text);
    set(attribute, Value(std::move(array)));
}

void PrimWriter::set(const Attribute& attribute, const Vec3& vector) {
    set(attribute, numbersValue({vector.x(), vector.y(), vector.z()}, 0));
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
    prim_.properties[attribute.name] = std::move(property);
}

void PrimWriter::setTargets(const std::string& relationship, const std::vector<std::string>& paths) {
    Value::Array array;
    for (const std::string& path : paths) array.emplace_back(path);
    Property& property = prim_.properties[relationship];
    property.typeName.clear();
    property.targetPaths = Value(std::move(array));
}

void PrimWriter::setMetadata(const Attribute& attribute, const std::string& key, Value value) {
    prim_.properties.at(attribute.name).other[key] = std::move(value);
}

} // namespace tss
