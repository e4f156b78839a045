#pragma once
#include <array>

/// Franka's Panda as VAMP has it (github.com/KavrakiLab/vamp: 59 spheres on the arm, its pairs compiled in),
/// asked about itself alone. Of the seven joints in order, radians.
namespace vamp_panda {

/// Whether it touches itself.
bool touches(const double* q);

/// Eight configurations side by side, joint by joint, aligned to 64 bytes.
struct alignas(64) Eight {
    std::array<std::array<float, 8>, 7> joints;
};
/// Whether any of them touches.
bool anyTouches(const Eight& q);

} // namespace vamp_panda
