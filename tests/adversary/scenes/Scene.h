#pragma once
#include "bake/model/SceneModel.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace adversary {

/// One nasty scene: two bodies, a motion, settings of the bake.
struct Draft {
    tss::TriangleMesh a, b; ///< both in A's frame, with every DOF at rest
    tss::Motion motion;
    double tolerance = 0.05; ///< scene units before scaling by `unit`
    double unit = 1;         ///< everything is made so many times as large
    double metersPerUnit = 1;
    tss::BakeSettings settings; ///< beside the tolerance; lengths among them before scaling, see draftScene()
    bool refused = false;       ///< it must be: there is nothing that could be proven
};

/// A kind of scenes and who draws them.
struct Kind {
    std::string_view name;
    Draft (*draw)(std::uint64_t seed);
};

/// All kinds, always in this order.
const std::vector<Kind>& kinds();

/// The scene of a seed: its kind goes by the seed, so that any row of seeds has all kinds.
struct NamedDraft {
    std::string name; ///< kind and seed, "needles-17"
    std::string_view kind;
    Draft draft;
};
NamedDraft drawScene(std::uint64_t seed);

/// The scene as its file gives it. Throws InputError for a motion that a file cannot spell.
tss::SceneModel sceneOf(const Draft& draft, const std::string& name);

} // namespace adversary
