#include "bake/compare/PushedSkin.h"

#include "bake/motion/BoneChain.h"
#include "bake/motion/ClosestPointQuery.h"

#include <algorithm>

namespace tss::compare {

namespace {

constexpr int pushRounds = 8; ///< spheres that one vertex leaves in an update, at most

} // namespace

PushedSkin::PushedSkin(const TriangleMesh& skin, const SkinTable& table,
                       const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                       std::vector<std::vector<int>> chains)
    : skin_(skin), table_(table), chains_(std::move(chains)), activations_(bodies.size(), 0),
      normals_(vertexNormals(skin)), places_(skin.vertices) {
    chains_.resize(bodies.size());
    std::vector<std::vector<MusclePoint>> points(bodies.size());
    for (std::size_t s = 0; s < table.muscleOf.size(); ++s) {
        const std::uint32_t m = table.muscleOf[s];
        at_.push_back(static_cast<std::uint32_t>(points[m].size()));
        points[m].push_back(bodies[m]->bind(table.table.b[s].centre));
        shares_.push_back(points[m].back().share);
    }
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        const Muscle& muscle = bodies[m]->muscle();
        sides_.push_back(muscle.sides);
        tracks_.push_back(makeTrack(*bodies[m], points[m],
                                    activationNodes(muscle.activationLower, muscle.activationUpper)));
    }
}

/// The spheres of muscles and bones where these are now; of a muscle over several each goes with two.
SphereSet PushedSkin::spheresBelow() const {
    SphereSet now;
    std::vector<ChainBlend> blends; // of each body
    for (std::size_t m = 0; m < poses_.size(); ++m)
        blends.emplace_back(chainMotion(poses_, m, chains_[m]), sides_[m]);
    for (std::size_t s = 0; s < at_.size(); ++s) {
        const std::uint32_t m = table_.muscleOf[s];
        const TrackPlace place = locate(tracks_[m].nodes, activations_[m]);
        Vec3 centre = trackPosition(tracks_[m], place, at_[s]);
        if (!poses_.empty()) centre = poses_[m] * (blends[m].at(shares_[s]) * centre);
        now.push_back({centre, table_.table.b[s].radius * trackThickness(tracks_[m], place, at_[s])});
    }
    return now;
}

bool PushedSkin::update(std::span<const double> activations, std::span<const Pose> poses) {
    const auto samePose = [](const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); };
    if (std::ranges::equal(activations, activations_) && std::ranges::equal(poses, poses_, samePose))
        return false;
    activations_.assign(activations.begin(), activations.end());
    poses_.assign(poses.begin(), poses.end());
    places_ = skin_.vertices;
    if (poses.empty() && std::ranges::all_of(activations, [](double a) { return a == 0; })) return true;
    const SphereSet below = spheresBelow();
    const Table& table = table_.table;
    for (std::size_t row = 0; row < table.a.size(); ++row) {
        const std::uint32_t vertex = table_.skinVertices[row];
        Vec3& x = places_[vertex];
        for (int round = 0; round < pushRounds; ++round) {
            double deepest = 0;
            Vec3 push = Vec3::Zero();
            for (std::uint32_t k = table.rowOffsets[row]; k < table.rowOffsets[row + 1]; ++k) {
                const Sphere& sphere = below[table.columns[k]];
                const Vec3 away = x - sphere.centre;
                const double distance = away.norm(),
                             gapAtRest = table.restGaps.empty() ? 0 : table.restGaps[k],
                             depth = sphere.radius + table.a[row].radius + gapAtRest - distance;
                if (depth <= deepest) continue;
                deepest = depth;
                push = distance > 0 ? Vec3(depth / distance * away) : Vec3(depth * normals_[vertex]);
            }
            if (deepest <= 0) break;
            x += push;
        }
    }
    return true;
}

} // namespace tss::compare
