#pragma once
#include "bake/respond/SkinScene.h"

namespace tss {

/// In sizes of the skin: places that differ by less are the same.
constexpr float settled = 1e-5f;
/// In sizes of the skin: what has moved by less since it met nothing is not looked up, and so may be as deep
/// unseen: 0.03 mm on a head. At a tenth of it a dog's head takes a fifth longer.
constexpr float unseen = 1e-4f;
/// In radii of the skin: what is first met deeper than this was not met from outside.
constexpr float enterDepth = 0.25f;

/// normal . sum weight_k x_k >= level, x the places of the skin. Run-time lengths.
struct SkinPlane {
    std::uint32_t vertex[4] = {0, 0, 0, 0};
    float weight[4] = {0, 0, 0, 0};
    int vertices = 0;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float level = 0;
    float distance = 0;                            ///< signed, as the row's offset is meant
    float push = 0;                                ///< >= 0, along the normal
    float gap = std::numeric_limits<float>::max(); ///< of the skin as it is: < 0 asks for a push
    bool found = false; ///< else it is no contact, and normal, level, distance and gap say nothing
};

/// From the place that a row's vertex is before to the vertex, as they stand; in the body's frame. Before a
/// bone, whose places stay in its frame: from there.
Eigen::Vector3f relativeOf(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

/// Whether what the row is about may have come together, by how far it is off where its muscle alone, or
/// nothing, has moved it.
bool mayMeet(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

/// How far a row that is not SkinOnBody is from the triangles that it is known to meet.
float distanceToKnown(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

/// The plane that a row meets as the scene stands. Surfaces that face another way than the skin, and what
/// lies beside a rim, ask for less and then for nothing, without a jump. offset: as SkinRow::offset.
SkinPlane lookUp(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset);
inline SkinPlane lookUp(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return lookUp(rig, scene, row, row.offset);
}

/// Where what a plane holds is, in the skin as it is.
Eigen::Vector3f placeOf(const SkinScene& scene, const SkinPlane& plane);

} // namespace tss
