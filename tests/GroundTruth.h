#pragma once
#include "bake/compare/MeshTruth.h"
#include "bake/motion/RandomPoses.h"

/// The meshes themselves, and poses to ask them about: the report's own ground truth (METHOD 8).
using GroundTruth = tss::compare::MeshTruth;
using tss::compare::nearContactPoses;
using tss::randomPoses;
