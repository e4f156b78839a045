#include "bake/scene/ReadTree.h"
#include "bake/scene/SaxReader.h"

#include <map>

namespace tss {

namespace {

/// The wanted pointers as a tree of their keys.
struct Wanted {
    std::map<std::string, Wanted, std::less<>> below;
    std::size_t offset = std::string_view::npos; ///< of the value, once found
};

/// Walks along the wanted values and passes over all others.
class Locator : public SaxReader<Locator> {
public:
    Locator(std::string_view text, Wanted& root) : SaxReader(text, true), next_(&root) {
        parse(Json::input_format_t::json);
    }

    void add(const Value&) { place(); }
    void open(bool object, std::size_t) { levels_.push_back({place(), !object}); }
    void enter(const std::string& key) { next_ = find(key); }
    void close() { levels_.pop_back(); }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) {
        place(); // where a value would have been
        return false;
    }

private:
    struct Level {
        Wanted* wanted;
        bool array;
        std::size_t count = 0;
    };

    Wanted* find(std::string_view key) const {
        Wanted* const wanted = levels_.back().wanted;
        if (!wanted || wanted->below.empty()) return nullptr;
        const auto found = wanted->below.find(key);
        return found == wanted->below.end() ? nullptr : &found->second;
    }

    /// Takes down where the value stands that has been read.
    Wanted* place() {
        if (!levels_.empty() && levels_.back().array && levels_.back().wanted)
            next_ = find(std::to_string(levels_.back().count++));
        Wanted* const wanted = std::exchange(next_, nullptr);
        if (wanted) wanted->offset = tokenStart();
        return wanted;
    }

    std::vector<Level> levels_;
    Wanted* next_; ///< what the next value is, null when it is not wanted
};

std::vector<std::string> keysOf(const std::string& pointer) {
    std::vector<std::string> keys;
    for (nlohmann::json::json_pointer left(pointer); !left.empty(); left.pop_back())
        keys.insert(keys.begin(), left.back());
    return keys;
}

} // namespace

TextPosition positionOf(std::string_view text, std::size_t offset, TextPosition position, std::size_t from) {
    for (const char c : text.substr(from, offset - from)) {
        if (c == '\n')
            position = {position.line + 1, 1};
        else if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) // not inside of a character
            ++position.column;
    }
    return position;
}

std::string LocatedError::text() const {
    std::string all = what();
    if (position.line == 0 || where.file.empty()) return all;
    return where.file + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) +
           all.substr(where.file.size());
}

std::vector<TextPosition> locateJson(std::string_view text, const std::vector<std::string>& pointers) {
    Wanted root;
    for (const std::string& pointer : pointers) {
        Wanted* at = &root;
        for (const std::string& key : keysOf(pointer)) at = &at->below[key];
    }
    Locator(text, root);

    std::multimap<std::size_t, std::size_t> byOffset; // to which pointer it belongs
    for (std::size_t i = 0; i < pointers.size(); ++i) {
        const Wanted* at = &root;
        std::size_t offset = root.offset;
        for (const std::string& key : keysOf(pointers[i])) {
            at = &at->below.at(key);
            if (at->offset != std::string_view::npos) offset = at->offset;
        }
        byOffset.emplace(offset, i);
    }
    std::vector<TextPosition> positions(pointers.size());
    TextPosition position{1, 1};
    std::size_t before = 0;
    for (const auto& [offset, i] : byOffset) {
        positions[i] = position = positionOf(text, offset, position, before);
        before = offset;
    }
    return positions;
}

} // namespace tss
