#pragma once
#include "bake/motion/Motion.h"
#include "bake/respond/SkinRig.h"
#include "bake/respond/SkinTurn.h"

#include <limits>
#include <span>

namespace tss {

/// One muscle of a rig as it stands.
struct PlacedMuscle {
    double activation = std::numeric_limits<double>::quiet_NaN(); ///< NaN: not placed yet
    Pose pose = Pose::Identity();
    TrackPlace dragPlace;      ///< between the nodes of its drag
    std::vector<Vec3> surface; ///< #V, skin's frame
    std::vector<Vec3> normals; ///< #V, outward, unit
    std::vector<Vec3> centres; ///< #spheres
    std::vector<double> radii; ///< #spheres
    double path = 0;           ///< how far any sphere's surface has moved, all updates together
};

/// All muscles at given activations, and the skin as they drag it along without contact.
struct SkinScene {
    std::vector<PlacedMuscle> muscles;
    std::vector<Move> drag;      ///< #touched: displacement, the sum over the muscles and their bones
    std::vector<Vec3> predicted; ///< #touched: rest and drag; where contacts are looked up
    SkinTurn turn;               ///< #touched: by the bones alone
};

/// Moves the muscles and the skin's prediction. activations, poses (motion of each muscle since rest in the
/// skin's frame): one a muscle, within its range.
void placeMuscles(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                  SkinScene& scene);

/// normal . sum weight_k (rest + u)_k >= level + offset of its row.
struct SkinContact {
    std::uint32_t vertex[3] = {0, 0, 0};
    double weight[3] = {0, 0, 0}; ///< sum 1; across a fold 1 and -1
    int vertices = 3;             ///< of the three, from the first on; the others weigh 0
    Vec3 normal = Vec3::Zero();   ///< unit; zero: nothing within reach
    double distance = 0;          ///< of the rest places from the plane: normal . sum weight_k rest_k - level
    double trust = 1;             ///< 0..1: 1 where skin and surface face the same way, falling smoothly to 0

    int triangle = -1;           ///< that was met, of the muscle or of the skin
    Vec3 weights = Vec3::Zero(); ///< of the point in it
    double clear = 0;            ///< of a row with nothing near: how far from that, scene units

    bool found() const { return normal != Vec3::Zero(); }
};

/// The plane that row `row` of the table meets, seen from its predicted place: the spheres select, the
/// surface answers (METHOD 6.2). Triangles that face away from the skin are not seen.
SkinContact rowContact(const SkinRig& rig, const SkinScene& scene, std::size_t row);

/// The plane that keeps skin above a muscle vertex which could poke through between skin vertices.
SkinContact pokeContact(const SkinRig& rig, const SkinScene& scene, std::size_t poke);

/// The plane that keeps a vertex out of another part of the skin, which gives way as much as the vertex.
SkinContact foldContact(const SkinRig& rig, const SkinScene& scene, std::size_t fold);

} // namespace tss
