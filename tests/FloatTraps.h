#pragma once
#include <cfenv>

/// In the tests of the core an invalid operation, a division by zero or an overflow ends the test case. While
/// this lives it does not: for tests that hand over numbers that are not finite, on purpose.
class FloatTrapsOff {
public:
    FloatTrapsOff() : enabled_(fedisableexcept(FE_ALL_EXCEPT)) {}
    ~FloatTrapsOff() {
        std::feclearexcept(FE_ALL_EXCEPT);
        feenableexcept(enabled_);
    }
    FloatTrapsOff(const FloatTrapsOff&) = delete;
    FloatTrapsOff& operator=(const FloatTrapsOff&) = delete;

private:
    int enabled_;
};
