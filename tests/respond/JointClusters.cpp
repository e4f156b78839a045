#include "bake/respond/JointClusters.h"
#include "bake/respond/JointSlide.h"
#include "bake/table/TableKernels.h"
#include "tests/Joints.h"
#include "tests/respond/Walk.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::between;
using random_table::Random;

namespace {

constexpr int links = 6;

/// A link along x, from one hinge to the next: rings of spheres about the axis, so that as an arm's link it
/// has hundreds.
SphereSet capsule(Random& random) {
    SphereSet spheres;
    for (int ring = 1; ring < 10; ++ring)
        for (int k = 0; k < 4; ++k) {
            const double angle = 1.6 * k + 0.3 * ring;
            spheres.push_back({Vec3(ring / 10.0, 0.05 * std::cos(angle), 0.05 * std::sin(angle)),
                               between(random, 0.07, 0.1)});
        }
    return spheres;
}

/// A chain of links that turn against one another about axes square to the links, now one way, now the other,
/// so far that each reaches all but its neighbours; one table for each two over two values or more than
/// three.
struct Chain {
    std::vector<Table> tables;
    std::vector<std::vector<int>> values;
    std::vector<TableOnJoint> onJoint;

    explicit Chain(std::uint64_t seed) {
        Random random(seed);
        std::vector<SphereSet> bodies;
        for (int k = 0; k < links; ++k) bodies.push_back(capsule(random));
        for (int a = 0; a < links; ++a)
            for (int b = a + 2; b < links; ++b) {
                if (b - a == 3) continue; // takes long to make, and is asked as one over two values is
                Motion motion;
                std::vector<int> own;
                for (int k = a; k < b; ++k) {
                    Dof dof;
                    dof.axis = k % 2 ? Vec3::UnitY() : Vec3::UnitZ();
                    dof.origin = Vec3(k - a + 1, 0, 0);
                    dof.lower = -2.2;
                    dof.upper = 2.4;
                    motion.dofs.push_back(dof);
                    own.push_back(k);
                }
                motion.base.translation() = Vec3(b - a, 0, 0);
                std::vector<SpherePair> all;
                for (std::uint32_t i = 0; i < bodies[a].size(); ++i)
                    for (std::uint32_t j = 0; j < bodies[b].size(); ++j) all.push_back({i, j});
                tables.push_back(makeTable(bodies[a], bodies[b], all, {}, motion));
                values.push_back(own);
            }
        for (std::size_t t = 0; t < tables.size(); ++t) onJoint.push_back({&tables[t], values[t]});
    }

    std::vector<double> own(std::size_t table, std::span<const double> q) const {
        std::vector<double> some;
        for (const int value : values[table]) some.push_back(q[std::size_t(value)]);
        return some;
    }
    /// By the plain query, test by test.
    double gap(std::span<const double> q) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t t = 0; t < tables.size(); ++t)
            least = std::min(least, query(tables[t], own(t, q)).gap);
        return least;
    }
    const Motion& limits() const { return tables[2].motion; } ///< of the first link and the last
};

std::vector<double> valuesOf(const DofValues& q) {
    return {q.begin(), q.begin() + links - 1};
}

} // namespace

TEST_CASE("a chain that is driven into itself never goes through, whatever of its tables is passed over") {
    int slid = 0, blocked = 0, free = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        CAPTURE(seed);
        const Chain chain(seed);
        const JointResponder responder(chain.onJoint, links - 1);
        JointWorkspace ws = responder.workspace();
        Random random(100 + seed);
        const Motion limits = chain.limits();
        REQUIRE(limits.dofs.size() == links - 1);
        std::vector<double> q(links - 1, 0.0), hand = q;
        REQUIRE(chain.gap(q) > 0);
        for (int step = 0; step < 800; ++step) {
            CAPTURE(step);
            if (step % 90 == 0) do
                    hand = random_table::values(random, limits);
                while (chain.gap(hand) > 0); // where it cannot be
            const double share = step % 30 == 29 ? 1 : between(random, 0.01, 0.1);
            std::vector<double> asked = q;
            for (std::size_t k = 0; k < q.size(); ++k) asked[k] += share * (hand[k] - q[k]);
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            const std::vector<double> next = valuesOf(answer.q);
            REQUIRE(chain.gap(next) > 0);
            REQUIRE(walk::distance(responder, next, asked) <= walk::distance(responder, q, asked));
            REQUIRE(answer.status < JointStatus::Separated);
            if (answer.status == JointStatus::Free && step % 8 == 0) {
                REQUIRE(next == asked);
                REQUIRE(walk::smallestGapBetween(
                            q, next, 12, [&](const std::vector<double>& at) { return chain.gap(at); }) > 0);
            }
            // What is known of the steps before changes no bit.
            if (step % 3 == 0) {
                JointWorkspace fresh = responder.workspace();
                REQUIRE(valuesOf(responder.respond(q.data(), asked.data(), fresh).q) == next);
            }
            free += answer.status == JointStatus::Free;
            slid += answer.status == JointStatus::Slid;
            blocked += answer.status == JointStatus::Blocked;
            q = next;
        }
    }
    CAPTURE(free, slid, blocked);
    CHECK(free > 100);
    CHECK(slid > 100);
    CHECK(blocked > 5);
}

