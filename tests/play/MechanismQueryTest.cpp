#include "bake/play/MechanismQuery.h"
#include "bake/base/Error.h"
#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"
#include "bake/model/PairDofs.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;
using random_table::between;
using random_table::Random;
using Answer = MechanismAnswer::Verdict;

namespace {

Pose anyPose(Random& random, double size) {
    Pose pose = Pose::Identity();
    pose.linear() =
        Eigen::AngleAxisd(between(random, 0, 3), random_table::direction(random)).toRotationMatrix();
    pose.translation() = random_table::inBall(random, size);
    return pose;
}

Joint anyJoint(Random& random, int body0, int body1, int dofs) {
    Joint joint;
    joint.path = "/Scene/Joint" + std::to_string(body1);
    joint.body0 = body0;
    joint.body1 = body1;
    joint.frame0 = anyPose(random, 0.5);
    joint.frame1 = anyPose(random, 0.5);
    for (int k = 0; k < dofs; ++k) {
        Dof dof;
        dof.name = "dof" + std::to_string(k);
        dof.axis = Vec3::Unit(int(random() % 3));
        dof.kind = random() % 4 ? DofKind::Rotation : DofKind::Translation;
        dof.lower = -between(random, 0.1, 1);
        dof.upper = between(random, 0.1, 1);
        joint.dofs.push_back(dof);
    }
    joint.drives.resize(joint.dofs.size());
    if (dofs > 1 && random() % 2)
        joint.planes = {{std::vector<double>(joint.dofs.size(), 1.0), between(random, 0.3, 2)}};
    return joint;
}

/// So many that the tests are asked in clusters.
bool many(const Motion& motion) {
    return motion.dofCount() > 3;
}

/// Bodies on one another as a tree whose joints are crossed either way, and a table or a proof for all that
/// move against each other over up to seven values. chain: each on the one before.
SceneModel anyMechanism(Random& random, int bodies, bool chain) {
    SceneModel scene;
    scene.bodies.resize(std::size_t(bodies));
    for (int k = 0; k < bodies; ++k) scene.bodies[k].path = "/Scene/Body" + std::to_string(k);
    if (random() % 2) scene.joints.push_back(anyJoint(random, -1, 0, 1)); // on rails in the world
    for (int k = 1; k < bodies; ++k) {
        const int parent = chain ? k - 1 : int(random() % std::uint64_t(k));
        const bool backwards = random() % 3 == 0;
        Joint joint = anyJoint(random, parent, k, int(random() % 8 ? 1 + random() % 2 : 0));
        if (backwards) std::swap(joint.body0, joint.body1);
        scene.joints.push_back(joint);
    }
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b) {
            Pair pair;
            pair.path = "/Scene/Pair" + std::to_string(a) + "_" + std::to_string(b);
            pair.bodyA = a;
            pair.bodyB = b;
            pair.joints = findChain(scene.joints, a, b).value();
            const Motion motion = pairMotion(scene, pair);
            if (motion.dofCount() == 0 || motion.dofCount() > 7) continue;
            if (random() % 6 == 0) {
                pair.proof = std::make_shared<NeverCollides>();
            } else {
                Table table = random_table::table(random, motion, 10, many(motion) ? 30 : 8, 1);
                for (SphereSet* set : {&table.a, &table.b})
                    for (Sphere& s : *set) s.radius *= 0.35;
                pair.table = std::make_shared<Table>(std::move(table));
            }
            scene.pairs.push_back(pair);
        }
    return scene;
}

std::vector<double> anyValues(Random& random, const SceneModel& scene) {
    std::vector<double> values;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) values.push_back(between(random, dof.lower, dof.upper));
    return values;
}

std::vector<double> ownValues(const SceneModel& scene, const Pair& pair, const std::vector<double>& values) {
    std::vector<double> own;
    for (const JointDof& dof : pairDofs(scene, pair)) {
        std::size_t at = dof.dof;
        for (int joint = 0; joint < dof.joint; ++joint) at += scene.joints[joint].dofs.size();
        own.push_back(values[at]);
    }
    return own;
}

