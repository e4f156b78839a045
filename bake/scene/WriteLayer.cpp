#include "bake/scene/WriteLayer.h"

#include "bake/base/AtomicFile.h"
#include "bake/scene/Buffers.h"
#include "bake/scene/Utf8.h"
#include "bake/scene/ValueType.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace tss {

namespace {

/// What a layer is written as, JSON and CBOR alike: objects and arrays, keys in the order of the file. A
/// value whose numbers are floats, or not:
struct TypedValue {
    const Value& value;
    bool asFloat = false;
};
/// [[time, value], ...]
struct TypedSamples {
    const std::vector<Property::Sample>& samples;
    bool asFloat = false;
};
struct TypedSample {
    const Property::Sample& sample;
    bool asFloat = false;
};

/// Each calls visit(key, node) for the members of an object.
template <class Visit>
void forMembers(const Value::Object& object, const Visit& visit) {
    for (const auto& [key, value] : object) visit(key, TypedValue{value});
}

template <class Visit>
void forMembers(const std::map<std::string, Property>& properties, const Visit& visit) {
    for (const auto& [name, property] : properties) visit(name, property);
}

template <class Visit>
void forMembers(const Property& property, const Visit& visit) {
    const ValueType* const type = valueType(property.typeName);
    const bool asFloat = type && type->isFloat();
    if (property.targetPaths) {
        visit("targetPaths", TypedValue{*property.targetPaths});
    } else {
        visit("typeName", property.typeName);
        if (property.defaultValue) visit("default", TypedValue{*property.defaultValue, asFloat});
        if (!property.timeSamples.empty()) visit("timeSamples", TypedSamples{property.timeSamples, asFloat});
    }
    forMembers(property.other, visit);
}

template <class Visit>
void forMembers(const Prim& prim, const Visit& visit) {
    visit("specifier", prim.specifier);
    if (!prim.typeName.empty()) visit("typeName", prim.typeName);
    visit("name", prim.name);
    if (!prim.metadata.empty()) visit("metadata", prim.metadata);
    if (!prim.properties.empty()) visit("properties", prim.properties);
    forMembers(prim.other, visit);
    if (!prim.children.empty()) visit("primChildren", prim.children);
}

template <class Visit>
void forMembers(const Layer& layer, const Visit& visit) {
    visit("format", std::string("osgtss"));
    visit("formatVersion", layer.formatVersion);
    if (!layer.metadata.empty()) visit("metadata", layer.metadata);
    forMembers(layer.other, visit);
    if (!layer.children.empty()) visit("primChildren", layer.children);
}

template <class Node>
concept isObject = requires(const Node& node) {
    forMembers(node, [](const auto&...) {});
};

/// The same for the elements of an array: visit(node).
template <class Visit>
void forElements(const std::vector<Prim>& prims, const Visit& visit) {
    for (const Prim& prim : prims) visit(prim);
}

template <class Visit>
void forElements(const TypedSamples& typed, const Visit& visit) {
    for (const Property::Sample& sample : typed.samples) visit(TypedSample{sample, typed.asFloat});
}

template <class Visit>
void forElements(const TypedSample& typed, const Visit& visit) {
    const Value time(typed.sample.time);
    visit(TypedValue{time});
    visit(TypedValue{typed.sample.value, typed.asFloat});
}

/// Calls visit for each element of a value that is an array.
template <class Visit>
void forElements(const TypedValue& typed, const Visit& visit) {
    for (const Value& element : *typed.value.as<Value::Array>()) visit(TypedValue{element, typed.asFloat});
}

constexpr std::size_t lineWidth = 110;

void appendJsonString(std::string& out, std::string_view text) {
    appendQuoted(out, text, [](unsigned char control) {
        return control == '\t' ? std::string("\\t") : fmt::format("\\u{:04x}", control);
    });
}

/// Writes nodes on one line while they fit, else one member or a line full of elements a line.
class JsonWriter {
public:
    std::string out;

