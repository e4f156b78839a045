#pragma once
#include "bake/robot/Character.h"
#include "bake/scene/SceneParts.h"

#include <set>
#include <string>
#include <vector>

namespace tss {

/// What of a stage's prims the reading of its characters needs to know, all by entry of the reading's index.
struct SkelSurroundings {
    const std::vector<Xform>& world;          ///< to the world
    const std::vector<std::string>& unplaced; ///< why it has none; empty where it has
    const std::vector<int>& linkOf;           ///< the rigid body that it is part of; -1: none
};

/// The characters of a stage (UsdSkel), one a skeleton that meshes follow.
struct UsdCharacters {
    std::vector<Character> characters;
    std::vector<bool> skinned; ///< by entry: it is a mesh of one of them
};

/// Reads them. Bindings (skel:skeleton, skel:animationSource, skel:joints, skel:geomBindTransform, joint
/// indices and weights) are those of the prim, or of the nearest one above it that says something. names:
/// that are taken, which receive those of bones and meshes. start: time code of animations without one. What
/// cannot be read is left out by name and with what is wrong; such a mesh is none of a character.
UsdCharacters readUsdSkel(const SceneReading& reading, const SkelSurroundings& around, double start,
                          std::set<std::string>& names, LeftOut& leftOut);

/// Adds them, each on `world` (-1: the world itself). Unless the stage says its end it lasts as long as the
/// animations.
void addCharacters(const UsdCharacters& found, int world, bool saysEnd, Robot& robot, LeftOut& leftOut);

/// A type of prim that readUsdSkel() reads.
bool isOfCharacters(const std::string& type);

} // namespace tss