/// The tables one by one.
struct Singles {
    explicit Singles(const SceneModel& scene) : scene(scene) {
        for (const Pair& pair : scene.pairs)
            if (pair.table) tables.emplace_back(&pair, PreparedTable(*pair.table));
    }
    MechanismAnswer ask(const std::vector<double>& values) const {
        bool beyond = false;
        for (const Pair& pair : scene.pairs)
            beyond = beyond || beyondLimits(pairMotion(scene, pair), ownValues(scene, pair, values));
        for (const auto& [pair, table] : tables) {
            const std::vector<double> q = ownValues(scene, *pair, values);
            if (!beyondLimits(pair->table->motion, q) && table.hit(q.data()))
                return {Answer::Contact, int(pair - scene.pairs.data())};
        }
        return {beyond ? Answer::Beyond : Answer::Free, -1};
    }
    bool touches(int index, const std::vector<double>& values) const {
        return std::any_of(tables.begin(), tables.end(), [&](const auto& one) {
            return one.first == &scene.pairs[index] &&
                   one.second.hit(ownValues(scene, *one.first, values).data());
        });
    }
    /// Some test of the table is so near to contact that rounding decides.
    bool atTheBand(const std::vector<double>& values) const {
        return std::any_of(tables.begin(), tables.end(), [&](const auto& one) {
            const auto& [pair, table] = one;
            const std::vector<double> q = ownValues(scene, *pair, values);
            const double gap = double(exact::gap(pair->table->motion, tablePairs(*pair->table), q));
            return gap > 0 && gap <= table.signBand();
        });
    }
    const SceneModel& scene;
    std::vector<std::pair<const Pair*, PreparedTable>> tables;
};

} // namespace

TEST_CASE("a mechanism touches where one of its tables says so, and names one that does") {
    long contacts = 0, free = 0, chained = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const SceneModel scene = anyMechanism(random, 3 + int(seed % 5), seed % 2);
        const Singles singles(scene);
        const MechanismQuery query(scene);
        MechanismWorkspace ws = query.workspace();
        for (const auto& [pair, table] : singles.tables) chained += table.dofCount() > 3;
        for (int i = 0; i < 300; ++i) {
            const std::vector<double> values = anyValues(random, scene);
            const MechanismAnswer answer = query.ask(values.data(), ws);
            if (answer.verdict != singles.ask(values).verdict) REQUIRE(singles.atTheBand(values));
            if (answer.verdict == Answer::Contact) {
                const Pair& pair = scene.pairs[answer.pair];
                REQUIRE(pair.table);
                if (!singles.touches(answer.pair, values)) REQUIRE(singles.atTheBand(values));
            } else {
                REQUIRE(answer.pair == -1);
            }
            (answer.verdict == Answer::Contact ? contacts : free) += 1;
        }
    }
    CAPTURE(contacts, free, chained);
    CHECK(contacts > 300);
    CHECK(free > 300);
    CHECK(chained > 10);
}

TEST_CASE("the order in which pairs are asked changes no verdict") {
    for (std::uint64_t seed = 40; seed < 46; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const SceneModel scene = anyMechanism(random, 6, seed % 2);
        const MechanismQuery query(scene);
        std::vector<int> order = query.order();
        std::reverse(order.begin(), order.end());
        const MechanismQuery reversed(scene, order);
        REQUIRE(reversed.order() == order);
        MechanismWorkspace ws = query.workspace();
        for (int i = 0; i < 777; ++i) {
            std::vector<double> values = anyValues(random, scene);
            if (i % 50 == 0) values[random() % values.size()] = 5; // beyond
            REQUIRE(query.ask(values.data(), ws).verdict == reversed.ask(values.data(), ws).verdict);
        }
    }
}

TEST_CASE("beyond the limits of some pairs the others still answer, and nothing is called free") {
    long contacts = 0, beyond = 0, free = 0;
    for (std::uint64_t seed = 60; seed < 66; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const SceneModel scene = anyMechanism(random, 5, seed % 2);
        const Singles singles(scene);
        const MechanismQuery query(scene);
        MechanismWorkspace ws = query.workspace();
        for (int i = 0; i < 100; ++i) {
            std::vector<double> values = anyValues(random, scene);
            const double out[] = {2, -2, 1e6};
            values[random() % values.size()] = out[random() % 3];
            const MechanismAnswer answer = query.ask(values.data(), ws);
            const MechanismAnswer expected = singles.ask(values);
            REQUIRE(answer.verdict == expected.verdict);
            (answer.verdict == Answer::Contact  ? contacts
             : answer.verdict == Answer::Beyond ? beyond
                                                : free) += 1;
        }
    }
    CAPTURE(contacts, beyond, free);
    CHECK(contacts > 30);
    CHECK(beyond > 30);
}

TEST_CASE("a table for other joints than the scene's is refused, a pair without one is named") {
    Random random(80);
    SceneModel scene = anyMechanism(random, 4, true);
    Pair bare = scene.pairs[0];
    bare.table.reset();
    bare.proof.reset();
    scene.pairs.push_back(bare);
    CHECK(MechanismQuery(scene).unanswered() == std::vector<int>{int(scene.pairs.size()) - 1});
    const auto tabled = std::find_if(scene.pairs.begin(), scene.pairs.end(),
                                     [](const Pair& pair) { return pair.table && pair.joints.size() > 1; });
    REQUIRE(tabled != scene.pairs.end());
    Table other = *tabled->table;
    other.motion.dofs.pop_back();
    tabled->table = std::make_shared<Table>(other);
    CHECK_THROWS_AS(MechanismQuery(scene), InputError);
    CHECK_THROWS_AS(MechanismQuery(scene, {0, 0}), InputError);
}
