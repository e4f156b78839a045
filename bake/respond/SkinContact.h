#pragma once
#include "bake/respond/SkinScene.h"

namespace tss {

/// Run-time length: a vertex that moved by less counts as unmoved.
constexpr float settled = 1e-5f;
/// Run-time length: a row that touched nothing is not queried again before its vertex has moved by this much,
/// so that penetration up to this depth may be missed: 0.03 mm on a head. With a tenth of it a dog's head
/// takes a fifth longer.
constexpr float unseen = 1e-4f;
/// In radii of the skin: a contact first found deeper than this was not entered from outside.
constexpr float enterDepth = 0.25f;

/// A contact constraint normal . sum_k weight_k x_k >= level, x the positions of skin vertices. Run-time
/// lengths.
struct SkinPlane {
    std::uint32_t row = 0; ///< index in SkinRig::rows
    std::uint32_t vertex[4] = {0, 0, 0, 0};
    float weight[4] = {0, 0, 0, 0};
    int vertices = 0; ///< how many of the four are used
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f place = Eigen::Vector3f::Zero(); ///< of the point that it constrains, when it was found
    float level = 0;
    float distance = 0; ///< signed distance of the vertex from the surface, comparable to SkinRow::offset
    float push = 0;     ///< >= 0, the force along the normal (Lagrange multiplier)
    float gap =
        std::numeric_limits<float>::max(); ///< signed distance to the constraint: < 0 where it is violated
    bool found = false; ///< whether there is contact; if not, normal, level, distance and gap mean nothing

    void add(std::uint32_t v, float w) {
        vertex[vertices] = v;
        weight[vertices++] = w;
    }
};

/// The contact constraint of a row in the current scene. It fades out continuously where the surface does not
/// face the vertex (of a bone before skin: only a surface that faces it is found), and beside a rim of the
/// surface. offset: in place of SkinRow::offset.
SkinPlane queryContact(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset);
inline SkinPlane queryContact(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return queryContact(rig, scene, row, row.offset);
}

/// The point that a plane constrains, sum_k weight_k x_k, in the current scene.
Eigen::Vector3f constrainedPoint(const SkinScene& scene, const SkinPlane& plane);

/// The current position, in the skin's frame, of a row's vertex that is tested against the skin.
Eigen::Vector3f vertexPlace(const SkinScene& scene, const SkinRow& row);

/// Offset from a row's anchor to its vertex in the current scene, in the body's frame. For a skin vertex
/// before a bone, whose anchor never moves in that frame, the vertex itself.
Eigen::Vector3f anchorOffset(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

/// Where the clearances of a row's starts at rest are in SkinRig::clearances.
std::size_t clearancesAtRest(const SkinRig& rig, const SkinRow& row);

/// Sets the offsets of a row's clearances, one per start, by the current scene.
void measureOffsets(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, Move* starts);

/// Whether the two sides of a row may touch, judged by how far the vertex has moved against each start
/// triangle since all else but its muscle's activation was at rest (SkinRig::clearances): parts of the skin
/// that turn meet it elsewhere than at the anchor.
bool mayTouch(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

} // namespace tss
