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

/// Whether the surfaces of two bodies may touch at some pose of the limits. False is certain; true where they
/// do, or where that was not decided in a thousand cells of Q. inB: about B, in B's frame.
bool mayMeet(const MeshQuery& a, const MeshQuery& b, const BallAbout& inB, const Motion& motion);

} // namespace tss
