#include "bake/respond/JointResponder.h"
#include "bake/table/Query.h"
#include "tests/Joints.h"
#include "tests/respond/Walk.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tss;
using random_table::Random;
using walk::askedPose;
using walk::distance;

namespace {

double smallestGapBetween(const Table& table, std::span<const double> from, std::span<const double> to,
                          int samples) {
    return walk::smallestGapBetween(from, to, samples,
                                    [&](const std::vector<double>& q) { return query(table, q).gap; });
}

struct Answer {
    std::vector<double> q;
    double gap = 0; ///< of the table at q
    JointStatus status = JointStatus::Free;
};

Answer respond(const Table& table, const std::vector<double>& last, const std::vector<double>& asked) {
    const JointResponder responder(table);
    JointWorkspace workspace = responder.workspace();
    const JointAnswer answer = responder.respond(last.data(), asked.data(), workspace);
    std::vector<double> q(answer.q.begin(), answer.q.begin() + responder.dofCount());
    const double gap = query(table, q).gap;
    return {std::move(q), gap, answer.status};
}

/// A hinge about z at the origin with a bar of one sphere at x = 100 and an obstacle at `angle`.
Table hingeWithObstacle(double angle, double lower, double upper) {
    Motion m;
    Dof d;
    d.axis = Vec3::UnitZ();
    d.lower = lower;
    d.upper = upper;
    m.dofs = {d};
    const SphereSet a{{Vec3(100 * std::cos(angle), 100 * std::sin(angle), 0), 3.0}};
    const SphereSet b{{Vec3(100, 0, 0), 2.0}};
    return makeTable(a, b, {{0, 0}}, {}, m);
}

/// Along x and y, each 50 either way.
Motion slidesInPlane() {
    Motion m;
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
        Dof d;
        d.kind = DofKind::Translation;
        d.axis = axis;
        d.lower = -50;
        d.upper = 50;
        m.dofs.push_back(d);
    }
    return m;
}

} // namespace

TEST_CASE("from a free start a joint never ends in collision and never farther from what was asked") {
    int blocked = 0, slid = 0, free = 0;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        Table table = random_table::anyTable(random);
        if (random() % 2) table.epsilon = 1e-4 * table.a[0].radius;
        const JointResponder responder(table);
        JointWorkspace ws = responder.workspace();
        std::vector<double> q = random_table::values(random, table.motion);
        for (int tries = 0; tries < 100 && query(table, q).hit(); ++tries)
            q = random_table::values(random, table.motion);
        if (query(table, q).hit()) continue;
        for (int step = 0; step < 60; ++step) {
            CAPTURE(step);
            const std::vector<double> asked = askedPose(random, table.motion, q);
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            const std::vector<double> next(answer.q.begin(), answer.q.begin() + q.size());
            REQUIRE(withinLimits(table.motion, next));
            REQUIRE(query(table, next).gap > 0);
            REQUIRE(distance(responder, next, asked) <= distance(responder, q, asked));
            if (answer.status == JointStatus::Free) {
                REQUIRE(next == asked);
                REQUIRE(smallestGapBetween(table, q, asked, 50) > 0);
                ++free;
            }
            // One DOF has no way around: whatever was passed lies between.
            if (q.size() == 1) REQUIRE(smallestGapBetween(table, q, next, 200) > 0);
            blocked += answer.status == JointStatus::Blocked;
            slid += answer.status == JointStatus::Slid;
            REQUIRE(answer.status < JointStatus::Separated);
            q = next;
        }
    }
    INFO("free " << free << ", blocked " << blocked << ", slid " << slid);
    CHECK(blocked > 100);
    CHECK(slid > 100);
    CHECK(free > 100);
}

