#pragma once
#include "bake/table/Table.h"

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace adversary {

/// One way to change the table of a skin so that a file still holds it.
struct SkinDamage {
    std::string name;
    bool claims = false; ///< it makes the table claim what none of a skin is proven
    std::function<void(tss::SkinTable&, std::mt19937_64&)> apply;
};

/// Fifty kinds. length: how large a change counts, such as the skin's thickness.
std::vector<SkinDamage> skinDamages(double length);

} // namespace adversary
