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

/// A mesh in double precision.
TriangleMesh meshOf(const std::vector<Move>& vertices, const std::vector<Tri>& triangles);

/// Measures offset, facing and clearances of each row. Uses the run time's own query, or the skin would not
/// return exactly to rest.
void measureRows(SkinRig& rig);

} // namespace tss
