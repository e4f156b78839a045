#pragma once
// What the whole mechanism's benchmark is judged by: FCL on the meshes, configurations drawn at random, a
// clock.
#include "bake/compare/MeshTruth.h"
#include "bake/model/SceneModel.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <memory>
#include <random>

namespace mechanism {

using namespace tss;
using compare::MeshTruth;

/// Of this process alone, whatever else the machine does.
inline double processMicroseconds() {
    std::timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// Nanoseconds of the processor an item, of each the least of some rounds, in turns.
inline std::vector<double> time(std::size_t items, int rounds,
                                const std::vector<std::function<void()>>& works) {
    std::vector<double> least(works.size(), 1e300);
    for (int round = 0; round < rounds; ++round)
        for (std::size_t k = 0; k < works.size(); ++k) {
            const double start = processMicroseconds();
            works[k]();
            const double spent = 1e3 * (processMicroseconds() - start);
            least[k] = std::min(least[k], spent / static_cast<double>(items));
        }
    return least;
}

/// The meshes of all pairs that can be judged by them: not those that overlap at rest, where contact counts
/// from.
struct Judge {
    explicit Judge(const SceneModel& scene) : scene(scene) {
        for (const Pair& pair : scene.pairs) {
            const RestRegion* region = pair.table   ? &pair.table->restRegion
                                       : pair.proof ? &pair.proof->restRegion
                                                    : nullptr;
            if (!region) continue;
            if (region->depth > 0) {
                ++left;
                continue;
            }
            truths.push_back({&pair, std::make_unique<MeshTruth>(scene.bodies[pair.bodyA].mesh,
                                                                 scene.bodies[pair.bodyB].mesh)});
        }
    }
    const Pair* touching(const std::vector<Pose>& placed) const {
        for (const auto& [pair, truth] : truths)
            if (truth->touches(placed[pair->bodyA].inverse(Eigen::Isometry) * placed[pair->bodyB]))
                return pair;
        return nullptr;
    }
    const SceneModel& scene;
    std::vector<std::pair<const Pair*, std::unique_ptr<MeshTruth>>> truths;
    std::size_t left = 0;
};

class Configurations {
public:
    explicit Configurations(const SceneModel& scene) : random_(1) {
        for (const Joint& joint : scene.joints)
            for (const Dof& dof : joint.dofs) limits_.emplace_back(dof.lower, dof.upper);
    }
    std::size_t values() const { return limits_.size(); }
    void next(double* out) {
        for (const auto& [lower, upper] : limits_)
            *out++ = std::uniform_real_distribution<double>(lower, upper)(random_);
    }

private:
    std::mt19937_64 random_;
    std::vector<std::pair<double, double>> limits_;
};

/// The scene with those pairs alone that FCL can judge: else the others, which touch at every second
/// configuration of some arms, would hide what these miss.
inline SceneModel judged(const SceneModel& scene, const Judge& judge) {
    SceneModel part = scene;
    part.pairs.clear();
    for (const auto& [pair, truth] : judge.truths) part.pairs.push_back(*pair);
    return part;
}

} // namespace mechanism