namespace {

/// Of some random poses the one at which tables in clusters are nearest to contact, or deepest in it.
std::vector<double> nearItself(Random& random, const JointModel& model, const Motion& limits) {
    std::vector<double> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i) {
        const std::vector<double> q = random_table::values(random, limits);
        for (std::size_t g = 0; g < model.groups.size(); ++g) {
            const JointModel::Group& group = model.groups[g];
            if (!group.clustered) continue;
            const std::span own(q.data() + group.dofs[0], group.dofs.size());
            const double gap = smallestGap(model, g, pose(group.motion, own));
            if (gap < least) least = gap, nearest = q;
        }
    }
    return nearest;
}

} // namespace

TEST_CASE("what is not listed for a way stays away from contact all along it") {
    const Chain chain(9);
    const JointModel model = makeJointModel(chain.onJoint, links - 1);
    REQUIRE(model.clustered);
    REQUIRE(model.unclusteredPairs > 0);       // tables of both kinds
    REQUIRE(model.chains.size() == links - 2); // of each link that a table begins with
    ResponseBuffers kept = buffersFor(model);
    Random random(10);
    const Motion limits = chain.limits();
    std::size_t listed = 0, asked = 0, nearest = 0;
    for (int i = 0; i < 80; ++i) {
        CAPTURE(i);
        DofValues q{}, step{};
        const std::vector<double> from = nearItself(random, model, limits);
        const double size = std::pow(10.0, between(random, -4, -0.7));
        for (std::size_t k = 0; k < from.size(); ++k) {
            q[k] = from[k];
            step[k] = between(random, -size, size);
        }
        ResponseBuffers ws = buffersFor(model);
        for (PlacedGroup& group : kept.groups) group.valid = false;
        ws.clearNear();
        kept.clearNear();
        REQUIRE(listOnStep(model, q, step, ws));
        // A little before, and here with what is known from there.
        DofValues before = q;
        for (std::size_t k = 0; k < from.size(); ++k) before[k] -= 0.5 * step[k];
        REQUIRE(listOnStep(model, before, step, kept));
        kept.clearNear();
        REQUIRE(listOnStep(model, q, step, kept));
        REQUIRE(kept.nearCount == ws.nearCount);
        for (std::size_t k = 0; k < ws.nearCount; ++k) REQUIRE(kept.near[k].pair == ws.near[k].pair);
        listed += ws.nearCount;
        for (int part = 0; part <= 5; ++part) {
            DofValues at = q;
            for (std::size_t k = 0; k < from.size(); ++k) at[k] += part / 5.0 * step[k];
            for (std::size_t g = 0; g < model.groups.size(); ++g) {
                const JointModel::Group& group = model.groups[g];
                placeGroup(model, g, at, step, ws);
                const Pose& pose = ws.groups[g].frame.pose;
                REQUIRE(pose.matrix() == tss::pose(group.motion, chain.own(g, at)).matrix());
                if (!group.clustered) continue;
                double least = std::numeric_limits<double>::infinity();
                Vec3 centre, normal;
                for (std::uint32_t p = group.firstPair; p < group.lastPair; ++p) {
                    const double gap = pairGap(model.pairs[p], pose, centre, normal);
                    least = std::min(least, gap);
                    if (gap > group.contactOffset || ws.listed[p] == ws.listing) continue;
                    FAIL("pair " << p << " comes to " << gap << " and is not listed");
                }
                REQUIRE(smallestGap(model, g, pose) == least);
                nearest += least < 0;
                asked += group.lastPair - group.firstPair;
            }
        }
    }
    CAPTURE(listed, asked, nearest);
    CHECK(listed > 1000);
    CHECK(listed < asked / 6 / 10);
    CHECK(nearest > 5);
}

TEST_CASE(
    "what comes near of tables that are asked whole has room beside what is kept of those in clusters") {
    const Chain chain(9);
    const JointModel model = makeJointModel(chain.onJoint, links - 1);
    ResponseBuffers ws = buffersFor(model);
    ws.clearNear();
    ws.nearCount = ws.near.size(); // full of what is kept
    const std::size_t kept = ws.nearCount;
    cullMore(model, DofValues{}, model.range, ws);
    CHECK(ws.nearCount > kept);
    CHECK(ws.nearCount <= ws.near.size());
}

