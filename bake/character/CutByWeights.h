#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <array>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace tss {

/// What holds vertices: a bone, or what a mesh hangs on.
struct Holder {
    int body = -1;          ///< that it is part of
    Eigen::Affine3d toBody; ///< from where the meshes are bound to the body's frame; may mirror
};

/// A mesh as it is bound.
struct HeldMesh {
    std::vector<Vec3> points; ///< where it is bound, in the frame of all meshes; any that is not finite too
    std::vector<std::array<unsigned int, 3>> triangles;
    std::vector<std::vector<std::pair<int, float>>> weights; ///< #points, of holders; none: the loose one's
    int loose = 0;                                           ///< the holder of vertices that nothing holds
    bool mirrored = false; ///< its points are mirrored against how its triangles are wound
};

/// What a body has of the meshes.
struct BodyPart {
    std::size_t mesh = 0;     ///< the first that it has something of
    TriangleMesh surface;     ///< in the body's frame
    std::set<int> neighbours; ///< bodies whose parts went on where this one was cut off
    std::size_t dropped = 0;  ///< triangles left out since a corner is no finite point; of the loose holder
};

/// The meshes cut into parts, by body. A triangle is of the body whose holders weigh most at its corners.
/// Meshes hang together where their vertices are at one place (to 1e-6 of their size); where a part was cut
/// off another its rim is closed by a fan, so that what was a solid is cut into solids.
std::map<int, BodyPart> cutByWeights(std::span<const Holder> holders, std::span<const HeldMesh> meshes);

} // namespace tss
