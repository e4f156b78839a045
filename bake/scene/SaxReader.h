#pragma once
#include "bake/scene/Value.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <iterator>
#include <string_view>

namespace tss {

/// How far a parser has read a text.
struct Cursor {
    std::string_view text;
    std::size_t at = 0;
    bool ended = false; ///< it asked for more than there is
};

/// Hands a text to nlohmann::json and counts: its parsers do not tell a SAX handler where they are.
struct CountingIterator {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Cursor* cursor = nullptr;

    reference operator*() const { return cursor->text[cursor->at]; }
    CountingIterator& operator++() {
        ++cursor->at;
        return *this;
    }
    CountingIterator operator++(int) {
        const CountingIterator before = *this;
        ++cursor->at;
        return before;
    }
    /// There is but one other iterator to compare with: the end.
    bool operator==(const CountingIterator&) const {
        if (cursor->at < cursor->text.size()) return false;
        cursor->ended = true;
        return true;
    }
};

/// A SAX handler of nlohmann's parsers that knows where the tokens stand. What happens in the text it tells
/// Reader, which derives from it: add() of a Value or double that holds no others, open(object, count) and
/// close() of one that does, enter(key), and parse_error() as nlohmann has it.
template <class Reader>
class SaxReader {
public:
    using Json = nlohmann::json;

    /// looksAhead: the parser takes one character more to know that a number is over, as that of JSON does.
    SaxReader(std::string_view text, bool looksAhead) : cursor_{text}, looksAhead_(looksAhead) {}

    bool null() { return value(Value()); }
    bool boolean(bool flag) { return value(Value(flag)); }
    bool number_integer(std::int64_t number) { return value(Value(number), true); }
    bool number_unsigned(std::uint64_t number) { return value(Value(number), true); }
    bool number_float(double number, const std::string&) { return value(number, true); }
    bool string(const std::string& text) { return value(Value(text)); }
    bool binary(const Json::binary_t&) { return false; } // JSON has none
    bool start_object(std::size_t count) { return opened(true, count); }
    bool start_array(std::size_t count) { return opened(false, count); }
    bool end_object() { return closed(); }
    bool end_array() { return closed(); }
    bool key(const std::string& key) {
        own().enter(key);
        return done(Event::Key);
    }

protected:
    enum class Event { Open, Key, Value };

    bool parse(Json::input_format_t format) {
        const CountingIterator text{&cursor_};
        return Json::sax_parse(text, text, &own(), format);
    }

    /// Start of the JSON token after the last event: the one that Reader is being told of; or where the
    /// parser stopped, which has passed a separator or not.
    std::size_t tokenStart(bool separator = true) const {
        std::size_t at = end_;
        const auto skip = [&](std::string_view characters) {
            const bool found =
                at < cursor_.text.size() && characters.find(cursor_.text[at]) != std::string_view::npos;
            at += found;
            return found;
        };
        while (skip(" \t\r\n")) {
        }
        if (separator && last_ != Event::Open && skip(",:"))
            while (skip(" \t\r\n")) {
            }
        return at;
    }

    Cursor cursor_;
    std::size_t end_ = 0; ///< of the last event
    Event last_ = Event::Open;

private:
    Reader& own() { return static_cast<Reader&>(*this); }

    template <class T>
    bool value(T&& value, bool isNumber = false) {
        own().add(std::forward<T>(value));
        return done(Event::Value, isNumber);
    }
    bool opened(bool object, std::size_t count) {
        own().open(object, count);
        return done(Event::Open);
    }
    bool closed() {
        own().close();
        return done(Event::Value);
    }
    bool done(Event event, bool isNumber = false) {
        end_ = isNumber && looksAhead_ && !cursor_.ended ? cursor_.at - 1 : cursor_.at;
        last_ = event;
        return true;
    }

    bool looksAhead_;
};

} // namespace tss