    template <class Node>
    void write(const Node& node, std::size_t indent) {
        const std::size_t before = out.size(), end = lineStart_ + lineWidth;
        if (before < end) {
            budget_ = end;
            writeInLine(node);
            budget_ = noEnd;
            if (out.size() <= end) return;
            out.resize(before);
        }
        emit(node, indent);
    }
    /// Writes on one line; only a part of it when that goes beyond the budget.
    template <class Node>
    void writeInLine(const Node& node) {
        emit(node, onOneLine);
    }

private:
    static constexpr std::size_t noEnd = std::string::npos, onOneLine = std::string::npos;

    void newLine(std::size_t indent) {
        out += '\n';
        lineStart_ = out.size();
        out.append(indent, ' ');
    }

    void appendReal(double number, bool asFloat) {
        const bool word = !std::isfinite(number);
        if (word) out += '"';
        asFloat ? appendFloat(out, number) : appendNumber(out, number);
        if (word) out += '"';
    }

    /// What stands between two brackets, from each(item): item(node) or item(node, key) for every part.
    template <class Each>
    void emitParts(const char (&brackets)[3], std::size_t indent, const Each& each) {
        out += brackets[0];
        bool first = true;
        each([&](const auto& node, const std::string_view* key) {
            if (out.size() > budget_) return;
            if (!first) out += indent == onOneLine ? ", " : ",";
            first = false;
            if (indent != onOneLine) newLine(indent + 1);
            if (key) {
                appendJsonString(out, *key);
                out += ": ";
            }
            indent == onOneLine ? writeInLine(node) : write(node, indent + 1);
        });
        if (indent != onOneLine) newLine(indent);
        out += brackets[1];
    }

    template <class Node>
    void emit(const Node& node, std::size_t indent) {
        if constexpr (isObject<Node>)
            emitParts("{}", indent, [&](const auto& part) {
                forMembers(node, [&](std::string_view key, const auto& member) { part(member, &key); });
            });
        else
            emitParts("[]", indent, [&](const auto& part) {
                forElements(node, [&](const auto& element) { part(element, nullptr); });
            });
    }

    void emit(const std::string& text, std::size_t) { appendJsonString(out, text); }

    void emit(const TypedValue& typed, std::size_t indent) {
        const Value& value = typed.value;
        if (const auto* object = value.as<Value::Object>()) return emit(*object, indent);
        if (value.as<Value::Array>()) return emit<TypedValue>(typed, indent);
        if (const auto* numbers = value.as<Numbers>()) return emitNumbers(*numbers, typed.asFloat, indent);
        if (const auto* text = value.as<std::string>()) return emit(*text, indent);
        if (const auto* number = value.as<double>())
            appendReal(*number, typed.asFloat);
        else if (const auto* flag = value.as<bool>())
            out += *flag ? "true" : "false";
        else if (const auto* big = value.as<std::int64_t>())
            out += std::to_string(*big);
        else if (const auto* huge = value.as<std::uint64_t>())
            out += std::to_string(*huge);
        else
            out += "null";
    }

    /// Many elements fill their lines.
    void emitNumbers(const Numbers& numbers, bool asFloat, std::size_t indent) {
        out += '[';
        if (indent != onOneLine) newLine(indent + 1);
        const std::size_t width = static_cast<std::size_t>(std::max(numbers.width, 1));
        for (std::size_t i = 0; i < numbers.values.size() && out.size() <= budget_; i += width) {
            if (i > 0) out += ',';
            if (i > 0 && indent != onOneLine && out.size() - lineStart_ > lineWidth - 10) newLine(indent + 1);
            if (numbers.width > 0) out += '[';
            for (std::size_t k = 0; k < width; ++k) {
                if (k > 0) out += ',';
                appendReal(numbers.values[i + k], asFloat);
            }
            if (numbers.width > 0) out += ']';
        }
        if (indent != onOneLine) newLine(indent);
        out += ']';
    }

