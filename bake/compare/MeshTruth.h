#pragma once
#include "bake/motion/Motion.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace tss::compare {

/// The meshes themselves, asked through FCL: exact triangle tests and distances (METHOD 8).
class MeshTruth {
public:
    MeshTruth(const TriangleMesh& a, const TriangleMesh& b);
    ~MeshTruth();

    /// Do the surfaces meet when B stands at `pose`?
    bool touches(const Pose& pose) const;

    /// Smallest distance of the surfaces, 0 when they meet.
    double distance(const Pose& pose) const;

private:
    struct Models;
    std::unique_ptr<Models> models_;
};

/// Poses close to where contact begins: both ends of bisected segments between a free and a touching pose,
/// touching first, not farther apart than `width` times the limits. May give fewer than asked for when one
/// of the two kinds is rare.
std::vector<std::vector<double>> nearContactPoses(const std::function<bool(const Pose&)>& touches,
                                                  const Motion& motion, std::size_t count, double width,
                                                  std::uint64_t seed);
std::vector<std::vector<double>> nearContactPoses(const MeshTruth& truth, const Motion& motion,
                                                  std::size_t count, double width, std::uint64_t seed);

} // namespace tss::compare
