#pragma once
#include "bake/model/SceneModel.h"

#include <cstdint>
#include <string>
#include <vector>

namespace adversary {

/// One way to change a baked scene file.
struct Damage {
    std::string name;
    bool hashed = false; ///< the source hash is made anew, as one does who wants to be believed
};

/// All of them, always in this order.
const std::vector<Damage>& damages();

/// The text of a baked scene with a damage; empty where it does not apply, as one to thresholds where there
/// are none. length: what is much for this scene, such as its tolerance. Different seeds choose different
/// places.
std::string damaged(const std::string& text, std::size_t damage, double length, std::uint64_t seed);

} // namespace adversary
