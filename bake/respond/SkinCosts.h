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
    None,    ///< what is between two updates
};
constexpr auto skinParts = static_cast<std::size_t>(SkinPart::None);

/// What the updates of a skin have cost, part by part.
struct SkinCosts {
    std::array<double, skinParts> seconds{};
    std::size_t updates = 0; ///< that had something to do
    std::size_t lookUps = 0;
};

/// Charges time to one part at a time. Does nothing without costs to fill.
class SkinClock {
public:
    SkinCosts* costs = nullptr;

    /// Charges what is in its scope to a part, and no longer to that around it.
    class Scope {
    public:
        Scope(SkinClock& clock, SkinPart part) : clock_(clock), around_(clock.part_) { clock_.turn(part); }
        ~Scope() { clock_.turn(around_); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        SkinClock& clock_;
        SkinPart around_;
    };

private:
    using Time = std::chrono::steady_clock;
    void turn(SkinPart part) {
        if (costs == nullptr) return;
        const Time::time_point now = Time::now();
        if (part_ != SkinPart::None)
            costs->seconds[static_cast<std::size_t>(part_)] +=
                std::chrono::duration<double>(now - last_).count();
        last_ = now;
        part_ = part;
    }

    SkinPart part_ = SkinPart::None;
    Time::time_point last_;
};

} // namespace tss
