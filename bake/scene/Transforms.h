#pragma once
#include "bake/motion/Motion.h"
#include "bake/scene/Properties.h"

namespace tss {

/// A transform, and whether it is surely rigid: no scale and no general matrix went into it.
struct Xform {
    Eigen::Affine3d matrix = Eigen::Affine3d::Identity();
    bool rigid = true;
};

/// The prim's own transform from its xformOpOrder, to its parent (or to the world where the stack is reset).
/// Of animated operations the default counts, or the first sample.
Xform localXform(const PrimReader& prim);

/// The stack begins anew at this prim: its parents' transforms do not apply.
bool resetsXformStack(const PrimReader& prim);

/// A transform split as placement * stretch: a rigid placement, and a symmetric stretch that the points take
/// on (with a mirror in it, when there is one).
struct SplitXform {
    Pose placement = Pose::Identity();
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
    bool stretched = false;
};
SplitXform split(const Xform& xform);

/// A point of a file, a float, with the stretch that it takes on: a float again, which is what is baked,
/// hashed and drawn.
Vec3 stretched(const SplitXform& xform, const Vec3& point);

/// Writes the operations of a rigid transform to the parent.
void writePlacement(PrimWriter& prim, const Pose& placement);

} // namespace tss
