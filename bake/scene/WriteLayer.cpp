#include "bake/scene/WriteLayer.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/NearestFloat.h"
#include "bake/scene/Buffers.h"
#include "bake/scene/LayerMembers.h"
#include "bake/scene/Utf8.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace tss {

namespace {

constexpr std::size_t lineWidth = 110;

/// A string literal; bytes that are not UTF-8 become U+FFFD, so that the text can always be read.
void appendQuoted(std::string& out, std::string_view text) {
    out += '"';
    for (const char c : isUtf8(text) ? std::string(text) : repairedUtf8(text)) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else if (byte < 0x20) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04x", byte);
            out += escape;
        } else {
            if (c == '"' || c == '\\') out += '\\';
            out += c;
        }
    }
    out += '"';
}

/// Writes nodes on one line while they fit, else one member or a line full of elements a line.
class JsonWriter {
public:
    std::string out;

    template <class Node>
    void write(const Node& node, std::size_t indent) {
        if (fitsLine(node)) return;
        if constexpr (requires { forMembers(node, [](const auto&...) { return true; }); })
            writeObject(node, indent);
        else
            writeArray(node, indent);
    }

    void write(const std::string& text, std::size_t) { appendQuoted(out, text); }

    void write(const TypedValue& typed, std::size_t indent) {
        if (fitsLine(typed)) return;
        if (const auto* object = typed.value.as<Value::Object>())
            writeObject(*object, indent);
        else if (typed.value.as<Value::Array>())
            writeArray(typed, indent);
        else if (const auto* numbers = typed.value.as<Numbers>())
            writeNumbers(*numbers, typed.asFloat, indent);
        else
            inLine(typed, std::string::npos);
    }

    /// Writes on one line; false, perhaps with a part written, when that goes beyond the budget of
    /// characters.
    template <class Node>
    bool inLine(const Node& node, std::size_t budget) {
        if constexpr (requires { forMembers(node, [](const auto&...) { return true; }); })
            return inLineObject(node, budget);
        else
            return inLineArray(node, budget);
    }

    bool inLine(const std::string& text, std::size_t budget) {
        appendQuoted(out, text);
        return out.size() <= budget;
    }

    bool inLine(const TypedValue& typed, std::size_t budget) {
        const Value& value = typed.value;
        if (const auto* object = value.as<Value::Object>()) return inLineObject(*object, budget);
        if (value.as<Value::Array>()) return inLineArray(typed, budget);
        if (const auto* numbers = value.as<Numbers>()) return inLineNumbers(*numbers, budget, typed.asFloat);
        if (const auto* text = value.as<std::string>()) return inLine(*text, budget);
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
        return out.size() <= budget;
    }

private:
    void newLine(std::size_t indent) {
        out += '\n';
        lineStart_ = out.size();
        out.append(indent, ' ');
    }

    /// Writes it on the current line if it fits; leaves nothing behind if not.
    template <class Node>
    bool fitsLine(const Node& node) {
        const std::size_t before = out.size();
        const std::size_t budget = lineStart_ + lineWidth;
        if (before < budget && inLine(node, budget)) return true;
        out.resize(before);
        return false;
    }

    void appendReal(double number, bool asFloat) {
        const bool word = !std::isfinite(number);
        if (word) out += '"';
        asFloat ? appendFloat(out, number) : appendNumber(out, number);
        if (word) out += '"';
    }

    template <class Object>
    bool inLineObject(const Object& object, std::size_t budget) {
        out += '{';
        bool first = true;
        const bool fits = forMembers(object, [&](std::string_view key, const auto& node) {
            if (!first) out += ", ";
            first = false;
            appendQuoted(out, key);
            out += ": ";
            return inLine(node, budget);
        });
        out += '}';
        return fits && out.size() <= budget;
    }

    template <class Array>
    bool inLineArray(const Array& array, std::size_t budget) {
        out += '[';
        bool first = true;
        const bool fits = forElements(array, [&](const auto& node) {
            if (!first) out += ", ";
            first = false;
            return inLine(node, budget);
        });
        out += ']';
        return fits && out.size() <= budget;
    }

    void appendElement(const Numbers& numbers, std::size_t i, bool asFloat) {
        if (numbers.width == 0) return appendReal(numbers.values[i], asFloat);
        out += '[';
        for (int k = 0; k < numbers.width; ++k) {
            if (k > 0) out += ',';
            appendReal(numbers.values[i * numbers.width + k], asFloat);
        }
        out += ']';
    }

    bool inLineNumbers(const Numbers& numbers, std::size_t budget, bool asFloat) {
        out += '[';
        for (std::size_t i = 0; i < numbers.count(); ++i) {
            if (i > 0) out += ',';
            appendElement(numbers, i, asFloat);
            if (out.size() > budget) return false;
        }
        out += ']';
        return out.size() <= budget;
    }

    template <class Object>
    void writeObject(const Object& object, std::size_t indent) {
        out += '{';
        bool first = true;
        forMembers(object, [&](std::string_view key, const auto& node) {
            if (!first) out += ',';
            first = false;
            newLine(indent + 1);
            appendQuoted(out, key);
            out += ": ";
            write(node, indent + 1);
            return true;
        });
        newLine(indent);
        out += '}';
    }

    template <class Array>
    void writeArray(const Array& array, std::size_t indent) {
        out += '[';
        bool first = true;
        forElements(array, [&](const auto& node) {
            if (!first) out += ',';
            first = false;
            newLine(indent + 1);
            write(node, indent + 1);
            return true;
        });
        newLine(indent);
        out += ']';
    }

    void writeNumbers(const Numbers& numbers, bool asFloat, std::size_t indent) {
        out += '[';
        newLine(indent + 1);
        for (std::size_t i = 0; i < numbers.count(); ++i) {
            if (i > 0) {
                out += ',';
                if (out.size() - lineStart_ > lineWidth - 10) newLine(indent + 1);
            }
            appendElement(numbers, i, asFloat);
        }
        newLine(indent);
        out += ']';
    }

    std::size_t lineStart_ = 0;
};

/// The items of a layer one by one, each by nlohmann's writer.
class CborWriter {
public:
    std::string out = "\xD9\xD9\xF7"; // "this is CBOR"

    template <class Node>
    void write(const Node& node) {
        if constexpr (requires { forMembers(node, [](const auto&...) { return true; }); }) {
            std::size_t count = 0;
            forMembers(node, [&](const auto&...) { return ++count; });
            head(map, count);
            forMembers(node, [&](std::string_view key, const auto& member) {
                write(std::string(key));
                write(member);
                return true;
            });
        } else {
            std::size_t count = 0;
            forElements(node, [&](const auto&) { return ++count; });
            head(array, count);
            forElements(node, [&](const auto& element) {
                write(element);
                return true;
            });
        }
    }

    void write(const std::string& text) { item(isUtf8(text) ? text : repairedUtf8(text)); }

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
        constexpr double exactIntegers = 9007199254740992.0; // 2^53
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
    writer.inLine(TypedValue{value}, std::string::npos);
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