TEST_CASE("a chain that starts in itself comes out, and is held out from then on") {
    const Chain chain(5);
    const JointResponder responder(chain.onJoint, links - 1);
    REQUIRE(responder.freePose());
    JointWorkspace ws = responder.workspace();
    Random random(6);
    int starts = 0, pushed = 0;
    while (starts < 25) {
        std::vector<double> q = random_table::values(random, chain.limits());
        if (chain.gap(q) > 0) continue;
        CAPTURE(++starts);
        const std::vector<double> asked = q;
        bool out = false;
        for (int i = 0; i < 60; ++i) {
            const double before = chain.gap(q);
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            q = valuesOf(answer.q);
            const double after = chain.gap(q);
            if (out) REQUIRE(after > 0);
            if (before <= 0 && answer.status == JointStatus::Separated) REQUIRE(after > before);
            pushed += before <= 0 && after > 0 && answer.status == JointStatus::Separated;
            out = after > 0;
            if (before <= 0) REQUIRE(answer.status >= JointStatus::Separated);
        }
        REQUIRE(out);
    }
    CHECK(pushed > 10);
}

namespace {

SphereSet plate(int side, double z) {
    SphereSet spheres;
    for (int i = 0; i < side * side; ++i)
        spheres.push_back({0.02 * Vec3(i % side - side / 2, i / side - side / 2, 0) + Vec3(0, 0, z), 0.015});
    return spheres;
}

} // namespace

TEST_CASE("a slide over a wide range lists no more of a table in clusters than is near at short ways") {
    const SphereSet a = plate(60, 0), b = plate(14, 0.05);
    Motion motion;
    for (int k = 0; k < 3; ++k) motion.dofs.push_back(joints::slide(Vec3::Unit(k), -50, 50));
    motion.dofs.push_back(joints::turn(Vec3::Zero(), Vec3::UnitZ(), -0.5, 0.5));
    std::vector<SpherePair> all;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j) all.push_back({i, j});
    const Table table = makeTable(a, b, all, {}, motion);
    const JointModel model = makeJointModel(std::vector<TableOnJoint>{{&table, {0, 1, 2, 3}}}, 4);
    REQUIRE(model.clustered);
    ResponseBuffers ws = buffersFor(model);
    ws.clearNear();
    DofValues q{};
    const DofValues goal{0.1, 0, -0.05, 0}; // along the plate, and into it
    slide(model, goal, q, ws);
    CHECK(q[0] > 0.09);
    CHECK(q[2] < 0);
    CHECK(query(table, std::vector<double>{q[0], q[1], q[2], q[3]}).gap > 0);
    CHECK(ws.near.size() < 4000); // it grows, and keeps what it needed at most
}

TEST_CASE("the nearest test of a table is the plain query's, to the bit") {
    int touching = 0, free = 0, clustered = 0;
    const auto check = [&](const Table& table, const std::vector<double>& q, const JointResponder& responder,
                           JointWorkspace& room) {
        const QueryResult plain = query(table, q), found = responder.nearest(0, q.data(), room);
        CAPTURE(q, plain.gap, found.gap);
        REQUIRE(found.test == plain.test);
        REQUIRE(found.gap == plain.gap);
        REQUIRE(found.point == plain.point);
        REQUIRE(found.normal == plain.normal);
        (plain.hit() ? touching : free) += 1;
    };
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        Table table = random_table::anyTable(random, 3);
        if (seed % 3 == 0) {
            const Motion motion = random_table::motion(random, 4 + int(seed % 4), 1, false);
            table = random_table::table(random, motion, 60, 60, 1);
            ++clustered;
        }
        if (seed % 2)
            for (SphereSet* set : {&table.a, &table.b})
                for (Sphere& s : *set) s.radius *= 0.2;
        if (seed % 5 == 0) { // none ever touches
            table.restGaps.clear();
            for (const SpherePair& test : tests(table))
                table.restGaps.push_back(-table.a[test.a].radius - table.b[test.b].radius - 0.01);
        }
        const JointResponder responder(table);
        JointWorkspace room = responder.workspace();
        for (int i = 0; i < 40; ++i) {
            std::vector<double> q = random_table::values(random, table.motion);
            if (i % 8 == 0) q[0] = table.motion.dofs[0].upper;
            if (i % 8 == 1) q[0] = table.motion.dofs[0].upper + 0.3; // beyond
            check(table, q, responder, room);
        }
    }
    CHECK(clustered > 10);
    CHECK(touching > 500);
    CHECK(free > 500);
}
