#pragma once
#include "bake/respond/SkinContactSolver.h"
#include "bake/respond/SkinNormalKernel.h"

namespace tss {

/// What an update did.
struct SkinUpdate {
    bool moved = false;       ///< positions or normals changed since the last update
    bool rest = false;        ///< the skin is exactly as modelled
    std::size_t contacts = 0; ///< planes that push
    double pushed = 0;        ///< scene units: how far they move skin, at most, from where it is carried
};

/// A skin that follows its muscles and bones (METHOD 6.5). One instance a skin on the screen; the rig is
/// shared.
///
///     SkinResponse response(skinRig(scene, skin));                    // at load (SkinSetup.h)
///     response.update(activations, poses);                            // each update traversal
///     for k: mesh.vertices[response.vertices()[k]] = response.positions()[k], and so the normals
///
/// Quasi-static: no time step, no velocity, and no history: the skin is a function of the activations,
/// poses and shifts alone, the same bits whatever came before. With all activations 0 and all poses the
/// identity it is exactly at rest. Nothing is allocated any more once its lists have grown to what the motion
/// asks for. Not thread-safe: one thread an instance.
class SkinResponse {
public:
    explicit SkinResponse(std::shared_ptr<const SkinRig> rig);

    /// activations: one per body in the rig's order, missing ones count as 0, clamped to each one's range.
    /// poses: motion of each body (its bone) since rest, in the skin's frame; empty: none moves.
    /// shift: how far something else, as a morph target, has moved each of vertices() since rest, before
    /// bones turn it: in the skin's frame, scene units; empty: nothing has.
    SkinUpdate update(std::span<const double> activations, std::span<const Pose> poses = {},
                      std::span<const Vec3> shift = {});

    /// The vertices that are touched, the only ones that move: indices into the skin's mesh.
    std::span<const std::uint32_t> vertices() const { return rig_->vertices; }
    /// Of these: places in the skin's frame, and unit normals.
    std::span<const Vec3> positions() const { return positions_; }
    std::span<const Vec3> normals() const { return normals_; }

    const SkinRig& rig() const { return *rig_; }

    /// From now on each update adds to `costs`, which must outlive this; null: no longer. Look-ups are timed
    /// one by one, which makes them a tenth slower.
    void charge(SkinCosts* costs) { contacts_.clock.costs = costs; }

private:
    bool setShift(std::span<const Vec3> shift);
    void showPlaces(std::size_t block);
    void showNormals(std::size_t block);
    void show();

    std::shared_ptr<const SkinRig> rig_;
    SkinScene scene_;
    SkinContactSolver contacts_;
    SkinNormalKernel normalKernel_ = skinNormalKernel(bestTarget());
    std::vector<Vec3> positions_, normals_;
    std::vector<char> shown_, shownBefore_; ///< #blocks: positions or normals are not those at rest
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    std::vector<Vec3> shift_; ///< #touched; empty: none
    SkinUpdate last_{.moved = false, .rest = true};
};

} // namespace tss
