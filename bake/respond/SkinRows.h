#pragma once
#include "bake/bind/SkinAttachment.h"
#include "bake/respond/SkinRig.h"

// The steps of makeSkinRig() that make its rows of contact.
namespace tss {

/// A skin vertex and a body that the table has a test of, and that face each other at rest.
struct ContactCandidate {
    std::uint32_t vertex = 0; ///< of the skin mesh
    std::uint32_t body = 0;
    bool inside = false;      ///< the vertex is inside of the body at rest
    bool fromOutside = false; ///< see SkinRow
    NearestPoint nearest;     ///< of the body's surface at rest
};

std::vector<ContactCandidate> contactCandidates(const SkinAnatomy& anatomy, const SkinTable& table);

/// Fills rows and starts: skin vertices against bodies, from the candidates; body vertices against the skin;
/// with self contact skin vertices against other parts of the skin. The latter two are found by
/// searchContacts(). Returns, #touched, which vertices contacts may push.
std::vector<bool> addRows(SkinRig& rig, const std::vector<ContactCandidate>& candidates,
                          const std::vector<std::uint32_t>& indexOf);

/// A mesh in double precision.
TriangleMesh meshOf(const std::vector<Move>& vertices, const std::vector<Tri>& triangles);

/// Measures offset, facing and clearances of each row. Uses the run time's own query, or the skin would not
/// return exactly to rest.
void measureRows(SkinRig& rig);

} // namespace tss
