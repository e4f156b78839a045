#pragma once
#include "bake/respond/SkinRig.h"

namespace tss {

/// Contacts of vertices with the skin that bodies and skin come to on their ways.
struct SkinContacts {
    std::vector<std::vector<int>> triangles; ///< per vertex: triangles of the skin that it came near to
    std::vector<char> outside;               ///< per vertex: a muscle's that is above the skin at rest
    std::vector<char> stickingOut;           ///< per vertex: a bone's, such as a tooth's, that is above it

    explicit SkinContacts(std::size_t vertices = 0)
        : triangles(vertices), outside(vertices, 0), stickingOut(vertices, 0) {}

    void add(std::size_t vertex, int triangle);
};

struct SkinContactSearch {
    SkinContacts bodies; ///< of the vertices of all bodies, with the skin above them
    SkinContacts folds;  ///< of the skin's own, with other parts of it; empty without self contact
};

/// Looks where a rig whose bodies, shares and triangles are set comes near to itself: at rest, at both ends
/// of each muscle's range, and along the swings of the bones. Near are three radii of the skin; bodies are
/// looked at where the steps of a swing end, by four times that at most where its samples are as fine. Parts
/// of the skin may have met half way between two steps.
SkinContactSearch searchContacts(const SkinRig& rig);

} // namespace tss
