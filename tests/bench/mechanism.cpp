// All pairs of a mechanism as one question: how long it takes beside FCL on the same pairs in the same
// process, and whether any contact is missed; and how it is kept out of itself (METHOD 5).
#include "bake/model/Kinematics.h"
#include "bake/play/JointPlan.h"
#include "bake/play/MechanismQuery.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/PreparedTable.h"
#include "bake/table/TablePairs.h"
#include "tests/bench/MechanismJudge.h"
#ifdef OSGTSS_VAMP
#include "tests/bench/VampPanda.h"
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <random>

using namespace tss;
using compare::MeshTruth;
using namespace mechanism;

namespace {

using Answer = MechanismAnswer::Verdict;

/// Contacts that FCL sees and the question does not: at random configurations, and where a pair of bodies
/// just touches by FCL on the way from a configuration without contact to one with it.
void countMissed(const SceneModel& scene, const Judge& judge, std::size_t configurations, std::size_t near) {
    const MechanismQuery query(judged(scene, judge));
    MechanismWorkspace ws = query.workspace();
    Configurations draw(scene);
    std::vector<double> q(draw.values()), other(q), middle(q);
    std::size_t missed = 0, touching = 0;
    for (std::size_t i = 1; i <= configurations; ++i) {
        draw.next(q.data());
        if (query.ask(q.data(), ws).verdict == Answer::Contact) {
            ++touching;
        } else if (const Pair* pair = judge.touching(posedBodies(scene, q))) {
            ++missed;
            fmt::print("missed: {}\n", pair->path);
        }
        if (i % 10000 == 0 || i == configurations) {
            fmt::print("{} random configurations, {} touch: {} contacts missed\n", i, touching, missed);
            std::fflush(stdout);
        }
    }
    missed = 0;
    std::map<std::string, std::size_t> made;
    for (std::size_t i = 0; i < near;) {
        MechanismAnswer answer;
        const auto drawn = [&](Answer wanted, std::vector<double>& values) {
            for (int draws = 0; draws < 1000000; ++draws) {
                draw.next(values.data());
                if ((answer = query.ask(values.data(), ws)).verdict == wanted) return true;
            }
            return false;
        };
        if (!drawn(Answer::Free, q) || !drawn(Answer::Contact, other)) {
            fmt::print("of a million configurations none is free, or none touches: none looked for that just "
                       "touch\n");
            break;
        }
        const auto& [pair, truth] = judge.truths[static_cast<std::size_t>(answer.pair)];
        const auto meets = [&](const std::vector<double>& at) {
            const std::vector<Pose> placed = posedBodies(scene, at);
            return truth->touches(placed[pair->bodyA].inverse(Eigen::Isometry) * placed[pair->bodyB]);
        };
        if (meets(q) || !meets(other)) continue;
        for (int halving = 0; halving < 16; ++halving) {
            for (std::size_t k = 0; k < q.size(); ++k) middle[k] = 0.5 * (q[k] + other[k]);
            (meets(middle) ? other : q) = middle;
        }
        missed += query.ask(other.data(), ws).verdict != Answer::Contact;
        ++made[pair->path];
        if (++i % 10000 == 0 || i == near) {
            fmt::print("{} configurations that just touch: {} contacts missed\n", i, missed);
            std::fflush(stdout);
        }
    }
    for (const auto& [path, count] : made) fmt::print("  {}: {}\n", path, count);
}

/// The tables of a scene, asked apart from whatever else there is: exact gaps in double of all tests that may
/// be near.
class ExactTables {
public:
    explicit ExactTables(const SceneModel& scene) {
        const std::vector<std::size_t> first = firstValues(scene);
        for (const Pair& pair : scene.pairs) {
            if (!pair.table) continue;
            Asked asked{&*pair.table, std::make_unique<PreparedTable>(*pair.table), {}};
            for (const JointDof& dof : pairDofs(scene, pair))
                asked.values.push_back(first[dof.joint] + dof.dof);
            tables_.push_back(std::move(asked));
        }
    }
    /// Smallest gap of all tests, `far` where none is less.
    double gap(const std::vector<double>& q, double far) {
        double least = far;
        for (const Asked& asked : tables_) {
            std::vector<double> own;
            for (const std::size_t value : asked.values) own.push_back(q[value]);
            found_.resize(std::max(found_.size(), asked.table->testRoom()));
            const std::uint32_t count = asked.table->testsWithin(own.data(), far, found_.data());
            if (count == 0) continue;
            const Pose at = pose(asked.of->motion, own);
            for (std::uint32_t i = 0; i < count; ++i) {
                const TablePair& pair = asked.table->pair(found_[i]);
                least = std::min(least, centreDistance(pair, at) - pair.contactDistance);
            }
        }
        return least;
    }

private:
    struct Asked {
        const Table* of;
        std::unique_ptr<PreparedTable> table;
        std::vector<std::size_t> values;
    };
    std::vector<Asked> tables_;
    std::vector<std::uint32_t> found_;
};

/// What a kind of step took.
void printTimes(const char* what, std::vector<double>& times) {
    if (times.empty()) return;
    std::sort(times.begin(), times.end());
    const std::size_t n = times.size();
    fmt::print("  {}: {} steps, median {:.1f} us, 95 % below {:.1f} us, worst {:.1f} us\n", what, n,
               times[n / 2], times[n * 19 / 20], times[n - 1]);
}

/// A mechanism that is driven into itself: towards one configuration after another where meshes meet by FCL,
/// until it has been held for a while, by steps in which no value goes farther than `most` (0: by a fiftieth
/// of what is left), now and then a jump. Whether it is ever in contact the tables say, and at every
/// hundredth step FCL.
void drive(const SceneModel& scene, const Judge& judge, std::size_t steps, double most) {
    std::vector<std::string> paths, warnings;
    for (const Pair& pair : scene.pairs) paths.push_back(pair.path);
    const auto start = std::chrono::steady_clock::now();
    const auto plan = makeJointPlan(scene, paths, &warnings);
    const std::chrono::duration<double> prepared = std::chrono::steady_clock::now() - start;
    for (const std::string& warning : warnings) fmt::print("{}\n", warning);
    fmt::print("response: {} values, prepared in {:.2f} s\n", plan->valueCount, prepared.count());
    std::vector<JointWorkspace> rooms = workspaces(*plan);
    ExactTables exact(scene);
    std::vector<std::size_t> place; // of the plan's values among all
    for (const int joint : plan->joints) {
        std::size_t first = 0;
        for (int k = 0; k < joint; ++k) first += scene.joints[k].dofs.size();
        for (std::size_t k = 0; k < scene.joints[joint].dofs.size(); ++k) place.push_back(first + k);
    }
    Configurations draw(scene);
    std::vector<double> all(draw.values()), hand(draw.values()), q(place.size()), asked(place.size());
    do draw.next(all.data());
    while (exact.gap(all, 1e-4) <= 0);
    for (std::size_t k = 0; k < place.size(); ++k) q[k] = all[place[k]];
    std::vector<std::vector<double>> times(6);
    std::vector<double> jumps;
    std::size_t through = 0, met = 0, since = 0, held = 0;
    double least = 1;
    for (std::size_t i = 0; i < steps; ++i) {
        if (i == 0 || ++since > 1500 || held > 100) {
            do draw.next(hand.data());
            while (!judge.touching(posedBodies(scene, hand)));
            since = held = 0;
        }
        const bool jump = since == 1000;
        double farthest = 0;
        for (std::size_t k = 0; k < place.size(); ++k)
            farthest = std::max(farthest, std::abs(hand[place[k]] - q[k]));
        const double share = jump ? 1 : most == 0 ? 0.02 : farthest > most ? most / farthest : 1;
        for (std::size_t k = 0; k < place.size(); ++k) asked[k] = q[k] + share * (hand[place[k]] - q[k]);
        JointStatus worst = JointStatus::Free;
        const double before = processMicroseconds();
        for (const GroupAnswer& answer : resolve(*plan, q, asked, rooms))
            worst = std::max(worst, answer.status);
        const double spent = processMicroseconds() - before;
        (jump ? jumps : times[static_cast<std::size_t>(worst)]).push_back(spent);
        held += worst != JointStatus::Free;
        q = asked;
        for (std::size_t k = 0; k < place.size(); ++k) all[place[k]] = q[k];
        const double gap = exact.gap(all, 1e-4);
        least = std::min(least, gap);
        through += gap <= 0;
        if (i % 100 == 0) met += judge.touching(posedBodies(scene, all)) != nullptr;
    }
    fmt::print("{} steps{}: least gap {:.3g}, {} end in contact; by FCL {} of {}\n", steps,
               most > 0 ? fmt::format(" of at most {} a value", most) : " of a fiftieth", least, through, met,
               (steps + 99) / 100);
    for (std::size_t k = 0; k < times.size(); ++k) printTimes(name(static_cast<JointStatus>(k)), times[k]);
    printTimes("jumps", jumps);
}

/// What a configuration costs, alone and among many, and FCL on the same; which pairs are named how often.
void timeAnswers(const SceneModel& scene, const Judge& judge, const MechanismQuery& query) {
    MechanismWorkspace ws = query.workspace();
    Configurations draw(scene);
    const std::size_t n = draw.values(), timed = 20000;
    std::vector<double> values(timed * n);
    for (std::size_t i = 0; i < timed; ++i) draw.next(&values[i * n]);
    std::vector<MechanismAnswer> one(timed);
    std::vector<MechanismAnswer> many(timed);
    const std::vector<double> took = time(timed, 15,
                                          {[&] {
                                               for (std::size_t i = 0; i < timed; ++i)
                                                   one[i] = query.ask(&values[i * n], ws);
                                           },
                                           [&] { query.ask(values.data(), timed, many.data(), ws); }});
    const auto touching = std::count_if(one.begin(), one.end(), [](const MechanismAnswer& answer) {
        return answer.verdict == Answer::Contact;
    });
    std::size_t differ = 0;
    for (std::size_t i = 0; i < timed; ++i) differ += one[i].verdict != many[i].verdict;
    fmt::print(
        "a configuration of all of it: {:.0f} ns, of many at once {:.0f} ns ({:.2f} times as quick, {} "
        "differ); {} of {} touch\n",
        took[0], took[1], took[0] / took[1], differ, touching, timed);
    for (int k = 0; k < static_cast<int>(scene.pairs.size()); ++k) {
        if (!scene.pairs[k].table) continue;
        const auto named = std::count_if(one.begin(), one.end(),
                                         [&](const MechanismAnswer& answer) { return answer.pair == k; });
        const Table& table = *scene.pairs[k].table;
        fmt::print("  {}: {} DOFs, {} tests, early {:.4g}, names {}\n", scene.pairs[k].path,
                   table.motion.dofCount(), table.testCount(), table.boundEarly.value_or(-1), named);
    }
    const std::size_t slow = std::min<std::size_t>(timed, 2000);
    std::size_t met = 0;
    const auto askFcl = [&] {
        met = 0;
        for (std::size_t i = 0; i < slow; ++i)
            met += judge.touching(posedBodies(scene, {&values[i * n], n})) != nullptr;
    };
    const double fcl = time(slow, 3, {askFcl})[0];
    fmt::print("FCL on {} pairs ({} left out that overlap at rest): {:.0f} ns, {} of {} touch\n",
               judge.truths.size(), judge.left, fcl, met, slow);
}

#ifdef OSGTSS_VAMP
/// VAMP's Panda on the same configurations: how long it takes, and what FCL says of either's answers. Only
/// the pairs that FCL can judge are asked here.
void compareVamp(const SceneModel& scene, const Judge& judge, std::size_t configurations) {
    Configurations draw(scene);
    if (draw.values() != 7 || scene.defaultPrim.find("panda") == scene.defaultPrim.npos)
        return fmt::print("not beside VAMP's Panda: this is none of 7 values\n");
    const MechanismQuery query(judged(scene, judge));
    MechanismWorkspace ws = query.workspace();
    std::vector<double> values(configurations * 7);
    for (std::size_t i = 0; i < configurations; ++i) draw.next(&values[i * 7]);
    std::vector<char> theirs(configurations), ours(configurations);
    const std::vector<double> alone =
        time(configurations, 5,
             {[&] {
                  for (std::size_t i = 0; i < configurations; ++i)
                      theirs[i] = vamp_panda::touches(&values[i * 7]);
              },
              [&] {
                  for (std::size_t i = 0; i < configurations; ++i)
                      ours[i] = query.ask(&values[i * 7], ws).verdict == Answer::Contact;
              }});
    std::vector<double> open; // of both: VAMP's lanes stop together at the first that touches
    for (std::size_t i = 0; i < configurations; ++i)
        if (!theirs[i] && !ours[i]) open.insert(open.end(), &values[i * 7], &values[i * 7] + 7);
    std::vector<vamp_panda::Eight> eights(open.size() / 56);
    for (std::size_t i = 0; i < eights.size() * 8; ++i)
        for (std::size_t k = 0; k < 7; ++k)
            eights[i / 8].joints[k][i % 8] = static_cast<float>(open[i * 7 + k]);
    std::vector<MechanismAnswer> many(eights.size() * 8);
    std::size_t touched = 0;
    const std::vector<double> lanes = time(many.size(), 5,
                                           {[&] {
                                                for (const vamp_panda::Eight& eight : eights)
                                                    touched += vamp_panda::anyTouches(eight);
                                            },
                                            [&] { query.ask(open.data(), many.size(), many.data(), ws); }});
    std::size_t meets = 0, missed = 0, early = 0, oursMissed = 0, oursEarly = 0;
    for (std::size_t i = 0; i < configurations; ++i) {
        const bool met = judge.touching(posedBodies(scene, {&values[i * 7], 7})) != nullptr;
        meets += met;
        (met ? missed : early) += met != bool(theirs[i]);
        (met ? oursMissed : oursEarly) += met != bool(ours[i]);
    }
    fmt::print(
        "VAMP {:.0f} ns a configuration, here {:.0f} ns; of {} free by both side by side {:.0f} ns ({} "
        "touch there), here {:.0f} ns\n"
        "of {}, {} touch by FCL: VAMP misses {} and is early {} times, here {} and {}\n",
        alone[0], alone[1], many.size(), lanes[0], touched, lanes[1], configurations, meets, missed, early,
        oursMissed, oursEarly);
}
#endif

} // namespace

