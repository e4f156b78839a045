#pragma once
#include "bake/motion/Motion.h"

#include <memory>
#include <span>
#include <vector>

/// The meshes themselves, asked through FCL: exact triangle tests and distances (METHOD 8).
class GroundTruth {
public:
    GroundTruth(const tss::TriangleMesh& a, const tss::TriangleMesh& b);
    ~GroundTruth();

    /// Do the surfaces meet when B stands at `pose`?
    bool touches(const tss::Pose& pose) const;

    /// Smallest distance of the surfaces, 0 when they meet.
    double distance(const tss::Pose& pose) const;

private:
    struct Models;
    std::unique_ptr<Models> models_;
};

/// Poses uniformly over the limits, from a seed.
std::vector<std::vector<double>> randomPoses(const tss::Motion& motion, std::size_t count,
                                             std::uint64_t seed);

/// Poses close to where contact begins: both ends of bisected segments between a free and a touching pose,
/// not farther apart than `width` times the limits. May give fewer than asked for when one of the two kinds
/// is rare.
std::vector<std::vector<double>> nearContactPoses(const GroundTruth& truth, const tss::Motion& motion,
                                                  std::size_t count, double width, std::uint64_t seed);
