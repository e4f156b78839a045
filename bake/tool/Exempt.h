#pragma once
#include "bake/tool/Command.h"

namespace tss::tool {

/// How much of either surface a pair's bounds are about: of 1, what is not exempt (METHOD 2.4). Contact of
/// such a part with anything of the other body is bounded.
struct BoundedShares {
    double a = 1, b = 1;

    /// All of both surfaces is exempt from contact with the other: the bounds are about nothing.
    bool none() const { return a <= 0 && b <= 0; }
};

/// From the shares that are exempt. What is left by rounding alone is nothing.
BoundedShares boundedShares(double exemptA, double exemptB);

/// For people, of pairs with exempt parts: "37.5 % of A and over 99.9 % of B". Rounded down, so that no
/// more is promised than holds.
std::string boundedText(const BoundedShares& bounded);

} // namespace tss::tool
