#include "bake/scene/ParseCbor.h"

#include "bake/scene/JsonText.h"
#include "bake/scene/TreeBuilder.h"

#include <bit>
#include <cmath>

namespace tss {

namespace {

constexpr std::string_view selfDescribing = "\xD9\xD9\xF7"; // tag 55799

/// RFC 8949, appendix D.
double halfToDouble(std::uint16_t half) {
    const int exponent = half >> 10 & 31;
    const double fraction = half & 1023;
    const double size = exponent == 0    ? std::ldexp(fraction, -24)
                        : exponent == 31 ? (fraction == 0 ? INFINITY : NAN)
                                         : std::ldexp(fraction + 1024, exponent - 25);
    return half & 0x8000 ? -size : size;
}

class CborReader {
public:
    CborReader(std::string_view bytes, const std::string& fileName) : bytes_(bytes), tree_(fileName) {}

    Value read() {
        if (bytes_.starts_with(selfDescribing)) at_ = selfDescribing.size();
        item();
        if (at_ != bytes_.size()) refuse("the end of the file after the scene");
        return tree_.take();
    }

private:
    enum Major { Unsigned, Negative, Bytes, Text, Array, Map, Tag, Simple };

    [[noreturn]] void refuse(const std::string& expected) const {
        tree_.refuse("expected CBOR: " + expected + " at byte " + std::to_string(at_));
    }

    std::uint64_t bigEndian(std::size_t size) {
        if (size > bytes_.size() - at_) refuse(std::to_string(size) + " more bytes");
        std::uint64_t number = 0;
        for (std::size_t k = 0; k < size; ++k)
            number = number << 8 | static_cast<std::uint8_t>(bytes_[at_++]);
        return number;
    }

    /// Argument of an item from the low five bits of its first byte.
    std::uint64_t argument(int low) {
        if (low < 24) return static_cast<std::uint64_t>(low);
        if (low > 27) refuse("a definite length");
        return bigEndian(std::size_t(1) << (low - 24));
    }

    /// A count of items that each take at least `bytesEach`.
    std::uint64_t count(int low, std::uint64_t bytesEach) {
        const std::uint64_t count = argument(low);
        if (count > (bytes_.size() - at_) / bytesEach)
            refuse("no more items than bytes are left, found " + std::to_string(count));
        return count;
    }

    std::string text(int low) {
        const std::uint64_t length = count(low, 1);
        const std::string_view text = bytes_.substr(at_, length);
        if (!isUtf8(text)) refuse("text in UTF-8");
        at_ += length;
        return std::string(text);
    }

    void number(double number) {
        if (!std::isfinite(number)) refuse("a finite number (\"inf\", \"-inf\", \"nan\" are texts)");
        // One spelling for each number, so that an integer is an integer however it came.
        tree_.addNumber(number);
    }

    void simple(int low) {
        switch (low) {
        case 20:
            return tree_.add(Value(false));
        case 21:
            return tree_.add(Value(true));
        case 22:
            return tree_.add(Value());
        case 25:
            return number(halfToDouble(static_cast<std::uint16_t>(bigEndian(2))));
        case 26:
            return number(std::bit_cast<float>(static_cast<std::uint32_t>(bigEndian(4))));
        case 27:
            return number(std::bit_cast<double>(bigEndian(8)));
        default:
            refuse("true, false, null or a number");
        }
    }

    void map(int low) {
        tree_.startObject();
        for (std::uint64_t n = count(low, 2); n > 0; --n) {
            const auto first = static_cast<int>(bigEndian(1));
            if (first >> 5 != Text) refuse("a text as key");
            tree_.key(text(first & 31));
            item();
        }
        tree_.endObject();
    }

    void item() {
        const auto first = static_cast<int>(bigEndian(1));
        const int low = first & 31;
        switch (static_cast<Major>(first >> 5)) {
        case Unsigned:
            return tree_.addUnsigned(argument(low));
        case Negative: {
            const std::uint64_t size = argument(low);
            if (size > static_cast<std::uint64_t>(INT64_MAX)) refuse("an integer of 64 bits");
            return tree_.addInteger(-1 - static_cast<std::int64_t>(size));
        }
        case Text:
            return tree_.add(Value(text(low)));
        case Array:
            tree_.startArray();
            for (std::uint64_t n = count(low, 1); n > 0; --n) item();
            return tree_.endArray();
        case Map:
            return map(low);
        case Simple:
            return simple(low);
        default:
            refuse("no byte strings and no tags");
        }
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    TreeBuilder tree_;
};

} // namespace

bool looksLikeCbor(std::string_view bytes) {
    return bytes.starts_with(selfDescribing) ||
           (!bytes.empty() && (static_cast<std::uint8_t>(bytes[0]) >> 5) == 5);
}

Value parseCbor(std::string_view bytes, const std::string& fileName) {
    return CborReader(bytes, fileName).read();
}

} // namespace tss