TEST_CASE("a hinge asked to jump through an obstacle stops in front of it") {
    const Table table = hingeWithObstacle(0.5, -1, 1);
    const std::vector<double> from{0.0}, to{1.0};
    REQUIRE(query(table, from).gap > 0);
    REQUIRE(query(table, to).gap > 0);
    const Answer result = respond(table, from, to);
    CHECK(result.status == JointStatus::Blocked);
    // Contact is where the chord between the centres is 5.
    const double contact = 0.5 - 2 * std::asin(0.025);
    CHECK(result.q[0] < contact);
    CHECK(result.q[0] == Approx(contact).epsilon(1e-6));
}

TEST_CASE("a start as far as a pair gets, and nearer than what is kept, is not left through contact") {
    Motion motion; // a turn about z and a slide along it; the pair and the axis lie in one plane
    motion.dofs = {joints::turn(Vec3::Zero(), Vec3::UnitZ(), -0.5, 3.5), joints::slide(Vec3::UnitZ(), -3, 3)};
    for (const double epsilon : {0.1, 0.0}) {
        CAPTURE(epsilon);
        const double radius = epsilon > 0 ? 0.95 : 1 - 4e-7;
        Table table = makeTable({{Vec3(-1, 0, 0), radius}}, {{Vec3(1, 0, 0), radius}}, {{0, 0}}, {}, motion);
        table.epsilon = epsilon;
        const double start = query(table, std::vector<double>{0, 0}).gap;
        for (const std::vector<double>& asked :
             {std::vector<double>{1, 0}, {0.45, 0.31}, {2.5, 2.2}, {-0.4, 0}}) {
            CAPTURE(asked);
            const Answer answer = respond(table, {0, 0}, asked);
            CHECK(answer.gap >= start - 1e-9);
            if (asked[1] == 0) CHECK(answer.q == std::vector<double>{0, 0}); // no way leads out
        }
    }
}

TEST_CASE("a hinge asked within the free part goes there exactly") {
    const Table table = hingeWithObstacle(0.5, -1, 1);
    const std::vector<double> from{-0.9}, to{0.3};
    const Answer result = respond(table, from, to);
    CHECK(result.status == JointStatus::Free);
    CHECK(result.q == to);
    CHECK(result.gap == query(table, to).gap);
}

TEST_CASE("an asked value that is no number leaves its joint where it was, free and in contact") {
    const Table table = hingeWithObstacle(1.0, -2, 2);
    for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        const Answer free = respond(table, {0.25}, {none});
        CHECK(free.q[0] == 0.25);
        CHECK(free.status == JointStatus::Free);
        const Answer next = respond(table, free.q, {2});
        CHECK(next.q[0] < 1);
        CHECK(respond(table, next.q, {none}).q[0] == next.q[0]);
    }
}

TEST_CASE("a wheel on a slope slides along it to the nearest pose") {
    // The obstacle is one large sphere under the moving small one.
    const Motion m = slidesInPlane();
    Table table = makeTable({{Vec3(0, 0, 0), 10.0}}, {{Vec3(0, 0, 0), 1.0}}, {{0, 0}}, {}, m);
    SECTION("lossless") {
        table.epsilon = 0;
    }
    SECTION("with a tolerance") {
        table.epsilon = 0.001;
    }
    const std::vector<double> from{-20, 5}, to{3, 4};
    const Answer result = respond(table, from, to);
    CHECK(result.status == JointStatus::Slid);
    // The nearest point of the circle of radius 11 to (3, 4).
    CHECK(result.q[0] == Approx(6.6).margin(0.02));
    CHECK(result.q[1] == Approx(8.8).margin(0.02));
    CHECK(result.gap > 0);
}

TEST_CASE("limits and couplings hold while a joint slides") {
    Motion m = slidesInPlane();
    m.planes = {{{0.0, 1.0}, 8.0}}; // y <= 8
    const Table table = makeTable({{Vec3(0, 0, 0), 10.0}}, {{Vec3(0, 0, 0), 1.0}}, {{0, 0}}, {}, m);
    const std::vector<double> from{-20, 5}, to{-3, 30};
    const Answer result = respond(table, from, to);
    CHECK(withinLimits(m, result.q, 1e-9));
    CHECK(result.gap > 0);
    CHECK(result.q[1] == Approx(8.0).margin(1e-3));
    CHECK(result.q[0] == Approx(-std::sqrt(121.0 - 64.0)).margin(0.01));
}

