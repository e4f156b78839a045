#pragma once
#include "bake/geometry/RigFile.h"
#include "bake/robot/Robot.h"

namespace tss {

/// Puts the animations of another file in place of the rig's own, as exporters write a character and its
/// motions to files apart. A node is the one of its name, or whose name after any prefix ("mixamorig:Hips",
/// "Armature|Hips") has the same letters and digits; places are in the rig's unit where both state theirs.
/// What is of no node of the rig is left out by name. Throws InputError for a file without animations, or
/// none of whose nodes the rig has.
void takeAnimations(RigFile& rig, const RigFile& other, const std::string& file);

/// The rigged character, or the machine of animated nodes, that a mesh file holds (addCharacter()): nodes
/// that are bones or that an animation moves, and those between them. Meshes that have no bones go with the
/// node that they hang below. They rest as the meshes are bound, carried to where the file has their first
/// bone. Nodes that nothing moves are links of their own, fixed to the world. metersPerUnit and upAxis are
/// what the file states, or 1 and Z. Throws InputError for a file in which nothing moves, or without faces.
Robot rigRobot(const RigFile& rig, const std::string& file);

} // namespace tss
