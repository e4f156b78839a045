#pragma once
#include "bake/motion/Motion.h"
#include "bake/respond/SkinRig.h"

#include <span>

namespace tss {

/// One muscle of a rig as it stands.
struct PlacedMuscle {
    std::vector<Vec3> surface; ///< #V, skin's frame
    std::vector<Vec3> normals; ///< #V, outward, length of no meaning
    std::vector<Vec3> centres; ///< #spheres
    std::vector<double> radii; ///< #spheres
};

/// All muscles at given activations, and the skin as they would carry it.
struct SkinScene {
    std::vector<PlacedMuscle> muscles;
    std::vector<Vec3> predicted; ///< #touched: where contacts are looked up, rest carried by the muscles
    std::vector<Vec3> reference; ///< #touched: displacement at which the holds on each vertex balance
};

/// A plane: distance(u) = normal . sum weight_k u_k - bound >= the offset of its row, u the displacements of
/// touched vertices.
struct SkinContact {
    std::uint32_t vertex[3] = {0, 0, 0};
    double weight[3] = {0, 0, 0}; ///< sum 1
    Vec3 normal = Vec3::Zero();   ///< unit; zero: nothing within reach
    double bound = 0;

    bool found() const { return normal != Vec3::Zero(); }
};

/// Moves the muscles and the skin's prediction. activations: one a muscle, missing ones 0. poses: motion of
/// each muscle since rest in the skin's frame, one a muscle or none at all.
void placeMuscles(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                  SkinScene& scene);

/// The plane that row `row` of the table meets, seen from its predicted place: the spheres select, the
/// surface answers (METHOD 6.2). Triangles that face away from the skin are not seen.
SkinContact rowContact(const SkinRig& rig, const SkinScene& scene, std::size_t row);

/// The plane that keeps skin above a muscle vertex which could poke through between skin vertices.
SkinContact pokeContact(const SkinRig& rig, const SkinScene& scene, std::size_t poke);

} // namespace tss
