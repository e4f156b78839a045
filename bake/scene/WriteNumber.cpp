#include "bake/scene/WriteNumber.h"

#include <charconv>
#include <cmath>
#include <cstdint>

namespace tss {

namespace {

constexpr double exactIntegers = 9007199254740992.0; // 2^53

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
