#pragma once

namespace tss {

/// What became of a joint that was asked to go somewhere.
enum class JointStatus {
    Free,      ///< the asked pose is free and so is the way to it
    Blocked,   ///< stopped at contact on the way
    Slid,      ///< stopped, then slid along the contact
    Separated, ///< started in collision and was led out, or less deep
    Stuck,     ///< started in collision and stayed there
    Returning, ///< started deeper than the table knows: one bounded step towards a pose known to be free
};

inline const char* name(JointStatus status) {
    constexpr const char* names[] = {"free", "blocked", "slid", "separated", "stuck", "returning"};
    return names[static_cast<int>(status)];
}

} // namespace tss
