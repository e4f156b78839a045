#include "bake/scene/ReadTree.h"

#include "bake/scene/Problems.h"
#include "bake/scene/SaxTokens.h"
#include "bake/scene/TreeBuilder.h"
#include "bake/scene/Utf8.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tss {

namespace {

using Json = nlohmann::json;

constexpr std::string_view selfDescribing = "\xD9\xD9\xF7"; // CBOR's tag 55799

/// What both encodings have in common: events into a tree.
class SaxReader : public SaxTokens {
public:
    SaxReader(std::string_view text, const std::string& file, bool looksAhead)
        : SaxTokens(text, looksAhead), tree_(file, text.size()) {}

    bool null() { return add(Value()); }
    bool boolean(bool flag) { return add(Value(flag)); }
    bool number_integer(std::int64_t number) { return addInteger(Value(number)); }
    bool number_unsigned(std::uint64_t number) { return addInteger(Value(number)); }
    bool number_float(double number, const std::string&) {
        tree_.addNumber(number);
        return done(Event::Value, true);
    }
    bool end_object() {
        tree_.endObject();
        return done(Event::Value);
    }
    bool end_array() {
        tree_.endArray();
        return done(Event::Value);
    }

protected:
    bool add(Value value) {
        tree_.add(std::move(value));
        return done(Event::Value);
    }

    bool addInteger(Value number) {
        tree_.addInteger(std::move(number));
        return done(Event::Value, true);
    }

    template <class Handler>
    static bool parse(Handler& handler, Json::input_format_t format) {
        const CountingIterator text{&handler.cursor};
        return Json::sax_parse(text, text, &handler, format);
    }

    TreeBuilder tree_;
};

/// What nlohmann says of a token that cannot be one, and what was expected instead. Comments, literals that
/// are none and the like are no token at all.
struct BadToken {
    std::string_view theirs, expected;
};
constexpr BadToken badTokens[] = {
    {"invalid string: ill-formed UTF-8", "text in UTF-8 in the string"},
    {"invalid string: missing closing", "\" at the end of a string, and control characters as \\u00.."},
    {"invalid string: control", "\" at the end of a string, and control characters as \\u00.."},
    {"invalid string: '\\u'", "four hexadecimal digits after \\u"},
    {"invalid string: surrogate U+D800", "the second half of a surrogate pair"},
    {"invalid string: surrogate U+DC00", "the other half of a surrogate pair"},
    {"invalid string: forbidden", "one of \" \\ / b f n r t u after \\"},
    {"invalid number", "a digit"}};

/// JSON to the letter of RFC 8259.
class JsonReader : public SaxReader {
public:
    JsonReader(std::string_view text, const std::string& file) : SaxReader(text, file, true) {}

    Value read() {
        const std::string_view text = cursor.text;
        if (text.starts_with("\xEF\xBB\xBF")) fault("no byte order mark at the beginning", 0);
        parse(*this, Json::input_format_t::json);
        // nlohmann takes a NUL byte for the end.
        if (const auto nul = text.find('\0', end_); nul != text.npos)
            fault("nothing more after the value", nul);
        return tree_.take();
    }

    bool string(const std::string& text) { return add(Value(text)); }
    bool binary(const Json::binary_t&) { return false; } // JSON has none
    bool start_object(std::size_t) {
        located([&] { tree_.open(true); });
        return done(Event::Open);
    }
    bool start_array(std::size_t) {
        located([&] { tree_.open(false); });
        takePlainNumbers();
        return done(Event::Open);
    }
    bool key(const std::string& key) {
        located([&] { tree_.key(key); });
        return done(Event::Key);
    }

