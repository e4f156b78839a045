#pragma once
#include "bake/respond/SkinCarry.h"

// The steps of makeSkinRig() that make its rows of contact.
namespace tss {

/// A skin vertex that the table lets meet a body, and where it is before it at rest.
struct SkinBefore {
    std::uint32_t vertex = 0; ///< of the skin mesh
    std::uint32_t body = 0;
    bool inside = false; ///< the body, a muscle
    NearestPoint near;
};

/// One for each vertex and body of the table that face each other.
std::vector<SkinBefore> skinBefore(const SkinGround& ground, const SkinTable& table);

/// Fills rows and starts: the vertices before bodies; the bodies' vertices below the skin; with self contact
/// the vertices before another part of the skin. The latter two are found at rest, at both ends of each
/// muscle's range and along the swings of the bones. Returns, #touched, which vertices contacts may push.
std::vector<bool> addRows(SkinRig& rig, const std::vector<SkinBefore>& before,
                          const std::vector<std::uint32_t>& indexOf);

/// Finds what each row keeps, by the look-up of the run time, or the skin would never come back to rest.
void measureRows(SkinRig& rig);

} // namespace tss
