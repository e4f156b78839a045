// All pairs of a mechanism as one question: how long it takes beside FCL on the same pairs in the same
// process, and whether any contact is missed. usage: bench_mechanism BAKED.tss [CONFIGURATIONS [NEAR]]
#include "bake/compare/MeshTruth.h"
#include "bake/model/Kinematics.h"
#include "bake/play/JointPlan.h"
#include "bake/play/MechanismQuery.h"
#include "bake/scene/SceneFile.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <random>

using namespace tss;
using compare::MeshTruth;

namespace {

using Answer = MechanismAnswer::Verdict;

/// Nanoseconds an item, the least of some rounds.
double time(std::size_t items, int rounds, const std::function<void()>& work) {
    double least = 1e300;
    for (int round = 0; round < rounds; ++round) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
        least = std::min(least, spent.count() / static_cast<double>(items));
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

/// Small steps towards one configuration after another, now and then a jump.
void drive(const SceneModel& scene, const MechanismQuery& query, std::size_t steps) {
    std::vector<std::string> paths, warnings;
    for (const Pair& pair : scene.pairs) paths.push_back(pair.path);
    const auto plan = makeJointPlan(scene, paths, &warnings);
    for (const std::string& warning : warnings) fmt::print("{}\n", warning);
    std::vector<JointWorkspace> rooms = workspaces(*plan);
    MechanismWorkspace ws = query.workspace();
    std::vector<std::size_t> place; // of the plan's values among all
    for (const int joint : plan->joints) {
        std::size_t first = 0;
        for (int k = 0; k < joint; ++k) first += scene.joints[k].dofs.size();
        for (std::size_t k = 0; k < scene.joints[joint].dofs.size(); ++k) place.push_back(first + k);
    }
    Configurations draw(scene);
    std::vector<double> all(draw.values()), hand(draw.values()), q(place.size()), asked(place.size());
    do draw.next(all.data());
    while (query.ask(all.data(), ws).verdict != Answer::Free);
    for (std::size_t k = 0; k < place.size(); ++k) q[k] = all[place[k]];
    std::vector<std::vector<double>> times(6);
    std::size_t through = 0;
    for (std::size_t i = 0; i < steps; ++i) {
        if (i % 80 == 0) draw.next(hand.data());
        const double share = i % 500 == 499 ? 1 : 0.02;
        for (std::size_t k = 0; k < place.size(); ++k) asked[k] = q[k] + share * (hand[place[k]] - q[k]);
        JointStatus worst = JointStatus::Free;
        const auto start = std::chrono::steady_clock::now();
        for (const GroupAnswer& answer : resolve(*plan, q, asked, rooms))
            worst = std::max(worst, answer.status);
        const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - start;
        times[static_cast<std::size_t>(worst)].push_back(spent.count());
        q = asked;
        for (std::size_t k = 0; k < place.size(); ++k) all[place[k]] = q[k];
        through += query.ask(all.data(), ws).verdict == Answer::Contact;
    }
    fmt::print("{} steps, {} end in contact\n", steps, through);
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (times[k].empty()) continue;
        std::sort(times[k].begin(), times[k].end());
        fmt::print("  {}: {} steps, median {:.1f} us, 95 % below {:.1f} us\n",
                   name(static_cast<JointStatus>(k)), times[k].size(), times[k][times[k].size() / 2],
                   times[k][times[k].size() * 19 / 20]);
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2)
        return std::fputs("usage: bench_mechanism BAKED.tss [CONFIGURATIONS [NEAR [STEPS]]]\n", stderr), 2;
    const std::size_t configurations = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 10000;
    const std::size_t near = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0;
    const std::size_t steps = argc > 4 ? std::strtoul(argv[4], nullptr, 10) : 0;
    const SceneModel scene = loadScene(argv[1]);
    const auto start = std::chrono::steady_clock::now();
    const MechanismQuery query(scene);
    const std::chrono::duration<double> prepared = std::chrono::steady_clock::now() - start;
    MechanismWorkspace ws = query.workspace();
    fmt::print("{} tables, {} proofs, {} pairs without; prepared in {:.2f} s\n", query.order().size(),
               query.provenCount(), query.unanswered().size(), prepared.count());

    Configurations draw(scene);
    const std::size_t n = draw.values(), timed = 20000;
    std::vector<double> values(timed * n);
    for (std::size_t i = 0; i < timed; ++i) draw.next(&values[i * n]);
    std::vector<MechanismAnswer> one(timed);
    const double asked = time(timed, 7, [&] {
        for (std::size_t i = 0; i < timed; ++i) one[i] = query.ask(&values[i * n], ws);
    });
    const auto touching = std::count_if(one.begin(), one.end(), [](const MechanismAnswer& answer) {
        return answer.verdict == Answer::Contact;
    });
    fmt::print("a configuration of all of it: {:.0f} ns; {} of {} touch\n", asked, touching, timed);
    for (const int k : query.order()) {
        const auto named = std::count_if(one.begin(), one.end(),
                                         [&](const MechanismAnswer& answer) { return answer.pair == k; });
        const Table& table = *scene.pairs[k].table;
        fmt::print("  {}: {} DOFs, {} tests, early {:.4g}, names {}\n", scene.pairs[k].path,
                   table.motion.dofCount(), table.testCount(), table.boundEarly, named);
    }
    const Judge judge(scene);
    const std::size_t slow = std::min<std::size_t>(timed, 2000);
    std::size_t met = 0;
    const double fcl = time(slow, 3, [&] {
        met = 0;
        for (std::size_t i = 0; i < slow; ++i)
            met += judge.touching(posedBodies(scene, {&values[i * n], n})) != nullptr;
    });
    fmt::print("FCL on {} pairs ({} left out that overlap at rest): {:.0f} ns, {} of {} touch\n",
               judge.truths.size(), judge.left, fcl, met, slow);

    std::size_t missed = 0;
    const auto check = [&](const std::vector<double>& q) {
        if (query.ask(q.data(), ws).verdict == Answer::Contact) return;
        if (const Pair* pair = judge.touching(posedBodies(scene, q))) {
            ++missed;
            fmt::print("missed: {}\n", pair->path);
        }
    };
    std::vector<double> q(n), other(n);
    for (std::size_t i = 0; i < configurations; ++i) {
        draw.next(q.data());
        check(q);
    }
    fmt::print("{} random configurations: {} contacts missed\n", configurations, missed);
    missed = 0;
    // Where contact begins by FCL, on the way from a free configuration to one that touches.
    std::size_t made = 0;
    while (made < near) {
        draw.next(q.data());
        if (judge.touching(posedBodies(scene, q))) continue;
        draw.next(other.data());
        if (!judge.touching(posedBodies(scene, other))) continue;
        std::vector<double> middle(n);
        for (int halving = 0; halving < 14; ++halving) {
            for (std::size_t k = 0; k < n; ++k) middle[k] = 0.5 * (q[k] + other[k]);
            (judge.touching(posedBodies(scene, middle)) ? other : q) = middle;
        }
        check(other);
        ++made;
    }
    if (near > 0) fmt::print("{} configurations that just touch: {} contacts missed\n", made, missed);
    if (steps > 0) drive(scene, query, steps);
}
