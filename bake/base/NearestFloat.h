#pragma once

namespace tss {

/// The number rounded to float, to the nearest. Through a volatile: GCC 12 vectorizes double(float(x)) of
/// neighbours into nothing at -O2 and keeps all digits.
inline double nearestFloat(double number) {
    const volatile float single = static_cast<float>(number);
    return single;
}

/// A float holds the number exactly.
inline bool isFloat(double number) {
    return nearestFloat(number) == number;
}

} // namespace tss
