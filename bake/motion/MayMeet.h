#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/motion/MotionBound.h"

namespace tss {

/// A ball that contains a mesh, in the mesh's frame; its centre is that of the bounding box.
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

/// Bounds where B can be: its pose at the middle of all limits, and how far any of its points can move from
/// there within them.
struct Swept {
    Pose middle;      ///< B to A
    double reach = 0; ///< scene units

    Swept(const BallAbout& inB, const Motion& motion);
};

} // namespace tss