TEST_CASE("the same request gives the same bits") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table table = random_table::anyTable(random);
        const JointResponder responder(table), again(table);
        JointWorkspace ws = responder.workspace(), other = again.workspace();
        for (int i = 0; i < 20; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            const std::vector<double> asked = random_table::values(random, table.motion);
            const JointAnswer x = responder.respond(q.data(), asked.data(), ws);
            const JointAnswer y = again.respond(q.data(), asked.data(), other);
            for (std::size_t k = 0; k < q.size(); ++k) REQUIRE(x.q[k] == y.q[k]);
            REQUIRE(x.status == y.status);
        }
    }
}

TEST_CASE("a start in collision is led out, or towards a free pose, and stays out") {
    int starts = 0, out = 0, later = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table table = random_table::anyTable(random);
        const JointResponder responder(table);
        if (!responder.freePose()) continue;
        JointWorkspace ws = responder.workspace();
        for (int i = 0; i < 10; ++i) {
            std::vector<double> q = random_table::values(random, table.motion);
            if (!query(table, q).hit()) continue;
            ++starts;
            const std::vector<double> asked = q;
            int frames = 0;
            for (; frames < 200 && query(table, q).hit(); ++frames) {
                const double before = query(table, q).gap;
                const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
                std::copy_n(answer.q.begin(), q.size(), q.begin());
                REQUIRE(answer.status >= JointStatus::Separated);
                if (answer.status == JointStatus::Separated) REQUIRE(query(table, q).gap > before);
            }
            out += frames <= 1;
            later += !query(table, q).hit();
            const JointAnswer stays = responder.respond(q.data(), asked.data(), ws);
            if (!query(table, q).hit()) REQUIRE(stays.gap > 0);
        }
    }
    INFO(starts << " starts, " << out << " out at once, " << later << " out in the end");
    CHECK(starts > 50);
    // Tangled obstacles leave some starts in a hollow of the gap, from where only the free pose leads out.
    CHECK(out > 0.8 * starts);
    CHECK(later == starts);
}

TEST_CASE("a joint with two tables keeps clear of both") {
    // One hinge; an obstacle on either side, each in a table of its own.
    const Table left = hingeWithObstacle(0.5, -1, 1), right = hingeWithObstacle(-0.4, -1, 1);
    const std::vector<TableOnJoint> both{{&left, {0}}, {&right, {0}}};
    const JointResponder responder(both, 1);
    JointWorkspace ws = responder.workspace();
    const double start = 0, up = 1, down = -1;
    const JointAnswer above = responder.respond(&start, &up, ws);
    CHECK(above.table == 0);
    CHECK(above.q[0] == Approx(0.5 - 2 * std::asin(0.025)).epsilon(1e-6));
    const JointAnswer below = responder.respond(&start, &down, ws);
    CHECK(below.table == 1);
    CHECK(below.q[0] == Approx(-0.4 + 2 * std::asin(0.025)).epsilon(1e-6));
}

TEST_CASE("a joint refuses tables that do not fit it") {
    const Table table = hingeWithObstacle(0.5, -1, 1), apart = hingeWithObstacle(0.5, 2, 3);
    CHECK_THROWS_AS(JointResponder(std::vector<TableOnJoint>{{&table, {1}}}, 1), std::runtime_error);
    CHECK_THROWS_AS(JointResponder(std::vector<TableOnJoint>{{&table, {}}}, 1), std::runtime_error);
    CHECK_THROWS_AS(JointResponder(std::vector<TableOnJoint>{{&table, {0}}}, 2), std::runtime_error);
    CHECK_THROWS_AS(JointResponder(std::vector<TableOnJoint>{{&table, {0}}, {&apart, {0}}}, 1),
                    std::runtime_error);
}
