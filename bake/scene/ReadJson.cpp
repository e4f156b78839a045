#include "bake/scene/Problems.h"
#include "bake/scene/ReadTree.h"
#include "bake/scene/SaxReader.h"
#include "bake/scene/TreeBuilder.h"

#include <algorithm>
#include <charconv>

namespace tss {

namespace {

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
class JsonReader : public SaxReader<JsonReader> {
public:
    JsonReader(std::string_view text, const std::string& file)
        : SaxReader(text, true), tree_(file, text.size()) {}

    Value read() {
        const std::string_view text = cursor_.text;
        if (text.starts_with("\xEF\xBB\xBF")) fault("no byte order mark at the beginning", 0);
        parse(Json::input_format_t::json);
        // nlohmann takes a NUL byte for the end.
        if (const auto nul = text.find('\0', end_); nul != text.npos)
            fault("nothing more after the value", nul);
        return tree_.take();
    }

    template <class T>
    void add(T&& value) {
        tree_.add(std::forward<T>(value));
    }
    void open(bool object, std::size_t) {
        located([&] { tree_.open(object); });
        if (!object) takePlainNumbers();
    }
    void enter(const std::string& key) {
        located([&] { tree_.key(key); });
    }
    void close() { tree_.close(); }

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
        if (!key || (start < cursor_.text.size() && cursor_.text[start] == '"'))
            for (const BadToken& bad : badTokens)
                if (rest.substr(rest.find(" - ") + 3).starts_with(bad.theirs))
                    fault(std::string(bad.expected), cursor_.ended ? cursor_.text.size() : cursor_.at - 1);
        fault(key ? "a key in double quotes" : "a value", start);
    }

private:
    /// A large scene is mostly arrays of numbers, which are read here in a third of the time: those that an
    /// array begins with, each with a comma and another number behind it. Whatever is not plainly such a
    /// number is left to the parser, which knows what to say of it.
    void takePlainNumbers() {
        const char *const begin = cursor_.text.data(), *const end = begin + cursor_.text.size();
        const auto space = [&](const char* at) {
            while (at < end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) ++at;
            return at;
        };
        const auto isDigit = [&](const char* at) { return at < end && *at >= '0' && *at <= '9'; };
        const auto isNumber = [&](const char* at) {
            at += at < end && *at == '-';
            return isDigit(at) && (*at != '0' || !isDigit(at + 1));
        };
        const char* at = space(begin + cursor_.at);
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
            tree_.add(number);
            at = space(comma + 1);
        }
        cursor_.at = static_cast<std::size_t>(at - begin);
    }

    /// A refusal by the tree is of the token that has just been read.
    template <class Step>
    void located(const Step& step) {
        try {
            step();
        } catch (const InputError& error) {
            throw LocatedError(error, positionOf(cursor_.text, tokenStart()));
        }
    }

    std::string found(std::size_t at) const {
        if (at >= cursor_.text.size()) return "the end of the file";
        const char c = cursor_.text[at];
        if (c == '\0') return "a NUL byte";
        if (c > ' ' && c < '\x7F') return std::string("'") + c + "'";
        return "byte " + std::to_string(static_cast<unsigned char>(c));
    }

    [[noreturn]] void fault(const std::string& expected, std::size_t at) const {
        const TextPosition position = positionOf(cursor_.text, at);
        try {
            tree_.refuse(joined("expected JSON: ", expected, ", found ", found(at), " at line ",
                                position.line, ", column ", position.column));
        } catch (const InputError& error) {
            throw LocatedError(error, position);
        }
    }

    TreeBuilder tree_;
};

} // namespace

Value parseJson(std::string_view text, const std::string& fileName) {
    return JsonReader(text, fileName).read();
}

} // namespace tss
