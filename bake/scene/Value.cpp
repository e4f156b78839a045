#include "bake/scene/Value.h"

#include <charconv>
#include <cmath>

namespace tss {

namespace {

std::string quoted(const std::string& text) {
    constexpr std::size_t longest = 40;
    return '"' + (text.size() > longest ? text.substr(0, longest) + "..." : text) + '"';
}

std::string elements(std::size_t count) {
    return "an array of " + std::to_string(count) + (count == 1 ? " element" : " elements");
}

/// Everything that is written the same way in a float and in a double slot.
bool appendPlain(std::string& text, double number) {
    if (std::isnan(number)) {
        text += "nan";
    } else if (std::isinf(number)) {
        text += number > 0 ? "inf" : "-inf";
    } else if (number == 0 && std::signbit(number)) {
        text += "-0.0";
    } else if (number == std::trunc(number) && std::abs(number) <= exactIntegers) {
        char digits[24];
        const auto end = std::to_chars(digits, digits + sizeof digits, static_cast<std::int64_t>(number)).ptr;
        text.append(digits, end);
    } else {
        return false;
    }
    return true;
}

/// With an exponent where digits alone would read back as an integer that no double holds.
template <class Real>
std::string_view shortest(char (&digits)[40], Real number) {
    const auto end = digits + sizeof digits;
    const auto written = std::abs(number) > exactIntegers
                             ? std::to_chars(digits, end, number, std::chars_format::scientific)
                             : std::to_chars(digits, end, number);
    return {digits, static_cast<std::size_t>(written.ptr - digits)};
}

} // namespace

// Here and not inline: GCC 12 sees uninitialized members in the variant's inlined moves where there are none.
Value Numbers::element(std::size_t index) const {
    if (width == 0) return Value(values[index]);
    const auto first = values.begin() + index * width;
    return Value(Numbers{{first, first + width}, 0});
}

Value::Value(std::int64_t number) {
    constexpr auto exact = static_cast<std::int64_t>(exactIntegers);
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

void appendNumber(std::string& text, double number) {
    char digits[40];
    if (!appendPlain(text, number)) text += shortest(digits, number);
}

void appendFloat(std::string& text, double number) {
    if (appendPlain(text, number)) return;
    char digits[40];
    const float single = static_cast<float>(number);
    const std::string_view written = shortest(digits, single);
    // Files are read as double and then rounded to float: twice rounded, a value hard by the middle of two
    // floats could come back as the neighbour. Its text as a double cannot.
    double back = 0;
    std::from_chars(written.data(), written.data() + written.size(), back);
    if (static_cast<float>(back) == single)
        text += written;
    else
        text += shortest(digits, static_cast<double>(single));
}

std::string numberText(double number) {
    std::string text;
    appendNumber(text, number);
    return text;
}

} // namespace tss
