#pragma once
#include "bake/motion/Motion.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinRig.h"
#include "bake/respond/SkinStrain.h"
#include "bake/respond/SkinWatch.h"

#include <span>

namespace tss {

/// What an update did.
struct SkinUpdate {
    bool moved = false;       ///< positions or normals changed since the last update
    bool rest = false;        ///< the skin is exactly as modelled
    std::size_t contacts = 0; ///< planes that push
};

/// A skin that follows its muscles (METHOD 6.3). One instance a skin on the screen; the rig is shared.
///
///     auto rig = makeSkinRig(skinMesh, muscles, table, parameters);   // at load
///     SkinResponse response(rig);
///     response.update(activations);                                   // each update traversal
///     for k: mesh.vertices[rig->vertices[k]] = response.positions()[k], and the same for normals()
///
/// Quasi-static: no time step, no velocity; the state is the multipliers of the last update, which only make
/// the next one converge sooner, and what of skin and contacts can wait since it has hardly moved. An update
/// that changes nothing leaves nothing waiting. Same calls, same bits. With all activations 0 and all poses
/// the identity the skin is exactly at rest, at once, whatever came before. Nothing is allocated any more
/// once its lists have grown to what the motion asks for. Not thread-safe: one thread an instance.
class SkinResponse {
public:
    explicit SkinResponse(std::shared_ptr<const SkinRig> rig);

    /// activations: one a muscle in the rig's order, missing ones count as 0, clamped to each muscle's range.
    /// poses: motion of each muscle (its bone) since rest, in the skin's frame; empty: none moves.
    SkinUpdate update(std::span<const double> activations, std::span<const Pose> poses = {});

    /// Of the touched vertices, rig().vertices: places in the skin's frame, and unit normals.
    std::span<const Vec3> positions() const { return positions_; }
    std::span<const Vec3> normals() const { return normals_; }

    const SkinRig& rig() const { return *rig_; }

    /// Largest change of a displacement in the last sweep of the last update, scene units: how far from
    /// converged it is.
    double residual() const { return residual_; }

    /// The muscles as they stood at the last update that moved something.
    const SkinScene& scene() const { return scene_; }

private:
    void toRest();
    void pushOut();
    void solve(bool same);
    void findContacts(bool same);
    void findNormals();

    std::shared_ptr<const SkinRig> rig_;
    SkinScene scene_;
    SkinSolver solver_;
    SkinStrain strain_;
    SkinWatch watch_;
    std::vector<SheetPlane> planes_; ///< rows, then pokes, then folds
    std::vector<Move> still_;        ///< #vertices of the contact patch: the drags are taken in already
    std::vector<Vec3> positions_, normals_;
    const SkinKernels& kernels_;
    std::vector<SkinPlace> places_;     ///< of the touched vertices, then of the border
    std::vector<SkinPlace> normalSums_; ///< the same
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    double residual_ = 0, largest_ = 0; ///< the latter of the sheet's displacements
    bool atRest_ = true, settled_ = false;
};

} // namespace tss