    bool parse_error(std::size_t, const std::string& token, const Json::exception& error) {
        const std::string_view says = error.what();
        if (says.find("number overflow") != says.npos)
            fault("a number that a double can hold instead of " + token.substr(0, 40), tokenStart());
        const auto parsing = says.find("while parsing ");
        const std::string_view rest = says.substr(parsing == says.npos ? says.size() : parsing + 14);
        if (says.ends_with("expected end of input")) fault("nothing more after the value", tokenStart(false));
        if (rest.starts_with("array")) fault(", or ] after an element", tokenStart(false));
        if (rest.starts_with("object separator")) fault(": after a key", tokenStart(false));
        if (rest.starts_with("object -")) fault(", or } after a member", tokenStart(false));
        const std::size_t start = tokenStart();
        const bool key = rest.starts_with("object key");
        if (!key || (start < cursor.text.size() && cursor.text[start] == '"'))
            for (const BadToken& bad : badTokens)
                if (rest.substr(rest.find(" - ") + 3).starts_with(bad.theirs))
                    fault(std::string(bad.expected), cursor.ended ? cursor.text.size() : cursor.at - 1);
        fault(key ? "a key in double quotes" : "a value", start);
    }

private:
    /// A large scene is mostly arrays of numbers, which are read here in a third of the time: those that an
    /// array begins with, each with a comma and another number behind it. Whatever is not plainly such a
    /// number is left to the parser, which knows what to say of it.
    void takePlainNumbers() {
        const char *const begin = cursor.text.data(), *const end = begin + cursor.text.size();
        const auto space = [&](const char* at) {
            while (at < end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) ++at;
            return at;
        };
        const auto isDigit = [&](const char* at) { return at < end && *at >= '0' && *at <= '9'; };
        const auto isNumber = [&](const char* at) {
            at += at < end && *at == '-';
            return isDigit(at) && (*at != '0' || !isDigit(at + 1));
        };
        const char* at = space(begin + cursor.at);
        while (isNumber(at)) {
            double number = 0;
            const auto [stop, error] = std::from_chars(at, end, number);
            if (error != std::errc()) break;
            const bool whole = std::string_view(at, stop).find_first_of(".eE") == std::string_view::npos;
            const char* const point = whole ? stop : std::find(at, stop, '.');
            if (point != stop && !isDigit(point + 1)) break;
            constexpr std::ptrdiff_t exactDigits = 15;
            if (whole && (stop - at > exactDigits || (number == 0 && *at == '-')))
                break; // -0 is the integer 0
            const char* const comma = space(stop);
            if (comma == end || *comma != ',' || !isNumber(space(comma + 1))) break;
            tree_.addNumber(number);
            at = space(comma + 1);
        }
        cursor.at = static_cast<std::size_t>(at - begin);
    }

    /// A refusal by the tree is of the token that has just been read.
    template <class Step>
    void located(const Step& step) {
        try {
            step();
        } catch (const InputError& error) {
            throw LocatedError(error, positionOf(cursor.text, tokenStart()));
        }
    }

    std::string found(std::size_t at) const {
        if (at >= cursor.text.size()) return "the end of the file";
        const char c = cursor.text[at];
        if (c == '\0') return "a NUL byte";
        if (c > ' ' && c < '\x7F') return std::string("'") + c + "'";
        return "byte " + std::to_string(static_cast<unsigned char>(c));
    }

    [[noreturn]] void fault(const std::string& expected, std::size_t at) const {
        const TextPosition position = positionOf(cursor.text, at);
        try {
            tree_.refuse(joined("expected JSON: ", expected, ", found ", found(at), " at line ",
                                position.line, ", column ", position.column));
        } catch (const InputError& error) {
            throw LocatedError(error, position);
        }
    }
};

/// CBOR of the kinds that JSON has. nlohmann reads more than that (tags, byte strings, indefinite lengths),
/// believes counts, and wraps integers below -2^63.
class CborReader : public SaxReader {
public:
    CborReader(std::string_view text, const std::string& file) : SaxReader(text, file, false) {}

    Value read() {
        if (cursor.text.starts_with(selfDescribing)) cursor.at = end_ = selfDescribing.size();
        parse(*this, Json::input_format_t::cbor);
        return tree_.take();
    }

    bool number_integer(std::int64_t number) {
        if (low() == 27 && byteAt(end_ + 1) >= 0x80) refuse("an integer of 64 bits", headEnd());
        return SaxReader::number_integer(number);
    }
    bool number_float(double number, const std::string& text) {
        if (!std::isfinite(number))
            refuse("a finite number (\"inf\", \"-inf\", \"nan\" are texts)", cursor.at);
        // One spelling for each number, so that an integer is an integer however it came.
        return SaxReader::number_float(number, text);
    }
    bool string(const std::string& text) {
        check(text);
        return add(Value(text));
    }
    bool binary(const Json::binary_t&) { refuse("no byte strings and no tags", end_ + 1); }
    bool start_object(std::size_t count) {
        tree_.open(true);
        check(count, 2);
        return done(Event::Open);
    }
    bool start_array(std::size_t count) {
        tree_.open(false);
        check(count, 1);
        return done(Event::Open);
    }
    bool key(const std::string& key) {
        check(key);
        tree_.key(key);
        return done(Event::Key);
    }

    bool parse_error(std::size_t, const std::string&, const Json::exception& error) {
        const std::size_t size = cursor.text.size();
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

    std::uint8_t byteAt(std::size_t at) const { return static_cast<std::uint8_t>(cursor.text[at]); }
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
        if (count > (cursor.text.size() - cursor.at) / bytesEach) refuseCount(count);
    }

    void check(const std::string& text) const {
        if (low() > 27) refuse("a definite length", end_ + 1);
        if (!isUtf8(text)) refuse("text in UTF-8", headEnd());
    }
};

} // namespace

bool looksLikeCbor(std::string_view bytes) {
    return bytes.starts_with(selfDescribing) ||
           (!bytes.empty() && (static_cast<std::uint8_t>(bytes[0]) >> 5) == 5);
}

Value parseJson(std::string_view text, const std::string& fileName) {
    return JsonReader(text, fileName).read();
}

Value parseCbor(std::string_view bytes, const std::string& fileName) {
    return CborReader(bytes, fileName).read();
}

} // namespace tss
