#pragma once
#include "bake/base/Progress.h"
#include "bake/motion/BoneChain.h"
#include "bake/motion/MuscleTrack.h"
#include "bake/table/Table.h"

namespace tss {

/// A muscle under a skin, in the skin's frame, with the spheres that stand for it at activation 0.
struct SkinSearchMuscle {
    const MuscleDeformer* deformer = nullptr;
    SphereSet spheres;
};

/// Where a skin vertex is looked for while the muscles move.
enum class SkinPath {
    AtRest,  ///< [paper] at its rest place
    Carried, ///< [ours] anywhere between its rest place and where the muscle would carry it
};

struct SkinSearchOptions {
    double thickness = 0; ///< radius of every skin sphere, scene units; 0: skinThickness()
    double travel = 0;    ///< how far a vertex may stray from its path, scene units, >= 0
    SkinPath path = SkinPath::Carried;
    std::vector<std::vector<double>>
        stray; ///< #muscles of #V: how far the contraction of the others may move a vertex from the path of
               ///< that muscle, scene units; empty: not at all
    std::vector<std::vector<double>>
        shares; ///< #muscles of #V in [0, 1]: of a bone's motion that a vertex makes; empty: none
    std::vector<BoneSwing> swings;        ///< of the bones that the muscles ride on
    std::vector<std::vector<int>> chains; ///< #muscles: of one over several bones muscles that move with
                                          ///< those behind the first, else none; empty: none for all
};

/// Radius of the skin spheres where nothing else is said: half the mean edge.
double skinThickness(const TriangleMesh& skin);

/// Which skin spheres some muscle sphere can reach (METHOD 6.2): every pair whose gap gets to `travel` or
/// less somewhere in the activation range of its muscle is a test of the table. Each muscle's own range is
/// covered without gaps, but not all bones and muscles together: the table is not certified. One skin sphere
/// per vertex; skin out of reach has no rows.
///   Muscles: spheres move as their MuscleTrack, linear between its nodes, as at run time; each stretch is
///   tested as the capsule that the sphere sweeps.
///   Bones: they move along the swings, and nothing is known of what they meet elsewhere. A vertex moves with
///   the blend of their motions by its shares; between two stations of a swing it may be off the straight
///   line by a tenth of their distance.
/// The table's restGaps are the negative gaps of pairs that overlap at activation 0 (METHOD 2.4). The same
/// table for any number of threads. Throws InputError where progress stops it.
SkinTable searchSkin(const TriangleMesh& skin, const std::vector<SkinSearchMuscle>& muscles,
                     const SkinSearchOptions& options, const Progress& progress = {});

} // namespace tss
