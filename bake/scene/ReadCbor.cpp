#include "bake/scene/ReadTree.h"
#include "bake/scene/SaxReader.h"
#include "bake/scene/TreeBuilder.h"
#include "bake/scene/Utf8.h"

#include <cmath>

namespace tss {

namespace {

constexpr std::string_view selfDescribing = "\xD9\xD9\xF7"; // CBOR's tag 55799

/// CBOR of the kinds that JSON has. nlohmann reads more than that (tags, byte strings, indefinite lengths),
/// believes counts, and wraps integers below -2^63.
class CborReader : public SaxReader<CborReader> {
public:
    CborReader(std::string_view text, const std::string& file)
        : SaxReader(text, false), tree_(file, text.size()) {}

    Value read() {
        if (cursor_.text.starts_with(selfDescribing)) cursor_.at = end_ = selfDescribing.size();
        parse(Json::input_format_t::cbor);
        return tree_.take();
    }

    bool number_integer(std::int64_t number) {
        if (low() == 27 && byteAt(end_ + 1) >= 0x80) refuse("an integer of 64 bits", headEnd());
        return SaxReader::number_integer(number);
    }
    bool number_float(double number, const std::string& text) {
        if (!std::isfinite(number))
            refuse("a finite number (\"inf\", \"-inf\", \"nan\" are texts)", cursor_.at);
        // One spelling for each number, so that an integer is an integer however it came.
        return SaxReader::number_float(number, text);
    }
    bool string(const std::string& text) {
        check(text);
        return SaxReader::string(text);
    }
    bool binary(const Json::binary_t&) { refuse("no byte strings and no tags", end_ + 1); }

    template <class T>
    void add(T&& value) {
        tree_.add(std::forward<T>(value));
    }
    void open(bool object, std::size_t count) {
        tree_.open(object);
        check(count, object ? 2 : 1);
    }
    void enter(const std::string& key) {
        check(key);
        tree_.key(key);
    }
    void close() { tree_.close(); }

    bool parse_error(std::size_t, const std::string&, const Json::exception& error) {
        const std::size_t size = cursor_.text.size();
        if (std::string_view(error.what()).find(": expected end of input") != std::string_view::npos)
            refuse("the end of the file after the scene", end_);
        if (end_ >= size) refuse("1 more bytes", end_);
        const Major major = this->major();
        if (tree_.inObject() && last_ != Event::Key && major != Text) refuse("a text as key", end_ + 1);
        if (major == Bytes || major == Tag) refuse("no byte strings and no tags", end_ + 1);
        const std::size_t more = headEnd() - end_ - 1;
        if (major == Simple && (low() < 25 || low() > 27)) refuse("true, false, null or a number", end_ + 1);
        if (low() > 27) refuse("a definite length", end_ + 1);
        if (headEnd() > size) refuse(std::to_string(more) + " more bytes", end_ + 1);
        refuseCount(argument());
    }

private:
    enum Major { Unsigned, Negative, Bytes, Text, Array, Map, Tag, Simple };

    std::uint8_t byteAt(std::size_t at) const { return static_cast<std::uint8_t>(cursor_.text[at]); }
    // Of the item that begins where the last event ended:
    Major major() const { return static_cast<Major>(byteAt(end_) >> 5); }
    int low() const { return byteAt(end_) & 31; }
    std::size_t headEnd() const {
        return end_ + 1 + (low() < 24 || low() > 27 ? 0 : std::size_t(1) << (low() - 24));
    }
    std::uint64_t argument() const {
        std::uint64_t number = low() < 24 ? std::uint64_t(low()) : 0;
        for (std::size_t at = end_ + 1; at < headEnd(); ++at) number = number << 8 | byteAt(at);
        return number;
    }

    [[noreturn]] void refuse(const std::string& expected, std::size_t at) const {
        tree_.refuse("expected CBOR: " + expected + " at byte " + std::to_string(at));
    }
    [[noreturn]] void refuseCount(std::uint64_t count) const {
        refuse("no more items than bytes are left, found " + std::to_string(count), headEnd());
    }

    /// A count of items that each take at least `bytesEach`, before any is read.
    void check(std::uint64_t count, std::size_t bytesEach) const {
        if (low() > 27) refuse("a definite length", end_ + 1);
        if (count > (cursor_.text.size() - cursor_.at) / bytesEach) refuseCount(count);
    }

    void check(const std::string& text) const {
        if (low() > 27) refuse("a definite length", end_ + 1);
        if (!isUtf8(text)) refuse("text in UTF-8", headEnd());
    }

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
