#include "tests/GroundTruth.h"

#include <fcl/fcl.h>
#include <optional>
#include <random>

using Model = fcl::BVHModel<fcl::OBBRSSd>;

struct GroundTruth::Models {
    std::shared_ptr<Model> a, b;
};

namespace {

std::shared_ptr<Model> makeModel(const tss::TriangleMesh& mesh) {
    auto model = std::make_shared<Model>();
    std::vector<fcl::Triangle> triangles;
    for (const tss::Tri& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model->beginModel();
    model->addSubModel(mesh.vertices, triangles);
    model->endModel();
    return model;
}

} // namespace

GroundTruth::GroundTruth(const tss::TriangleMesh& a, const tss::TriangleMesh& b)
    : models_(new Models{makeModel(a), makeModel(b)}) {}

GroundTruth::~GroundTruth() = default;

bool GroundTruth::touches(const tss::Pose& pose) const {
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    fcl::Transform3d placeB;
    placeB.matrix() = pose.matrix();
    return fcl::collide(models_->a.get(), fcl::Transform3d::Identity(), models_->b.get(), placeB, request,
                        result) > 0;
}

double GroundTruth::distance(const tss::Pose& pose) const {
    if (touches(pose)) return 0;
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    fcl::Transform3d placeB;
    placeB.matrix() = pose.matrix();
    return fcl::distance(models_->a.get(), fcl::Transform3d::Identity(), models_->b.get(), placeB, request,
                         result);
}

std::vector<std::vector<double>> randomPoses(const tss::Motion& motion, std::size_t count,
                                             std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::vector<double>> poses(count);
    for (auto& q : poses)
        for (const tss::Dof& dof : motion.dofs)
            q.push_back(std::uniform_real_distribution<double>(dof.lower, dof.upper)(random));
    return poses;
}

std::vector<std::vector<double>> nearContactPoses(const GroundTruth& truth, const tss::Motion& motion,
                                                  std::size_t count, double width, std::uint64_t seed) {
    std::vector<std::vector<double>> poses;
    std::optional<std::vector<double>> free, hit;
    for (const auto& q : randomPoses(motion, 20 * count + 1000, seed)) {
        (truth.touches(pose(motion, q)) ? hit : free) = q;
        if (!free || !hit) continue;
        std::vector<double> inside = *hit, outside = *free;
        const auto apart = [&] {
            double most = 0;
            for (std::size_t k = 0; k < q.size(); ++k) {
                const double range = motion.dofs[k].upper - motion.dofs[k].lower;
                if (range > 0) most = std::max(most, std::abs(inside[k] - outside[k]) / range);
            }
            return most;
        };
        while (apart() > width) {
            std::vector<double> middle(q.size());
            for (std::size_t k = 0; k < q.size(); ++k) middle[k] = 0.5 * (inside[k] + outside[k]);
            (truth.touches(pose(motion, middle)) ? inside : outside) = middle;
        }
        poses.push_back(inside);
        poses.push_back(outside);
        if (poses.size() >= count) break;
        free.reset();
        hit.reset();
    }
    return poses;
}
