#pragma once
#include "bake/motion/MuscleTrack.h"
#include "bake/table/Table.h"

#include <memory>

namespace tss::compare {

/// [paper] A skin at its rest place whose spheres are pushed out of those of its muscles and bones, each by
/// itself: no elastic sheet ties them together.
class PushedSkin {
public:
    /// bodies: muscles and bones in the order the table knows them, in the skin's frame. chains: see
    /// SkinParameters. Keeps references to skin and table.
    PushedSkin(const TriangleMesh& skin, const SkinTable& table,
               const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
               std::vector<std::vector<int>> chains = {});

    /// Moves each skin sphere out of the sphere that it is deepest in, until it overlaps none. activations:
    /// one per body. poses: motion of each since rest, in the skin's frame; empty: none moves. Returns
    /// whether this is asked for anew.
    bool update(std::span<const double> activations, std::span<const Pose> poses = {});

    /// Of all vertices of the skin.
    const std::vector<Vec3>& places() const { return places_; }

private:
    SphereSet spheresBelow() const;

    const TriangleMesh& skin_;
    const SkinTable& table_;
    std::vector<MuscleTrack> tracks_; ///< one per body
    std::vector<std::vector<int>> chains_;
    std::vector<std::vector<Eigen::Vector4d>> sides_; ///< of each body: Muscle::sides
    std::vector<std::uint32_t> at_; ///< of each sphere: which point of its body's track it is
    std::vector<double> shares_;    ///< of each sphere: its place along its body's bones
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    std::vector<Vec3> normals_; ///< at rest
    std::vector<Vec3> places_;
};

} // namespace tss::compare
