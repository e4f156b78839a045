#include "bake/scene/ParseJson.h"

#include "bake/scene/JsonText.h"
#include "bake/scene/LocateJson.h"
#include "bake/scene/TreeBuilder.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace tss {

namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// RFC 8259, to the letter.
class JsonReader {
public:
    JsonReader(std::string_view text, const std::string& fileName) : text_(text), tree_(fileName) {}

    Value read() {
        if (text_.starts_with("\xEF\xBB\xBF")) fault("no byte order mark at the beginning");
        value();
        space();
        if (at_ != text_.size()) fault("nothing more after the value");
        return tree_.take();
    }

    std::size_t at() const { return at_; }

private:
    char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    std::string found() const {
        if (at_ >= text_.size()) return "the end of the file";
        const char c = text_[at_];
        if (c == '\0') return "a NUL byte";
        if (c > ' ' && c < '\x7F') return std::string("'") + c + "'";
        return "byte " + std::to_string(static_cast<unsigned char>(c));
    }

    [[noreturn]] void fault(const std::string& expected) const {
        const TextPosition position = positionOf(text_, at_);
        tree_.refuse("expected JSON: " + expected + ", found " + found() + " at line " +
                     std::to_string(position.line) + ", column " + std::to_string(position.column));
    }

    void space() {
        while (next() == ' ' || next() == '\n' || next() == '\r' || next() == '\t') ++at_;
    }

    void expect(char c, const char* what) {
        if (next() != c || at_ >= text_.size()) fault(what);
        ++at_;
    }

    void word(std::string_view word, Value value) {
        if (text_.substr(at_, word.size()) != word) fault("a value");
        at_ += word.size();
        tree_.add(std::move(value));
    }

    void value() {
        space();
        switch (next()) {
        case '{':
            return object();
        case '[':
            return array();
        case '"':
            return tree_.add(Value(string()));
        case 't':
            return word("true", Value(true));
        case 'f':
            return word("false", Value(false));
        case 'n':
            return word("null", Value());
        default:
            return number();
        }
    }

    void object() {
        tree_.startObject();
        ++at_;
        space();
        if (next() != '}') {
            while (true) {
                space();
                if (next() != '"') fault("a key in double quotes");
                const std::size_t start = at_;
                const std::string key = string();
                const std::size_t end = at_;
                at_ = start; // where a key that stands twice is refused
                tree_.key(key);
                at_ = end;
                space();
                expect(':', ": after a key");
                value();
                space();
                if (next() != ',') break;
                ++at_;
            }
        }
        expect('}', ", or } after a member");
        tree_.endObject();
    }

    void array() {
        tree_.startArray();
        ++at_;
        space();
        if (next() != ']') {
            while (true) {
                value();
                space();
                if (next() != ',') break;
                ++at_;
            }
        }
        expect(']', ", or ] after an element");
        tree_.endArray();
    }

    void number() {
        const std::size_t start = at_;
        bool whole = true;
        const auto digits = [&] {
            if (!isDigit(next())) fault(at_ == start ? "a value" : "a digit");
            while (isDigit(next())) ++at_;
        };
        if (next() == '-') ++at_;
        if (next() == '0')
            ++at_;
        else
            digits();
        if (next() == '.') ++at_, whole = false, digits();
        if (next() == 'e' || next() == 'E') {
            ++at_;
            whole = false;
            if (next() == '+' || next() == '-') ++at_;
            digits();
        }
        const std::string_view token = text_.substr(start, at_ - start);
        if (!whole || !integer(token)) real(token, start);
    }

    /// False for an integer of more than 64 bits, which becomes a real number.
    bool integer(std::string_view token) {
        const char *const begin = token.data(), *const end = begin + token.size();
        if (token[0] == '-') {
            std::int64_t number = 0;
            if (std::from_chars(begin, end, number).ec != std::errc()) return false;
            tree_.addInteger(number);
        } else {
            std::uint64_t number = 0;
            if (std::from_chars(begin, end, number).ec != std::errc()) return false;
            tree_.addUnsigned(number);
        }
        return true;
    }

    void real(std::string_view token, std::size_t start) {
        double number = 0;
        const auto read = std::from_chars(token.data(), token.data() + token.size(), number);
        // Too large or too small for it: strtod gives the infinity or the 0 that tells them apart.
        if (read.ec == std::errc::result_out_of_range)
            number = std::strtod(std::string(token).c_str(), nullptr);
        if (!std::isfinite(number)) {
            at_ = start;
            fault("a number that a double can hold instead of " + std::string(token.substr(0, 40)));
        }
        tree_.addNumber(number);
    }

    /// Past a run of plain characters, which are UTF-8.
    void plain(std::string& out) {
        const std::size_t start = at_;
        bool ascii = true;
        while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\\' &&
               static_cast<unsigned char>(text_[at_]) >= 0x20)
            ascii &= static_cast<unsigned char>(text_[at_++]) < 0x80;
        const std::string_view run = text_.substr(start, at_ - start);
        if (!ascii && !isUtf8(run)) {
            at_ = start;
            fault("text in UTF-8 in the string");
        }
        out += run;
    }

    std::string string() {
        std::string out;
        ++at_;
        while (true) {
            plain(out);
            if (next() == '"' && at_ < text_.size()) break;
            if (next() != '\\') fault("\" at the end of a string, and control characters as \\u00..");
            ++at_;
            escape(out);
        }
        ++at_;
        return out;
    }

    unsigned fourHex() {
        unsigned unit = 0;
        for (int k = 0; k < 4; ++k, ++at_) {
            const char c = next();
            const int digit = isDigit(c)             ? c - '0'
                              : c >= 'a' && c <= 'f' ? c - 'a' + 10
                              : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                     : -1;
            if (digit < 0) fault("four hexadecimal digits after \\u");
            unit = unit << 4 | static_cast<unsigned>(digit);
        }
        return unit;
    }

    void escape(std::string& out) {
        constexpr std::string_view letters = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
        const auto known = letters.find(next());
        if (known != std::string_view::npos && at_ < text_.size()) {
            out += meanings[known];
            ++at_;
            return;
        }
        expect('u', "one of \" \\ / b f n r t u after \\");
        unsigned code = fourHex();
        if (code >= 0xD800 && code < 0xDC00 && text_.substr(at_, 2) == "\\u") {
            at_ += 2;
            const unsigned low = fourHex();
            if (low < 0xDC00 || low > 0xDFFF) fault("the second half of a surrogate pair");
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        } else if (code >= 0xD800 && code < 0xE000) {
            fault("the other half of a surrogate pair");
        }
        appendUtf8(out, code);
    }

    static void appendUtf8(std::string& out, unsigned code) {
        const auto byte = [&](unsigned bits) { out += static_cast<char>(bits); };
        if (code < 0x80) return byte(code);
        if (code < 0x800) {
            byte(0xC0 | code >> 6);
        } else if (code < 0x10000) {
            byte(0xE0 | code >> 12);
            byte(0x80 | (code >> 6 & 63));
        } else {
            byte(0xF0 | code >> 18);
            byte(0x80 | (code >> 12 & 63));
            byte(0x80 | (code >> 6 & 63));
        }
        byte(0x80 | (code & 63));
    }

    std::string_view text_;
    std::size_t at_ = 0;
    TreeBuilder tree_;
};

} // namespace

Value parseJson(std::string_view text, const std::string& fileName) {
    JsonReader reader(text, fileName);
    try {
        return reader.read();
    } catch (const InputError& error) {
        throw LocatedError(error, positionOf(text, reader.at()));
    }
}

} // namespace tss
