#include "bake/respond/SkinFollowMeasure.h"

#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/respond/SkinScene.h"

namespace tss {
namespace {

/// In diagonals of the bones: skin on a bone alone is nearer than the first, and farther from all others than
/// the second.
constexpr double near = 1 / 30.0, far = 1 / 9.0;
/// Edges shorter than this share of the diagonal say nothing about the skin: scans have slivers.
constexpr double shortestEdge = 1e-5;

double percentile(const std::vector<double>& values, double share) {
    return valueAt(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

} // namespace

void SkinFollowing::worsen(const SkinFollowing& other) {
    bones.resize(std::max(bones.size(), other.bones.size()));
    for (std::size_t m = 0; m < other.bones.size(); ++m) {
        bones[m].vertices = other.bones[m].vertices;
        bones[m].mean = std::max(bones[m].mean, other.bones[m].mean);
        bones[m].most = std::max(bones[m].most, other.bones[m].most);
    }
    shortest = std::min(shortest, other.shortest);
    longest = std::max(longest, other.longest);
    turnedOver = std::max(turnedOver, other.turnedOver);
}

SkinFollowMeasure::SkinFollowMeasure(const TriangleMesh& skin,
                                     const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                                     const SkinRig& rig)
    : skin_(skin), rig_(rig), alone_(bodies.size()) {
    Eigen::AlignedBox3d box;
    std::vector<std::pair<int, ClosestPointQuery>> bones;
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        const TriangleMesh& surface = bodies[m]->muscle().surface;
        if (!bodies[m]->rigid() || surface.empty()) continue;
        box.extend(bounds(surface));
        bones.emplace_back(static_cast<int>(m), surface);
    }
    if (bones.empty()) return;
    size_ = box.diagonal().norm();
    std::vector<int> on(skin.vertices.size(), -1); // the bone that a vertex lies on alone
    parallelFor(on.size(), [&](std::size_t v) {
        int around = 0;
        for (const auto& [bone, locator] : bones) {
            const NearestPoint point = locator.nearest(skin.vertices[v], far * size_);
            around += point.triangle >= 0;
            if (point.triangle >= 0 && point.distance < near * size_) on[v] = bone;
        }
        if (around > 1) on[v] = -1;
    });
    for (std::uint32_t v = 0; v < on.size(); ++v)
        if (on[v] >= 0) alone_[on[v]].push_back(v);
}

SkinFollowing SkinFollowMeasure::at(std::span<const Vec3> positions, std::span<const Pose> poses) const {
    std::vector<Pose> all(poses.begin(), poses.end());
    all.resize(rig_.bodies.size(), Pose::Identity());
    std::vector<Vec3> now = skin_.vertices;
    for (std::size_t k = 0; k < positions.size(); ++k) now[rig_.vertices[k]] = positions[k];
    SkinFollowing result;
    result.bones.resize(alone_.size());
    for (std::size_t m = 0; m < alone_.size(); ++m) {
        if (alone_[m].empty()) continue;
        SkinFollowing::OnBone& bone = result.bones[m];
        std::vector<double> off;
        for (const std::uint32_t v : alone_[m]) {
            off.push_back(1000 * (now[v] - all[m] * skin_.vertices[v]).norm() / size_);
            bone.mean += off.back();
        }
        bone.vertices = off.size();
        bone.mean /= static_cast<double>(off.size());
        bone.most = percentile(off, 0.95);
    }
    std::vector<double> edges;
    const double least = shortestEdge * diagonal(skin_);
    for (const Tri& t : skin_.triangles)
        for (int k = 0; k < 3; ++k) {
            const int i = t[k], j = t[(k + 1) % 3];
            const double rest = (skin_.vertices[i] - skin_.vertices[j]).norm();
            if (rest > least) edges.push_back((now[i] - now[j]).norm() / rest);
        }
    if (!edges.empty()) {
        result.shortest = percentile(edges, 0.01);
        result.longest = percentile(edges, 0.99);
    }
    SkinScene scene;
    placeBodies(rig_, std::vector<double>(all.size(), 0), all, {}, scene);
    for (const Tri& t : rig_.triangles) {
        const auto normal = [&](const auto& x) -> Vec3 {
            return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
        };
        result.turnedOver +=
            normal(positions).dot(turnOf(rig_, scene, t[0]).cast<double>() * normal(rig_.rest)) < 0;
    }
    return result;
}

} // namespace tss
