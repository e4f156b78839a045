#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/motion/MotionBound.h"

namespace tss {

/// A ball about all points of a mesh, in its frame.
struct BallAbout {
    Vec3 centre = Vec3::Zero();
    double radius = 0;

    explicit BallAbout(const TriangleMesh& mesh);
};

/// Whether the surfaces of two bodies may come within `margin` of each other at some pose of
/// the limits. False is certain; true where they do, or where that was not decided in a thousand
/// cells of Q. inB: about B, in B's frame. margin: >= 0, scene units.
bool mayMeet(const MeshQuery& a, const MeshQuery& b, const BallAbout& inB, const Motion& motion,
             double margin);

/// Where B is at the middle of all limits, and how far from there a point of it may be at most.
struct Swept {
    Pose middle;
    double reach = 0;

    Swept(const BallAbout& inB, const Motion& motion);
};

} // namespace tss
