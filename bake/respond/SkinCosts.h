#pragma once
#include <array>
#include <chrono>
#include <cstddef>

namespace tss {

/// The parts of a skin's update.
enum class SkinPart {
    Carry,   ///< muscles and bones are placed, and the skin with them
    Sort,    ///< which rows of contact have to be looked up
    Bones,   ///< look-ups at bones
    Muscles, ///< look-ups at muscles
    Folds,   ///< look-ups of the skin at itself
    Pushes,  ///< how much each contact pushes, and what the skin does then
    Show,    ///< places and normals as they are handed out
};
constexpr auto skinParts = static_cast<std::size_t>(SkinPart::Show) + 1;

/// What the updates of a skin have cost, part by part.
struct SkinCosts {
    std::array<double, skinParts> seconds{};
    std::size_t updates = 0; ///< that had something to do
    std::size_t lookUps = 0;
};

/// A stopwatch for the parts of an update. Does nothing without costs to fill.
struct SkinClock {
    SkinCosts* costs = nullptr;
    std::chrono::steady_clock::time_point last; ///< when something was charged last

    void start() {
        if (costs != nullptr) last = std::chrono::steady_clock::now();
    }
    /// Charges the time since the last call to a part.
    void charge(SkinPart part) {
        const auto before = last;
        start();
        if (costs != nullptr)
            costs->seconds[static_cast<std::size_t>(part)] +=
                std::chrono::duration<double>(last - before).count();
    }
};

} // namespace tss
