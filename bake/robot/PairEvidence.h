#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// What is known of the collision of two bodies.
enum class Meeting {
    Never,  ///< proven for every pose within the limits
    Always, ///< fixed to each other, and the meshes overlap
    Meets,  ///< the meshes meet at a pose that is known
    Open,   ///< neither: no proof, and no such pose was found
};

struct PairEvidence {
    int bodyA = -1, bodyB = -1;
    Meeting verdict = Meeting::Open;
    bool adjacent = false; ///< joined by a joint, perhaps with links between that have no geometry
    bool baked = false;    ///< there is a proof or a table
    double clearance = 0;  ///< scene units. Never: proven, at every pose. Open: the least that was found
    std::string pose; ///< Meets, Open: "joint4 -90, joint6 12.5": degrees or scene units; a joint a value
};

/// The name a body had where it came from: a link's or an OSG node's.
std::string originalName(const Body& body);

/// Evidence on all pairs of a scene, and on bodies that are joined or fixed to each other; in the order of
/// the scene's bodies. Poses are looked for on the meshes themselves: at most some thousands a pair, guided
/// by the pair's table where it has one. Throws InputError for a stale table or proof.
std::vector<PairEvidence> evidenceOf(const SceneModel& scene);

} // namespace tss
