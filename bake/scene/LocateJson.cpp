#include "bake/scene/LocateJson.h"

#include "bake/scene/TreeBuilder.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace tss {

namespace {

/// The wanted pointers as a tree of their keys as they stand in the text, escapes and all.
struct Wanted {
    std::map<std::string, Wanted, std::less<>> below;
    std::size_t offset = std::string_view::npos; ///< of the value, once found
};

std::vector<std::string> keysOf(std::string_view pointer) {
    std::vector<std::string> keys;
    while (!pointer.empty()) {
        const auto end = std::min(pointer.find('/', 1), pointer.size());
        std::string key;
        for (std::size_t i = 1; i < end; ++i) { // RFC 6901
            const bool escaped = pointer[i] == '~' && i + 1 < end;
            key += escaped ? (pointer[i + 1] == '0' ? '~' : '/') : pointer[i];
            i += escaped;
        }
        keys.push_back(key);
        pointer.remove_prefix(end);
    }
    return keys;
}

/// Walks along the wanted values and skips all others.
class Walk {
public:
    explicit Walk(std::string_view text) : text_(text) {}

    void value(Wanted& wanted, std::size_t depth = 0) {
        space();
        wanted.offset = at_;
        const bool leaf = wanted.below.empty() || depth == TreeBuilder::deepest;
        if (!leaf && next() == '{')
            object(wanted, depth);
        else if (!leaf && next() == '[')
            array(wanted, depth);
        else
            skip();
    }

private:
    char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void space() {
        while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
            ++at_;
    }

    /// The string that begins here, without its quotes.
    std::string_view string() {
        const std::size_t start = ++at_;
        while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
        at_ = std::min(at_, text_.size());
        const std::string_view content = text_.substr(start, at_ - start);
        if (at_ < text_.size()) ++at_;
        return content;
    }

    /// Past a value of any kind.
    void skip() {
        std::size_t open = 0;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (open == 0 && (c == ',' || c == ']' || c == '}')) return;
            if (c == '"') {
                string();
                continue;
            }
            if (c == '{' || c == '[') ++open;
            if (c == '}' || c == ']') --open;
            ++at_;
        }
    }

    /// Past a comma; false at the end.
    bool more() {
        space();
        return next() == ',' && ++at_;
    }

    void object(Wanted& wanted, std::size_t depth) {
        ++at_;
        do {
            space();
            if (next() != '"') return;
            const auto found = wanted.below.find(string());
            space();
            if (next() != ':') return;
            ++at_;
            if (found != wanted.below.end())
                value(found->second, depth + 1);
            else
                skip();
        } while (more());
        if (next() == '}') ++at_;
    }

    void array(Wanted& wanted, std::size_t depth) {
        ++at_;
        std::size_t index = 0;
        do {
            const auto found = wanted.below.find(std::to_string(index++));
            if (found != wanted.below.end())
                value(found->second, depth + 1);
            else
                skip();
        } while (more());
        if (next() == ']') ++at_;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

/// Moves on from a position known to a later byte.
void advance(TextPosition& position, std::string_view between) {
    for (const char c : between) {
        if (c == '\n')
            position = {position.line + 1, 1};
        else if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) // not inside of a character
            ++position.column;
    }
}

} // namespace

std::string LocatedError::text() const {
    std::string all = what();
    if (position.line == 0 || where.file.empty()) return all;
    return where.file + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) +
           all.substr(where.file.size());
}

TextPosition positionOf(std::string_view text, std::size_t offset) {
    TextPosition position{1, 1};
    advance(position, text.substr(0, offset));
    return position;
}

std::vector<TextPosition> locateJson(std::string_view text, const std::vector<std::string>& pointers) {
    Wanted root;
    std::vector<std::vector<std::string>> keys;
    for (const std::string& pointer : pointers) {
        keys.push_back(keysOf(pointer));
        Wanted* at = &root;
        for (const std::string& key : keys.back()) at = &at->below[key];
    }
    Walk(text).value(root);

    std::vector<std::size_t> offsets;
    for (const auto& path : keys) {
        const Wanted* at = &root;
        offsets.push_back(root.offset);
        for (const std::string& key : path) {
            at = &at->below.at(key);
            if (at->offset != std::string_view::npos) offsets.back() = at->offset;
        }
    }
    std::vector<std::size_t> order(offsets.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return offsets[a] < offsets[b]; });
    std::vector<TextPosition> positions(offsets.size());
    TextPosition position{1, 1};
    std::size_t before = 0;
    for (std::size_t i : order) {
        advance(position, text.substr(before, offsets[i] - before));
        before = offsets[i];
        positions[i] = position;
    }
    return positions;
}

} // namespace tss
