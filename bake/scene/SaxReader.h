#pragma once
#include "bake/scene/SaxTokens.h"
#include "bake/scene/TreeBuilder.h"

#include <nlohmann/json.hpp>

namespace tss {

/// What the readers of JSON and of CBOR have in common: the events of nlohmann's parser become a tree.
class SaxReader : public SaxTokens {
public:
    using Json = nlohmann::json;

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

} // namespace tss
