#pragma once
#include "bake/compare/MeshTruth.h"
#include "bake/motion/Motion.h"

/// The meshes themselves, and poses to ask them about: the report's own ground truth (METHOD 8).
using GroundTruth = tss::compare::MeshTruth;
using tss::randomPoses;
using tss::compare::nearContactPoses;
