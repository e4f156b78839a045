#pragma once
#include "bake/robot/RobotScene.h"
#include "bake/usd/UsdSpec.h"

#include <functional>

namespace tss {

/// A layer that another one names: the text, and one name for one file.
struct UsdFile {
    std::string file, text;
    std::string missing; ///< why there is no text; empty where there is
};

/// Opens the file of this name relative to the folder of the first layer. Throws InputError for one that may
/// not be read.
using OpenUsd = std::function<UsdFile(const std::string& name)>;

/// Files where a robot's meshes may lie (meshesOf() the first layer). Of other places, as https:// and what
/// is within a package, there is none.
OpenUsd besideUsd(const FindMesh& find);

/// A stage: one layer, composed of all that its first one names.
struct UsdStage {
    Layer layer;
    std::vector<std::string> notes; ///< what was left out, by name
    bool ours = false;              ///< a scene of this software: written by it, or with Tss schemas
};

/// Reads a stage from the text of its first layer. Where that one names no other file, and itself by
/// references alone, it is kept as it stands; a layer that this software wrote is then the same again. Else
/// sublayers, inherits, the variants that are selected, references, payloads and specializes are composed in
/// USD's order of strength (PrimSites), and none of them is left in the layer. What an arc names that is not
/// there (a file, or one that is no text of USD, a prim, a variant) is left out, noted, and so is one that
/// leads back to itself. Throws InputError: as parseUsda(), sublayers that lead back to themselves, more than
/// 64 arcs in each other, and what makes more than 65536 prims or 16777216 numbers.
UsdStage readStage(const std::string& text, const std::string& file, const OpenUsd& open);

} // namespace tss
