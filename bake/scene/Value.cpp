#include "bake/scene/Value.h"

#include "bake/scene/WriteNumber.h"

namespace tss {

namespace {

std::string quoted(const std::string& text) {
    constexpr std::size_t longest = 40;
    return '"' + (text.size() > longest ? text.substr(0, longest) + "..." : text) + '"';
}

std::string elements(std::size_t count) {
    return "an array of " + std::to_string(count) + (count == 1 ? " element" : " elements");
}

} // namespace

// Here and not inline: GCC 12 sees uninitialized members in the variant's inlined moves where there are none.
Value::Value(const Value&) = default;
Value::Value(Value&&) noexcept = default;
Value& Value::operator=(const Value&) = default;
Value& Value::operator=(Value&&) noexcept = default;
Value::~Value() = default;

Value Numbers::element(std::size_t index) const {
    if (width == 0) return Value(values[index]);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(index * width);
    return Value(Numbers{{first, first + width}, 0});
}

Value::Value(std::int64_t number) {
    constexpr std::int64_t exact = std::int64_t(1) << 53;
    if (number >= -exact && number <= exact)
        data = static_cast<double>(number);
    else
        data = number;
}

Value::Value(std::uint64_t number) {
    if (number <= static_cast<std::uint64_t>(INT64_MAX))
        *this = Value(static_cast<std::int64_t>(number));
    else
        data = number;
}

std::string describe(const Value& value) {
    struct {
        std::string operator()(std::monostate) const { return "null"; }
        std::string operator()(bool flag) const { return flag ? "true" : "false"; }
        std::string operator()(double number) const { return "number " + numberText(number); }
        std::string operator()(std::int64_t number) const { return "number " + std::to_string(number); }
        std::string operator()(std::uint64_t number) const { return "number " + std::to_string(number); }
        std::string operator()(const std::string& text) const { return quoted(text); }
        std::string operator()(const Value::Array& array) const { return elements(array.size()); }
        std::string operator()(const Value::Object&) const { return "an object"; }
        std::string operator()(const Numbers& numbers) const {
            return numbers.width == 0
                       ? elements(numbers.count())
                       : elements(numbers.count()) + " of " + std::to_string(numbers.width) + " numbers";
        }
    } text;
    return std::visit(text, value.data);
}

} // namespace tss
