#pragma once
#include "bake/bind/SkinAttachment.h"
#include "bake/respond/SkinRig.h"

// The steps of makeSkinRig() that make its rows of contact.
namespace tss {

/// Fills rows and starts by the skin vertices and bodies that the table has a test of, and that face each
/// other at rest. SkinRow::vertex is of the skin mesh until addRows().
void addBodyRows(SkinRig& rig, const SkinAnatomy& anatomy, const SkinTable& table);

/// Adds the rows of body vertices against the skin, and with self contact of skin vertices against other
/// parts of the skin, as searchContacts() finds them. indexOf: index of each vertex of the mesh among touched
/// ones. Returns, #touched, which vertices contacts may push.
std::vector<bool> addRows(SkinRig& rig, const std::vector<std::uint32_t>& indexOf);

/// Contacts with the skin that vertices come to on their ways: the triangles that each comes near to.
struct SkinContactSearch {
    std::vector<std::vector<int>> bodies; ///< per vertex of all bodies, triangles of the skin above it
    std::vector<char> outside;            ///< the same: a muscle's that is above the skin at rest
    std::vector<std::vector<int>> folds;  ///< per touched vertex; empty without self contact
};

/// Looks where a rig whose bodies, shares and triangles are set comes near to itself: at rest, at both ends
/// of each muscle's range, and along the swings of the bones. Near are three radii of the skin; bodies are
/// looked at where the steps of a swing end, by four times that at most where its samples are as fine. Parts
/// of the skin may have met half way between two steps.
SkinContactSearch searchContacts(const SkinRig& rig);

/// Run-time places in double precision.
std::vector<Vec3> placesOf(const std::vector<Move>& vertices);

/// Measures offset, facing and clearances of each row. Uses the run time's own query, or the skin would not
/// return exactly to rest.
void measureRows(SkinRig& rig);

} // namespace tss
