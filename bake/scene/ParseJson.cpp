#include "bake/scene/ParseJson.h"

#include "bake/scene/TreeBuilder.h"

#include <nlohmann/json.hpp>

namespace tss {

namespace {

/// Without the library's own prefix, which names the library and not the fault.
std::string ownWords(const std::string& message) {
    const auto bracket = message.find("] ");
    std::string text = bracket == std::string::npos ? message : message.substr(bracket + 2);
    const std::string prefix = "parse error at ";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

/// Hands nlohmann's events to the tree builder, which checks them.
class Events : public nlohmann::json_sax<nlohmann::json> {
public:
    explicit Events(TreeBuilder& tree) : tree_(tree) {}

    bool null() override { return tree_.add(Value()), true; }
    bool boolean(bool value) override { return tree_.add(Value(value)), true; }
    bool number_integer(number_integer_t value) override { return tree_.addInteger(value), true; }
    bool number_unsigned(number_unsigned_t value) override { return tree_.addUnsigned(value), true; }
    bool number_float(number_float_t value, const string_t&) override { return tree_.addNumber(value), true; }
    bool string(string_t& value) override { return tree_.add(Value(std::move(value))), true; }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return tree_.startObject(), true; }
    bool key(string_t& value) override { return tree_.key(value), true; }
    bool end_object() override { return tree_.endObject(), true; }
    bool start_array(std::size_t) override { return tree_.startArray(), true; }
    bool end_array() override { return tree_.endArray(), true; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
        tree_.refuse("expected JSON: " + ownWords(error.what()));
        return false;
    }

private:
    TreeBuilder& tree_;
};

} // namespace

Value parseJson(std::string_view text, const std::string& fileName) {
    TreeBuilder tree(fileName);
    if (text.starts_with("\xEF\xBB\xBF"))
        tree.refuse("expected JSON: found a byte order mark at its beginning");
    if (const auto at = text.find('\0'); at != std::string_view::npos)
        tree.refuse("expected JSON: found a NUL byte at offset " + std::to_string(at));
    Events events(tree);
    nlohmann::json::sax_parse(text.begin(), text.end(), &events);
    return tree.take();
}

} // namespace tss
