#pragma once
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

/// Where the tokens of a text stand, for a SAX handler that calls done() at the end of each of its events.
class SaxTokens {
public:
    /// looksAhead: the parser takes one character more to know that a number is over, as that of JSON does.
    SaxTokens(std::string_view text, bool looksAhead) : cursor{text}, looksAhead_(looksAhead) {}
    Cursor cursor;

protected:
    enum class Event { Open, Key, Value };

    bool done(Event event, bool isNumber = false) {
        end_ = isNumber && looksAhead_ && !cursor.ended ? cursor.at - 1 : cursor.at;
        last_ = event;
        return true;
    }

    /// Start of the JSON token after the last event: the one that an event is about, before done(); or where
    /// the parser stopped, which has passed a separator or not.
    std::size_t tokenStart(bool separator = true) const {
        std::size_t at = end_;
        const auto skip = [&](std::string_view characters) {
            const bool found =
                at < cursor.text.size() && characters.find(cursor.text[at]) != std::string_view::npos;
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

    std::size_t end_ = 0; ///< of the last event
    Event last_ = Event::Open;

private:
    bool looksAhead_;
};

} // namespace tss
