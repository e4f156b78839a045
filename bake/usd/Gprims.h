#pragma once
#include "bake/scene/SceneParts.h"

namespace tss {

/// The prim is of a type that meshOfGprim() reads.
bool isGprim(const Prim& prim);

/// The prim is a surface of a type that is not read.
bool isUnreadSurface(const Prim& prim);

/// A Mesh (its cage, polygons cut into triangles), or the closed mesh of a Cube, Sphere, Cylinder, Capsule
/// (of one radius, as Capsule_1 and Cylinder_1) or Cone, which encloses it; in the frame that `place` leads
/// to. Throws InputError, or adds to the reader's problems.
TriangleMesh meshOfGprim(const PrimReader& prim, const Eigen::Affine3d& place);

} // namespace tss
