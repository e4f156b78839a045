#include "bake/scene/WriteLayer.h"

#include "bake/base/AtomicFile.h"
#include "bake/scene/Buffers.h"
#include "bake/scene/JsonText.h"
#include "bake/scene/LayerTree.h"
#include "bake/scene/WriteNumber.h"

#include <cmath>
#include <filesystem>

namespace tss {

namespace {

constexpr std::size_t lineWidth = 110;

void appendScalar(std::string& out, double number, bool asFloat) {
    const bool word = !std::isfinite(number);
    if (word) out += '"';
    asFloat ? appendFloat(out, number) : appendNumber(out, number);
    if (word) out += '"';
}

/// Writes values on one line while they fit, else one member or a line full of elements a line.
class JsonWriter {
public:
    std::string out;

    void write(const TreeNode& node, std::size_t indent) {
        if (fitsLine(node)) return;
        switch (node.kind) {
        case TreeNode::Kind::Leaf:
            return write(*node.value, node.asFloat, indent);
        case TreeNode::Kind::Object:
            return writeObject(node.elements, indent);
        case TreeNode::Kind::Array:
            return writeArray(node.elements, indent);
        default:
            inlineNode(node, std::string::npos);
        }
    }

    void writeLine(const Value& value) { inlineNode(value, std::string::npos, false); }

private:
    std::size_t column() const { return out.size() - lineStart_; }

    void newLine(std::size_t indent) {
        out += '\n';
        lineStart_ = out.size();
        out.append(indent, ' ');
    }

    /// Writes it on the current line if it fits; leaves nothing behind if not.
    template <class Node>
    bool fitsLine(const Node& node, bool asFloat = false) {
        const std::size_t before = out.size();
        const std::size_t budget = lineStart_ + lineWidth;
        if (before < budget && inlineNode(node, budget, asFloat) && out.size() <= budget) return true;
        out.resize(before);
        return false;
    }

    bool inlineNode(const TreeNode& node, std::size_t budget, bool = false) {
        switch (node.kind) {
        case TreeNode::Kind::Leaf:
            return inlineNode(*node.value, budget, node.asFloat);
        case TreeNode::Kind::Text:
            appendQuoted(out, node.text);
            break;
        case TreeNode::Kind::Time:
            appendScalar(out, node.time, false);
            break;
        case TreeNode::Kind::Object:
            return inlineObject(node.elements, budget);
        case TreeNode::Kind::Array:
            return inlineArray(node.elements, budget, false);
        }
        return out.size() <= budget;
    }

    bool inlineNode(const Value& value, std::size_t budget, bool asFloat) {
        if (const auto* object = value.as<Value::Object>()) return inlineObject(*object, budget);
        if (const auto* array = value.as<Value::Array>()) return inlineArray(*array, budget, asFloat);
        if (const auto* numbers = value.as<Numbers>()) return inlineNumbers(*numbers, budget, asFloat);
        appendSingle(value, asFloat);
        return out.size() <= budget;
    }

    void appendSingle(const Value& value, bool asFloat) {
        if (const auto* number = value.as<double>()) {
            appendScalar(out, *number, asFloat);
        } else if (const auto* text = value.as<std::string>()) {
            appendQuoted(out, *text);
        } else if (const auto* flag = value.as<bool>()) {
            out += *flag ? "true" : "false";
        } else if (const auto* big = value.as<std::int64_t>()) {
            out += std::to_string(*big);
        } else if (const auto* huge = value.as<std::uint64_t>()) {
            out += std::to_string(*huge);
        } else {
            out += "null";
        }
    }

    template <class Members>
    bool inlineObject(const Members& members, std::size_t budget) {
        out += '{';
        bool first = true;
        for (const auto& member : members) {
            if (!first) out += ", ";
            first = false;
            appendQuoted(out, memberKey(member));
            out += ": ";
            if (!inlineNode(memberValue(member), budget, false)) return false;
        }
        out += '}';
        return out.size() <= budget;
    }

    template <class Elements>
    bool inlineArray(const Elements& elements, std::size_t budget, bool asFloat) {
        out += '[';
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (i > 0) out += ", ";
            if (!inlineNode(elements[i], budget, asFloat)) return false;
        }
        out += ']';
        return out.size() <= budget;
    }

    void appendElement(const Numbers& numbers, std::size_t i, bool asFloat) {
        if (numbers.width == 0) return appendScalar(out, numbers.values[i], asFloat);
        out += '[';
        for (int k = 0; k < numbers.width; ++k) {
            if (k > 0) out += ',';
            appendScalar(out, numbers.values[i * numbers.width + k], asFloat);
        }
        out += ']';
    }

    bool inlineNumbers(const Numbers& numbers, std::size_t budget, bool asFloat) {
        out += '[';
        for (std::size_t i = 0; i < numbers.count(); ++i) {
            if (i > 0) out += ',';
            appendElement(numbers, i, asFloat);
            if (out.size() > budget) return false;
        }
        out += ']';
        return out.size() <= budget;
    }

    void write(const Value& value, bool asFloat, std::size_t indent) {
        if (fitsLine(value, asFloat)) return;
        if (const auto* object = value.as<Value::Object>()) return writeObject(*object, indent);
        if (const auto* array = value.as<Value::Array>()) return writeArray(*array, indent, asFloat);
        if (const auto* numbers = value.as<Numbers>()) return writeNumbers(*numbers, asFloat, indent);
        appendSingle(value, asFloat);
    }
    void write(const TreeNode& node, bool, std::size_t indent) { write(node, indent); }

    template <class Members>
    void writeObject(const Members& members, std::size_t indent) {
        out += '{';
        bool first = true;
        for (const auto& member : members) {
            if (!first) out += ',';
            first = false;
            newLine(indent + 1);
            appendQuoted(out, memberKey(member));
            out += ": ";
            write(memberValue(member), false, indent + 1);
        }
        newLine(indent);
        out += '}';
    }

    template <class Elements>
    void writeArray(const Elements& elements, std::size_t indent, bool asFloat = false) {
        out += '[';
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (i > 0) out += ',';
            newLine(indent + 1);
            write(elements[i], asFloat, indent + 1);
        }
        newLine(indent);
        out += ']';
    }

    void writeNumbers(const Numbers& numbers, bool asFloat, std::size_t indent) {
        out += '[';
        newLine(indent + 1);
        for (std::size_t i = 0; i < numbers.count(); ++i) {
            if (i > 0) {
                out += ',';
                if (column() > lineWidth - 10) newLine(indent + 1);
            }
            appendElement(numbers, i, asFloat);
        }
        newLine(indent);
        out += ']';
    }

    std::size_t lineStart_ = 0;
};

} // namespace

std::string jsonText(const Value& value) {
    JsonWriter writer;
    writer.writeLine(value);
    return std::move(writer.out);
}

std::string writeJson(const Layer& layer) {
    JsonWriter writer;
    writer.write(layerTree(layer), 0);
    writer.out += '\n';
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