    std::size_t lineStart_ = 0;
    std::size_t budget_ = noEnd; ///< where the text must end that is being tried on one line
};

/// The items of a layer one by one, each by nlohmann's writer.
class CborWriter {
public:
    std::string out = "\xD9\xD9\xF7"; // "this is CBOR"

    template <class Node>
    void write(const Node& node) {
        std::size_t count = 0;
        if constexpr (isObject<Node>) {
            forMembers(node, [&](const auto&...) { ++count; });
            head(map, count);
            forMembers(node, [&](std::string_view key, const auto& member) {
                write(std::string(key));
                write(member);
            });
        } else {
            forElements(node, [&](const auto&) { ++count; });
            head(array, count);
            forElements(node, [&](const auto& element) { write(element); });
        }
    }

    void write(const std::string& text) { item(repairedUtf8(text)); }

    void write(const TypedValue& typed) {
        const Value& value = typed.value;
        if (const auto* object = value.as<Value::Object>()) return write(*object);
        if (value.as<Value::Array>()) return write<TypedValue>(typed);
        if (const auto* block = value.as<Numbers>()) return write(*block);
        if (const auto* word = value.as<std::string>()) return write(*word);
        if (const auto* single = value.as<double>()) return number(*single);
        if (const auto* big = value.as<std::int64_t>()) return item(*big);
        if (const auto* huge = value.as<std::uint64_t>()) return item(*huge);
        const auto* flag = value.as<bool>();
        item(flag ? nlohmann::json(*flag) : nlohmann::json());
    }

private:
    static constexpr int array = 4, map = 5; // major types

    void item(const nlohmann::json& value) { nlohmann::json::to_cbor(value, output_); }

    /// What a head says of its count is an unsigned integer of another major type.
    void head(int major, std::uint64_t count) {
        const std::size_t at = out.size();
        item(count);
        out[at] = static_cast<char>(out[at] | major << 5);
    }

    /// Integers as such, other numbers as float where that is exact.
    void number(double number) {
        const bool negativeZero = number == 0 && std::signbit(number);
        if (!std::isfinite(number))
            item(numberText(number));
        else if (number == std::trunc(number) && std::abs(number) <= exactIntegers && !negativeZero)
            item(static_cast<std::int64_t>(number));
        else
            item(number);
    }

    void write(const Numbers& numbers) {
        head(array, numbers.count());
        for (std::size_t i = 0; i < numbers.values.size(); ++i) {
            if (numbers.width > 0 && i % numbers.width == 0) head(array, std::uint64_t(numbers.width));
            number(numbers.values[i]);
        }
    }

    nlohmann::detail::output_adapter<char> output_{out};
};

} // namespace

std::string jsonText(const Value& value) {
    JsonWriter writer;
    writer.writeInLine(TypedValue{value});
    return std::move(writer.out);
}

std::string writeJson(const Layer& layer) {
    JsonWriter writer;
    writer.write(layer, 0);
    writer.out += '\n';
    return std::move(writer.out);
}

std::string writeCbor(const Layer& layer) {
    CborWriter writer;
    writer.write(layer);
    return std::move(writer.out);
}

void saveLayer(const Layer& layer, const std::string& file, Encoding encoding) {
    writeFileAtomically(file, encoding == Encoding::Cbor ? writeCbor(layer) : writeJson(layer));
}

std::string saveWithBuffer(Layer layer, const std::string& file, Encoding encoding) {
    const std::filesystem::path path = std::filesystem::weakly_canonical(file);
    const Buffer buffer = takeBuffer(layer, path.stem().string());
    if (!buffer.uri.empty()) writeFileAtomically((path.parent_path() / buffer.uri).string(), buffer.bytes);
    saveLayer(layer, file, encoding);
    return buffer.uri;
}

} // namespace tss
