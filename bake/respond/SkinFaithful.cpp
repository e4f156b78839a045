#include "bake/respond/SkinFaithful.h"

#include "bake/motion/PoseBlend.h"

#include <algorithm>

namespace tss {
namespace {

constexpr int pushRounds = 8; ///< spheres that one vertex leaves in an update, at most

/// What a sphere moves with: its body, of a muscle between two bones the blend of both.
Pose poseOf(const SkinSpheres& spheres, std::span<const Pose> poses, std::size_t s) {
    const std::uint32_t m = spheres.body[s];
    if (spheres.insertion[m] < 0) return poses[m];
    return blendBetween(poses[m], poses[static_cast<std::size_t>(spheres.insertion[m])], spheres.share[s],
                        spheres.side[m]);
}

} // namespace

SkinSpheres skinSpheres(const SkinTable& table,
                        const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                        std::span<const int> insertions, const std::vector<std::uint32_t>& indexOf) {
    SkinSpheres spheres;
    spheres.insertion.assign(bodies.size(), -1);
    std::copy(insertions.begin(), insertions.end(), spheres.insertion.begin());
    const Table& t = table.table;
    std::vector<std::vector<MusclePoint>> points(bodies.size());
    for (std::size_t b = 0; b < t.b.size(); ++b) {
        auto& own = points[table.muscleOf[b]];
        spheres.body.push_back(table.muscleOf[b]);
        spheres.at.push_back(static_cast<std::uint32_t>(own.size()));
        spheres.radius.push_back(t.b[b].radius);
        own.push_back(bodies[table.muscleOf[b]]->bind(t.b[b].centre));
        spheres.share.push_back(own.back().share);
    }
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        const Muscle& muscle = bodies[m]->muscle();
        spheres.side.push_back(muscle.side);
        spheres.tracks.push_back(makeTrack(*bodies[m], points[m],
                                           activationNodes(muscle.activationLower, muscle.activationUpper)));
    }
    for (std::size_t i = 0; i < t.a.size(); ++i)
        spheres.rows.push_back(
            {indexOf[table.skinVertices[i]], t.rowOffsets[i], t.rowOffsets[i + 1], t.a[i].radius});
    spheres.sphere = t.columns;
    spheres.restGap = t.restGaps;
    spheres.restGap.resize(t.columns.size(), 0);
    return spheres;
}

std::size_t pushOut(const SkinSpheres& spheres, std::span<const double> activations,
                    std::span<const Pose> poses, std::span<const Vec3> normals, std::span<Vec3> places) {
    std::vector<Sphere> now;
    for (std::size_t s = 0; s < spheres.body.size(); ++s) {
        const MuscleTrack& track = spheres.tracks[spheres.body[s]];
        const TrackPlace at = locate(track.nodes, activations[spheres.body[s]]);
        now.push_back({poseOf(spheres, poses, s) * trackPosition(track, at, spheres.at[s]),
                       spheres.radius[s] * trackThickness(track, at, spheres.at[s])});
    }
    std::size_t pushed = 0;
    for (const SkinSpheres::Row& row : spheres.rows) {
        Vec3 x = places[row.vertex];
        for (int round = 0; round < pushRounds; ++round) {
            double deepest = 0;
            Vec3 push = Vec3::Zero();
            for (std::uint32_t k = row.first; k < row.last; ++k) {
                const Sphere& sphere = now[spheres.sphere[k]];
                const Vec3 away = x - sphere.centre;
                const double distance = away.norm(),
                             depth = sphere.radius + row.radius + spheres.restGap[k] - distance;
                if (depth <= deepest) continue;
                deepest = depth;
                push = distance > 0 ? Vec3(depth / distance * away) : Vec3(depth * normals[row.vertex]);
            }
            if (deepest <= 0) break;
            x += push;
        }
        pushed += x != places[row.vertex];
        places[row.vertex] = x;
    }
    return pushed;
}

} // namespace tss
