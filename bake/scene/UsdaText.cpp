#include "bake/scene/UsdaText.h"

#include "bake/scene/Utf8.h"
#include "bake/scene/WriteLayer.h"

#include <fmt/format.h>

#include <cmath>

namespace tss {

namespace {

using Base = ValueType::Base;

void appendNumberOf(std::string& out, double number, const ValueType& type) {
    type.isFloat() ? appendFloat(out, number) : appendNumber(out, number);
}

void appendSingle(std::string& out, const Value& value, const ValueType& type) {
    if (const auto* text = value.as<std::string>()) {
        if (!type.name.starts_with("asset")) return appendUsdaString(out, *text);
        out += "@" + *text + "@";
    } else if (const auto* flag = value.as<bool>()) {
        out += *flag ? '1' : '0';
    } else if (const auto* number = value.as<double>()) {
        appendNumberOf(out, *number, type);
    } else {
        out += value.isNull() ? "None" : jsonText(value);
    }
}

/// The tuples or numbers of a block, from one index to another.
void appendBlock(std::string& out, const Numbers& numbers, const ValueType& type) {
    for (std::size_t i = 0; i < numbers.values.size(); ++i) {
        const bool opens = numbers.width > 0 && i % numbers.width == 0;
        if (i > 0) out += ", ";
        if (opens) out += '(';
        appendNumberOf(out, numbers.values[i], type);
        if (numbers.width > 0 && (i + 1) % numbers.width == 0) out += ')';
    }
}

/// The type in a dictionary that a value suggests; null when none does.
const char* suggestedType(const Value& value) {
    if (value.as<std::string>()) return "string";
    if (value.as<bool>()) return "bool";
    if (value.as<Value::Object>()) return "dictionary";
    const auto isInt = [](double x) { return x == std::trunc(x) && std::abs(x) < 2147483648.0; };
    if (const auto* number = value.as<double>()) return isInt(*number) ? "int" : "double";
    if (const auto* numbers = value.as<Numbers>(); numbers && numbers->width == 0) return "double[]";
    const auto* array = value.as<Value::Array>();
    if (!array || array->empty()) return nullptr;
    for (const Value& element : *array)
        if (!element.as<std::string>()) return nullptr;
    return "string[]";
}

} // namespace

void appendUsdaString(std::string& out, std::string_view text) {
    appendQuoted(out, text, [](unsigned char control) { return fmt::format("\\x{:02x}", control); });
}

void appendUsda(std::string& out, const Value& value, const ValueType& type) {
    const auto* block = value.as<Numbers>();
    const auto* array = value.as<Value::Array>();
    if (!block && !array) return appendSingle(out, value, type);
    const char* const brackets = type.array ? "[]" : "()";
    out += brackets[0];
    if (block) appendBlock(out, *block, type);
    for (std::size_t i = 0; array && i < array->size(); ++i) {
        if (i > 0) out += ", ";
        appendUsda(out, (*array)[i], type.array ? *type.element : type);
    }
    out += brackets[1];
}

void appendUsdaDictionary(std::string& out, const Value::Object& object, std::size_t indent) {
    out += "{\n";
    for (const auto& [key, value] : object) {
        const char* suggested = suggestedType(value);
        const std::string type = suggested ? suggested : "string";
        out.append(indent + 4, ' ');
        out += type + " ";
        appendUsdaString(out, key);
        out += " = ";
        if (!suggested)
            appendUsdaString(out, jsonText(value));
        else if (const auto* inner = value.as<Value::Object>())
            appendUsdaDictionary(out, *inner, indent + 4);
        else
            appendUsda(out, value, *valueType(type));
        out += '\n';
    }
    out.append(indent, ' ');
    out += '}';
}

} // namespace tss
