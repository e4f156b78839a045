#pragma once
#include "bake/respond/SkinRig.h"
#include "bake/respond/SkinShares.h"

namespace tss {

/// A skin and what lies under it, measured once for all steps of makeSkinRig().
struct SkinGround {
    SkinGround(const TriangleMesh& mesh, const std::vector<std::shared_ptr<const MuscleDeformer>>& under,
               const SkinParameters& parameters);

    std::vector<std::uint32_t>
        first;         ///< #V: the first vertex at the same place; seams of textures repeat them
    TriangleMesh skin; ///< its triangles are at first ones only
    const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies;
    SkinGraph graph;
    std::vector<Vec3> normals;
    std::vector<ClosestPointQuery> locators; ///< one per body
    bool inverted =
        false; ///< the mesh is wound inwards, towards what lies under it; `skin` and `normals` are not
    std::vector<std::vector<Vec3>> surfaceNormals;
    std::vector<std::vector<bool>> inside; ///< #bodies of #V: within a muscle at rest; empty: a bone
    Vec3 centre = Vec3::Zero();            ///< of the bounds of the skin's triangles
    double size = 0;                       ///< diagonal of these bounds, 1 where it has none
    double length =
        0; ///< over which skin gives way: of the sheet on its foundation, and of what muscles carry
};

/// How a skin is carried, before any contact: #V each.
struct SkinCarriage {
    std::vector<std::vector<double>> frames;      ///< #frames, shares of their motions
    std::vector<std::vector<double>> muscles;     ///< #bodies, shares of their displacement; empty: a bone
    std::vector<std::vector<NearestPoint>> bound; ///< #bodies, where each vertex with a share is bound to
    std::vector<double> firmness; ///< >= 1: how much firmer than other skin it sits on what carries it
};

/// Which frame each body moves with, and how many there are.
std::vector<int> framesOf(const SkinGround& ground, const SkinParameters& parameters);

SkinCarriage carrySkin(const SkinGround& ground, const SkinParameters& parameters);

/// What carries skin, one for each frame and, where it takes one, one more for what holds still: how far each
/// vertex is from the bones of a frame (from its muscles, where it has none), and what belongs to it for
/// certain, see SkinSides. Skin far or apart from every bone is a part of the body whose bones are not named,
/// unless it is a hollow as in a mouth. It goes with what it hangs on where it hangs on one thing
/// alone. Else where it lies beyond a bone that moves, as a hand does beyond a forearm, it goes on from that
/// one; a trunk on both sides of a vertebra is parted; a trunk beside an arm goes with what holds still.
/// Where no bone holds still it stays, unless it is the smaller end of one bone.
std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames);

} // namespace tss
