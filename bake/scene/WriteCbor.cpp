#include "bake/base/NearestFloat.h"
#include "bake/scene/JsonText.h"
#include "bake/scene/LayerTree.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteNumber.h"

#include <bit>
#include <cmath>

namespace tss {

namespace {

enum Major { Unsigned, Negative, Bytes, Text, Array, Map };

class CborWriter {
public:
    std::string out = "\xD9\xD9\xF7"; // "this is CBOR"

    void write(const TreeNode& node) {
        switch (node.kind) {
        case TreeNode::Kind::Leaf:
            return write(*node.value);
        case TreeNode::Kind::Text:
            return text(node.text);
        case TreeNode::Kind::Time:
            return number(node.time);
        case TreeNode::Kind::Object:
            return members(node.elements);
        case TreeNode::Kind::Array:
            return elements(node.elements);
        }
    }

private:
    void bigEndian(std::uint64_t number, int size) {
        for (int k = size - 1; k >= 0; --k) out += static_cast<char>(number >> (8 * k) & 255);
    }

    void head(Major major, std::uint64_t argument) {
        const int high = major << 5;
        const auto first = [&](int low) { out += static_cast<char>(high | low); };
        if (argument < 24) return first(static_cast<int>(argument));
        int power = 0;
        while (power < 3 && argument >> (8 << power) != 0) ++power;
        first(24 + power);
        bigEndian(argument, 1 << power);
    }

    void integer(std::int64_t number) {
        if (number >= 0)
            head(Unsigned, static_cast<std::uint64_t>(number));
        else
            head(Negative, static_cast<std::uint64_t>(-1 - number));
    }

    /// Integers as such, other numbers as float where that is exact.
    void number(double number) {
        constexpr double exactIntegers = 9007199254740992.0; // 2^53
        const bool negativeZero = number == 0 && std::signbit(number);
        if (!std::isfinite(number)) {
            text(numberText(number));
        } else if (number == std::trunc(number) && std::abs(number) <= exactIntegers && !negativeZero) {
            integer(static_cast<std::int64_t>(number));
        } else if (isFloat(number)) {
            out += '\xFA';
            bigEndian(std::bit_cast<std::uint32_t>(static_cast<float>(number)), 4);
        } else {
            out += '\xFB';
            bigEndian(std::bit_cast<std::uint64_t>(number), 8);
        }
    }

    void text(const std::string& text) {
        const std::string good = isUtf8(text) ? text : repairedUtf8(text);
        head(Text, good.size());
        out += good;
    }

    template <class Members>
    void members(const Members& members) {
        head(Map, members.size());
        for (const auto& member : members) {
            text(memberKey(member));
            write(memberValue(member));
        }
    }

    template <class Elements>
    void elements(const Elements& elements) {
        head(Array, elements.size());
        for (const auto& element : elements) write(element);
    }

    void numbers(const Numbers& numbers) {
        head(Array, numbers.count());
        for (std::size_t i = 0; i < numbers.values.size(); ++i) {
            if (numbers.width > 0 && i % numbers.width == 0) head(Array, std::uint64_t(numbers.width));
            number(numbers.values[i]);
        }
    }

    void write(const Value& value) {
        if (const auto* object = value.as<Value::Object>()) return members(*object);
        if (const auto* array = value.as<Value::Array>()) return elements(*array);
        if (const auto* block = value.as<Numbers>()) return numbers(*block);
        if (const auto* word = value.as<std::string>()) return text(*word);
        if (const auto* single = value.as<double>()) return number(*single);
        if (const auto* big = value.as<std::int64_t>()) return integer(*big);
        if (const auto* huge = value.as<std::uint64_t>()) return head(Unsigned, *huge);
        const auto* flag = value.as<bool>();
        out += flag ? (*flag ? '\xF5' : '\xF4') : '\xF6';
    }
};

} // namespace

std::string writeCbor(const Layer& layer) {
    CborWriter writer;
    writer.write(layerTree(layer));
    return std::move(writer.out);
}

} // namespace tss
