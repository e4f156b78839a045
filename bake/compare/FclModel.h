#pragma once
#include "bake/motion/Motion.h"

#include <fcl/fcl.h>

namespace tss::compare {

/// The triangles of a mesh as FCL takes them, in a tree of volumes of one kind.
template <class Volume>
void fillFclModel(fcl::BVHModel<Volume>& model, const TriangleMesh& mesh) {
    std::vector<fcl::Triangle> triangles;
    for (const Tri& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model.beginModel();
    model.addSubModel(mesh.vertices, triangles);
    model.endModel();
}

inline fcl::Transform3d fclPlace(const Pose& pose) {
    fcl::Transform3d transform;
    transform.matrix() = pose.matrix();
    return transform;
}

} // namespace tss::compare