int main(int argc, char** argv) {
    if (argc < 2)
        return std::fputs(
                   "usage: bench_mechanism BAKED.tss [CONFIGURATIONS [NEAR [STEPS [MOST]]]]\n"
                   "  CONFIGURATIONS at random and NEAR contact, asked of FCL as well; STEPS of the "
                   "response,\n"
                   "  each of at most MOST a value (radians, scene units; 0: a fiftieth of what is left)\n",
                   stderr),
               2;
    const std::size_t configurations = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 10000;
    const std::size_t near = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0;
    const std::size_t steps = argc > 4 ? std::strtoul(argv[4], nullptr, 10) : 0;
    const double most = argc > 5 ? std::strtod(argv[5], nullptr) : 0.002;
    const SceneModel scene = loadScene(argv[1]);
    const Judge judge(scene);
    if (steps > 0) drive(scene, judge, steps, most);
    if (steps > 0 && configurations == 0 && near == 0) return 0;
    const auto start = std::chrono::steady_clock::now();
    const MechanismQuery query(scene);
    const std::chrono::duration<double> prepared = std::chrono::steady_clock::now() - start;
    fmt::print("{} pairs, {} of them without table and proof; prepared in {:.2f} s\n", scene.pairs.size(),
               query.unanswered().size(), prepared.count());

    timeAnswers(scene, judge, query);
#ifdef OSGTSS_VAMP
    compareVamp(scene, judge, configurations);
#endif
    countMissed(scene, judge, configurations, near);
}
