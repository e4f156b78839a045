#pragma once
#include "bake/motion/MuscleTrack.h"
#include "bake/table/SkinTable.h"

#include <memory>
#include <span>

namespace tss {

/// [paper] The spheres of a skin's table with what moves them: they push a skin that has no elastic sheet.
struct SkinSpheres {
    struct Row {
        std::uint32_t vertex = 0;          ///< index into SkinRig::vertices
        std::uint32_t first = 0, last = 0; ///< its tests
        double radius = 0;
    };
    std::vector<Row> rows;
    std::vector<std::uint32_t> sphere;   ///< #tests
    std::vector<double> restGap;         ///< #tests, at most 0
    std::vector<MuscleTrack> tracks;     ///< one per body
    std::vector<std::uint32_t> body, at; ///< #spheres: its body, and which point of its track it is
    std::vector<double> radius;          ///< #spheres, at activation 0
    std::vector<int> insertion;          ///< #bodies: see SkinParameters::insertions
    std::vector<Eigen::Vector4d> side;   ///< #bodies: see Muscle::side
    std::vector<double> share;           ///< #spheres: of the motion of the insertion's bone
};

/// indexOf: of each skin vertex among the touched ones.
SkinSpheres skinSpheres(const SkinTable& table,
                        const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                        std::span<const int> insertions, const std::vector<std::uint32_t>& indexOf);

/// Moves each skin sphere out of the sphere that it is deepest in, until it overlaps none. poses: one per
/// body, in the skin's frame. places: of the touched vertices, at rest on entry; normals: theirs at rest.
/// Returns how many vertices moved.
std::size_t pushOut(const SkinSpheres& spheres, std::span<const double> activations,
                    std::span<const Pose> poses, std::span<const Vec3> normals, std::span<Vec3> places);

} // namespace tss
