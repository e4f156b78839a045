#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// Where the meshes of a pair overlap at rest: looks for small moves of B and of the joint's axes that give
/// it room and says them as options of `tss make` to paste, with the clearance that each gives. Returns them
/// as data; empty where the meshes do not overlap there, or the joint has room all the same.
/// Where more than three pairs are looked at, only the best move of each is said; the data has them all.
Json adviseMoves(const SceneModel& scene, const Pair& pair, std::size_t pairs, const Console& console);

} // namespace tss::tool
