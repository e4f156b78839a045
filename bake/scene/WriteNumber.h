#pragma once
#include <string>

namespace tss {

/// The shortest decimal text that reads back as the same double; integers of up to 2^53 in plain digits, -0.0
/// with its sign. Not-finite numbers as the words inf, -inf, nan, without quotes.
std::string numberText(double number);

/// Appends without allocating.
void appendNumber(std::string& text, double number);
/// The same for a number that a float holds: shortest text that reads back as the same float.
void appendFloat(std::string& text, double number);

} // namespace tss
