#include "bake/compare/MeshTruth.h"

#include "bake/compare/FclModel.h"
#include "bake/motion/Motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tss::compare {

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

double largestShare(const Motion& motion, const std::vector<double>& p, const std::vector<double>& q) {
    double most = 0;
    for (std::size_t k = 0; k < q.size(); ++k) {
        const double range = motion.dofs[k].upper - motion.dofs[k].lower;
        if (range > 0) most = std::max(most, std::abs(p[k] - q[k]) / range);
    }
    return most;
}

} // namespace

/// FCL's distance of two triangles is 0 wherever it takes one of them for a line, and that it does by an
/// absolute length: triangles of 0.1 mm in a scene of metres are such. Hence its models are some 2^20 units
/// large, by a power of two, which rounds nothing.
struct MeshTruth::Models {
    Models(const TriangleMesh& a, const TriangleMesh& b) {
        const double size = std::max(diagonal(a), diagonal(b));
        if (size > 0) scale = std::ldexp(1.0, 20 - std::ilogb(size));
        fillFclModel(this->a, a, scale);
        fillFclModel(this->b, b, scale);
    }
    Pose placed(Pose pose) const {
        pose.translation() *= scale;
        return pose;
    }

    Model a, b;
    double scale = 1;
};

MeshTruth::MeshTruth(const TriangleMesh& a, const TriangleMesh& b)
    : models_(std::make_unique<Models>(a, b)) {}

MeshTruth::~MeshTruth() = default;

bool MeshTruth::touches(const Pose& pose) const {
    return fclTouch(models_->a, models_->b, models_->placed(pose));
}

double MeshTruth::distance(const Pose& pose) const {
    return fclDistance(models_->a, models_->b, models_->placed(pose)) / models_->scale;
}

std::vector<std::vector<double>> nearContactPoses(const std::function<bool(const Pose&)>& touches,
                                                  const Motion& motion, std::size_t count, double width,
                                                  std::uint64_t seed) {
    std::vector<std::vector<double>> poses;
    std::optional<std::vector<double>> free, hit;
    for (const auto& q : randomPoses(motion, 20 * count + 1000, seed)) {
        (touches(pose(motion, q)) ? hit : free) = q;
        if (!free || !hit) continue;
        std::vector<double> inside = *hit, outside = *free;
        while (largestShare(motion, inside, outside) > width) {
            std::vector<double> middle(q.size());
            for (std::size_t k = 0; k < q.size(); ++k) middle[k] = 0.5 * (inside[k] + outside[k]);
            (touches(pose(motion, middle)) ? inside : outside) = middle;
        }
        poses.push_back(inside);
        poses.push_back(outside);
        if (poses.size() >= count) break;
        free.reset();
        hit.reset();
    }
    return poses;
}

std::vector<std::vector<double>> nearContactPoses(const MeshTruth& truth, const Motion& motion,
                                                  std::size_t count, double width, std::uint64_t seed) {
    return nearContactPoses([&](const Pose& pose) { return truth.touches(pose); }, motion, count, width,
                            seed);
}

} // namespace tss::compare
