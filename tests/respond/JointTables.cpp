#include "tests/respond/Walk.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace tss;
using random_table::Random;

namespace {

constexpr double pi = std::numbers::pi;

Motion along(const Vec3& axis, double lower, double upper) {
    Dof dof;
    dof.kind = DofKind::Translation;
    dof.axis = axis;
    dof.lower = lower;
    dof.upper = upper;
    Motion motion;
    motion.dofs = {dof};
    return motion;
}

Motion about(double lower, double upper) {
    Motion motion = along(Vec3::UnitZ(), lower, upper);
    motion.dofs[0].kind = DofKind::Rotation;
    return motion;
}

/// One sphere each.
Table ball(const Vec3& a, const Vec3& b, const Motion& motion, double radius = 0.5) {
    return makeTable({{a, radius}}, {{b, radius}}, {{0, 0}}, {}, motion);
}

Vec3 atAngle(double angle) {
    return 2 * Vec3(std::cos(angle), std::sin(angle), 0);
}

} // namespace

TEST_CASE("a coarse table keeps its own bodies apart by more, and none of another table's") {
    const Table exact = ball(Vec3(5, 0, 0), Vec3::Zero(), along(Vec3::UnitX(), 0, 10));
    Table coarse = ball(Vec3(0, 9, 0), Vec3::Zero(), along(Vec3::UnitY(), 0, 10));
    coarse.epsilon = 1.2;
    const JointResponder both(std::vector<TableOnJoint>{{&exact, {0}}, {&coarse, {1}}}, 2);
    JointWorkspace ws = both.workspace();
    const JointAnswer answer = both.respond(std::vector{0.0, 0.0}.data(), std::vector{9.0, 9.0}.data(), ws);
    CHECK(answer.q[0] == Approx(4).margin(1e-4));
    CHECK(answer.q[1] == Approx(8 - 1.8).margin(0.3));
    CHECK(answer.q[1] <= 8 - 1.8);
    CHECK(both.keptGap(0) < 1e-5);
    CHECK(both.keptGap(1) == Approx(1.8));
}

TEST_CASE("a coarse table on the same value does not push a joint out of an exact one by its own distance") {
    const Table exact = ball(Vec3(5, 0, 0), Vec3::Zero(), along(Vec3::UnitX(), 0, 10));
    Table coarse = ball(Vec3(20, 0, 0), Vec3::Zero(), along(Vec3::UnitX(), 0, 10));
    coarse.epsilon = 1.2;
    const JointResponder both(std::vector<TableOnJoint>{{&exact, {0}}, {&coarse, {0}}}, 1);
    JointWorkspace ws = both.workspace();
    const double start = 4.1; // 0.1 deep
    const JointAnswer answer = both.respond(&start, &start, ws);
    CHECK(answer.status == JointStatus::Separated);
    CHECK(answer.q[0] == Approx(4).margin(1e-3));
}

TEST_CASE("of a joint that is not free some table held it, of a free one none") {
    int stopped = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        const Table table = random_table::anyTable(random);
        Table other = table; // the same motion, a test the less, coarser
        other.epsilon = 10 * table.epsilon;
        std::vector<int> dofs(table.motion.dofCount());
        for (std::size_t k = 0; k < dofs.size(); ++k) dofs[k] = static_cast<int>(k);
        const JointResponder responder(std::vector<TableOnJoint>{{&table, dofs}, {&other, dofs}},
                                       static_cast<int>(dofs.size()));
        JointWorkspace ws = responder.workspace();
        std::vector<double> q = random_table::values(random, table.motion), hand = q;
        for (int step = 0; step < 60; ++step) {
            if (step % 20 == 0) hand = random_table::values(random, table.motion);
            std::vector<double> asked = q;
            for (std::size_t k = 0; k < q.size(); ++k) asked[k] += 0.1 * (hand[k] - q[k]);
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            std::copy_n(answer.q.begin(), q.size(), q.begin());
            const bool held = ws.held()[0] || ws.held()[1];
            CAPTURE(seed, step, name(answer.status), answer.gap, responder.keptGap(0));
            if (answer.status == JointStatus::Free) continue;
            ++stopped;
            REQUIRE(held);
        }
    }
    CHECK(stopped > 150);
}

TEST_CASE("a joint of a whole turn goes on over where its limits meet") {
    const Table table = ball(atAngle(0), atAngle(0), about(-pi, pi)); // contact about 0
    const double contact = 2 * std::asin(1 / 4.0);
    const JointResponder responder(table);
    JointWorkspace ws = responder.workspace();
    double q = 2.5;
    for (double asked : {2.9, 3.3, 3.7, 4.1, 4.5}) {
        const JointAnswer answer = responder.respond(&q, &asked, ws);
        CHECK(answer.status == JointStatus::Free);
        q = answer.q[0];
        CHECK(std::abs(std::remainder(q - asked, 2 * pi)) < 1e-9);
        CHECK(std::abs(q) <= pi);
    }
    // And on until the contact from the other side.
    for (double asked = 4.5; asked < 6.5; asked += 0.25) q = responder.respond(&q, &asked, ws).q[0];
    CHECK(q == Approx(-contact).margin(1e-4));
}

TEST_CASE("what stands where the limits of a whole turn meet stops the joint on both sides") {
    const Table table = ball(atAngle(pi), atAngle(0), about(-pi, pi));
    const double contact = pi - 2 * std::asin(1 / 4.0);
    const JointResponder responder(table);
    JointWorkspace ws = responder.workspace();
    const double right = 2, left = -2, beyond = 4.2;
    CHECK(responder.respond(&right, &left, ws).q[0] == Approx(contact).margin(1e-4));
    CHECK(responder.respond(&right, &beyond, ws).q[0] == Approx(contact).margin(1e-4));
    CHECK(responder.respond(&left, &right, ws).q[0] == Approx(-contact).margin(1e-4));
}

TEST_CASE("limits of less than a whole turn have ends") {
    const Table table = ball(atAngle(0), atAngle(0), about(-3, 3));
    const JointResponder responder(table);
    JointWorkspace ws = responder.workspace();
    const double q = 2.9, asked = -2.9;
    CHECK(responder.respond(&q, &asked, ws).q[0] > 0);
}
