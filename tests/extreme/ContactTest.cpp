#include "bake/table/Contact.h"
#include "bake/motion/MotionFrame.h"
#include "bake/respond/JointResponder.h"
#include "bake/table/Query.h"
#include "tests/extreme/Served.h"
#include "tests/extreme/tool/LongRun.h"

#include <cmath>

using namespace extreme;
using tss::JointStatus;
using tss::Table;

namespace {

double gapAt(const Table& table, double q) {
    return tss::query(table, std::vector<double>{q}).gap;
}

/// Every kernel's gap, normal and gradient at a pose are numbers.
void checkFinite(const Table& table, std::vector<double> q) {
    for (const tss::KernelTarget target : kernelTargets())
        for (const auto precision : {tss::KernelPrecision::Float, tss::KernelPrecision::Double}) {
            tss::PrepareOptions how;
            how.target = target;
            how.precision = precision;
            const tss::PreparedTable prepared(table, how);
            tss::TableFeatures features;
            prepared.features(q.data(), features);
            tss::MotionFrame frame;
            prepared.frame(q.data(), frame);
            tss::TableContact contact;
            prepared.contact(features, frame, contact);
            CHECK(prepared.hit(features) == (tss::query(table, q).gap <= 0));
            CHECK(std::isfinite(contact.gap));
            CHECK(contact.point.allFinite());
            CHECK(contact.normal.norm() == Approx(1));
            for (std::size_t k = 0; k < q.size(); ++k) CHECK(std::isfinite(contact.gradient[k]));
        }
}

/// One step of a joint with the table of a scene.
tss::JointAnswer step(const tss::JointResponder& responder, double last, double asked) {
    tss::JointWorkspace workspace = responder.workspace();
    return responder.respond(&last, &asked, workspace);
}

} // namespace

TEST_CASE("where two centres coincide gaps are finite and normals have length 1, in every kernel") {
    for (const char* name : {"concentric", "concentric_equal"}) {
        const Table& table = tableOf(name);
        checkFinite(table, {0});
        // The very pose at which the centres of the deepest test are at the same place along the slide.
        const tss::QueryResult deepest = tss::query(table, std::vector<double>{0});
        const auto pair = tss::tests(table)[std::size_t(deepest.test)];
        checkFinite(table, {table.a[pair.a].centre.x() - table.b[pair.b].centre.x()});
    }
}

TEST_CASE(
    "two spheres about one point are a contact with a finite answer, and the joint does not move by NaN") {
    Table table;
    table.a = {{{1, 2, 3}, 1}};
    table.b = {{{1, 2, 3}, 0.5}};
    table.rowOffsets = {0, 1};
    table.columns = {0};
    tss::Dof dof;
    dof.kind = tss::DofKind::Translation;
    dof.lower = -5;
    dof.upper = 5;
    table.motion.dofs = {dof};
    checkFinite(table, {0});
    const tss::JointAnswer answer = step(tss::JointResponder(table), 0, 3);
    CHECK(std::isfinite(answer.q[0]));
    double q = 0;
    const tss::JointResponder responder(table);
    for (int k = 0; k < 60; ++k) q = step(responder, q, 3).q[0];
    CHECK(gapAt(table, q) > 0);
}

TEST_CASE("faces exactly on each other are in contact all the way when no exception is asked for") {
    const Table& table = tableOf("touch_faces_collide");
    for (double q = -2; q <= 2; q += 1. / 64) CHECK(gapAt(table, q) <= 0);
    CHECK(gapAt(table, 3) > 0);
}

TEST_CASE("faces on each other at rest are free at rest") {
    CHECK(gapAt(tableOf("touch_faces"), 0) > 0);
}

TEST_CASE("two corners in one point are in contact") {
    CHECK(gapAt(tableOf("touch_corner"), 0) <= 0);
}

TEST_CASE("balls that touch in one point at one pose are in contact there and apart a unit away") {
    const Table& table = tableOf("tangent");
    CHECK(gapAt(table, 30) <= 0);
    // The balls are polyhedra inside radius 10 and 5: a slide by 6 takes the centres 16.2 apart.
    CHECK(gapAt(table, 24) > 0);
    CHECK(gapAt(table, 36) > 0);
}

TEST_CASE("a joint driven through its contact and back does not drift") {
    const ToAndFro run = driveToAndFro(served("to_and_fro").scene, 20000);
    CHECK(run.blocked > run.steps / 10);
    CHECK(run.drift == 0);
    CHECK(run.deepest > 0);
}

TEST_CASE("a joint driven a million steps through its contact and back does not drift", "[.long]") {
    const ToAndFro run = driveToAndFro(served("to_and_fro").scene, 1000000);
    CHECK(run.drift == 0);
    CHECK(run.deepest > 0);
}

TEST_CASE("a jump across the whole obstacle in one step stops before it, from either side") {
    const Table& table = tableOf("jump");
    const tss::JointResponder responder(table);
    for (const double side : {-1., 1.}) {
        const tss::JointAnswer answer = step(responder, side * 50, side * -50);
        CHECK(answer.status == JointStatus::Blocked);
        CHECK(side * answer.q[0] > 4.5);
        CHECK(side * answer.q[0] < 6);
        CHECK(gapAt(table, answer.q[0]) > 0);
    }
}

TEST_CASE("a start deep inside is led out in some steps and never goes in again") {
    const Table& table = tableOf("start_deep");
    const tss::JointResponder responder(table);
    for (const double asked : {-50., 0., 50.}) {
        double q = 0;
        int steps = 0;
        while (gapAt(table, q) <= 0 && steps < 100) {
            q = step(responder, q, asked).q[0];
            ++steps;
        }
        CHECK(steps < 100);
        for (int k = 0; k < 20; ++k) {
            q = step(responder, q, 0).q[0];
            CHECK(gapAt(table, q) > 0);
        }
    }
}
