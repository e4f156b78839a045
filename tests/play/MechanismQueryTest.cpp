#include "bake/play/MechanismQuery.h"
#include "bake/base/Error.h"
#include "bake/table/PreparedTable.h"
#include "tests/play/Mechanisms.h"
#include "tests/table/ExactGap.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;
using namespace mechanisms;
using Answer = MechanismAnswer::Verdict;

namespace {

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

namespace {

JointDof dofAt(const SceneModel& scene, std::size_t value) {
    for (int joint = 0; joint < static_cast<int>(scene.joints.size()); ++joint) {
        const std::size_t count = scene.joints[joint].dofs.size();
        if (value < count) return {joint, value};
        value -= count;
    }
    return {};
}

} // namespace

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
            const std::size_t k = random() % values.size();
            const JointDof dof = dofAt(scene, k);
            const Dof& limits = scene.joints[dof.joint].dofs[dof.dof];
            // Far out, or by a hair that is more than floats round.
            values[k] = i % 2
                            ? out[random() % 3]
                            : limits.upper + 4e-7 * std::max(std::abs(limits.lower), std::abs(limits.upper));
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

TEST_CASE("many configurations at once get the verdicts that they get one by one") {
    long contacts = 0, beyond = 0, free = 0, placed = 0;
    for (std::uint64_t seed = 90; seed < 102; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const SceneModel scene = anyMechanism(random, 3 + int(seed % 5), seed % 2);
        const Singles singles(scene);
        for (const auto& [pair, table] : singles.tables) placed += table.dofCount() > 3;
        const MechanismQuery query(scene);
        MechanismWorkspace ws = query.workspace();
        for (const std::size_t count : {0, 1, 7, 15, 16, 17, 250}) {
            std::vector<double> values;
            for (std::size_t i = 0; i < count; ++i) {
                std::vector<double> one = anyValues(random, scene);
                if (i % 20 == 7) one[random() % one.size()] = 5; // beyond
                values.insert(values.end(), one.begin(), one.end());
            }
            std::vector<MechanismAnswer> answers(count + 1, {Answer::Beyond, 77});
            query.ask(values.data(), count, answers.data(), ws);
            REQUIRE(answers[count].pair == 77); // untouched
            for (std::size_t i = 0; i < count; ++i) {
                const double* at = values.data() + i * query.valueCount();
                const std::vector<double> own(at, at + query.valueCount());
                if (answers[i].verdict != query.ask(at, ws).verdict) REQUIRE(singles.atTheBand(own));
                if (answers[i].verdict == Answer::Contact) {
                    if (!singles.touches(answers[i].pair, own)) REQUIRE(singles.atTheBand(own));
                } else {
                    REQUIRE(answers[i].pair == -1);
                }
                (answers[i].verdict == Answer::Contact  ? contacts
                 : answers[i].verdict == Answer::Beyond ? beyond
                                                        : free) += 1;
            }
        }
    }
    CAPTURE(contacts, beyond, free, placed);
    CHECK(contacts > 300);
    CHECK(beyond > 30);
    CHECK(free > 300);
    CHECK(placed > 10);
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
    scene.joints[0].body1 = 1000;
    CHECK_THROWS_WITH(MechanismQuery(scene), Catch::Contains(scene.joints[0].path));
}
