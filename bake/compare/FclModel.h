#pragma once
#include "bake/motion/Motion.h"

#include <fcl/fcl.h>

namespace tss::compare {

/// The triangles of a mesh as FCL takes them, `scale` times as large, in a tree of volumes of one kind.
template <class Volume>
void fillFclModel(fcl::BVHModel<Volume>& model, const TriangleMesh& mesh, double scale = 1) {
    std::vector<fcl::Triangle> triangles;
    for (const Tri& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    std::vector<Vec3> vertices = mesh.vertices;
    for (Vec3& v : vertices) v *= scale;
    model.beginModel();
    model.addSubModel(vertices, triangles);
    model.endModel();
}

inline fcl::Transform3d fclPlace(const Pose& pose) {
    fcl::Transform3d transform;
    transform.matrix() = pose.matrix();
    return transform;
}

/// Whether some triangles of the two touch, b placed by the pose; the first contact ends it.
template <class Volume>
bool fclTouch(const fcl::BVHModel<Volume>& a, const fcl::BVHModel<Volume>& b, const Pose& pose) {
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    return fcl::collide(&a, fcl::Transform3d::Identity(), &b, fclPlace(pose), request, result) > 0;
}

/// 0 where they touch.
template <class Volume>
double fclDistance(const fcl::BVHModel<Volume>& a, const fcl::BVHModel<Volume>& b, const Pose& pose) {
    if (fclTouch(a, b, pose)) return 0;
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    return fcl::distance(&a, fcl::Transform3d::Identity(), &b, fclPlace(pose), request, result);
}

} // namespace tss::compare
