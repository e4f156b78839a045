#include "bake/table/PreparedTable.h"
#include "tests/Joints.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

using namespace tss;
using random_table::Random;

namespace {

/// Random values, and the two ends of halved segments between contact and its absence.
std::vector<std::vector<double>> poses(Random& random, const Table& table,
                                       const std::vector<TablePair>& pairs) {
    std::vector<std::vector<double>> all;
    std::vector<double> free, hit;
    for (int i = 0; i < 120; ++i) {
        all.push_back(random_table::values(random, table.motion));
        (exact::gap(table.motion, pairs, all.back()) <= 0 ? hit : free) = all.back();
        if (i % 4 || free.empty() || hit.empty()) continue;
        std::vector<double> f = free, h = hit;
        for (int round = 0; round < 50; ++round) {
            std::vector<double> middle(f.size());
            for (std::size_t k = 0; k < f.size(); ++k) middle[k] = 0.5 * (f[k] + h[k]);
            (exact::gap(table.motion, pairs, middle) <= 0 ? h : f) = middle;
            if (round % 7 == 0) all.push_back(f), all.push_back(h);
        }
        all.push_back(f);
        all.push_back(h);
    }
    return all;
}

} // namespace

TEST_CASE("a verdict from the values alone is the tests' own at every pose, at those near contact too") {
    long free = 0, touching = 0, asked = 0, asksWithPieces = 0;
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Table table = random_table::anyTable(random);
        const std::vector<TablePair> pairs = tablePairs(table);
        const PreparedTable prepared(table);
        const VerdictGrid& verdicts = prepared.verdicts();
        REQUIRE_FALSE(verdicts.empty());
        for (const std::vector<double>& q : poses(random, table, pairs)) {
            const long double gap = exact::gap(table.motion, pairs, q);
            const Verdict verdict = verdicts.verdict(q.data());
            if (verdict == Verdict::Free) REQUIRE(gap > 0);
            if (verdict == Verdict::Touch) REQUIRE(gap <= prepared.signBand());
            const double clearance = verdicts.clearance(q.data());
            if (clearance > 0) REQUIRE(gap >= clearance);
            if (gap <= 0) REQUIRE(prepared.hit(q.data()));
            if (gap > prepared.signBand()) REQUIRE_FALSE(prepared.hit(q.data()));
            free += verdict == Verdict::Free;
            touching += verdict == Verdict::Touch;
            asked += verdict == Verdict::Ask;
            asksWithPieces += verdict == Verdict::Ask && table.motion.dofCount() == 1;
        }
    }
    CAPTURE(free, touching, asked, asksWithPieces);
    CHECK(free > 1000);
    CHECK(touching > 1000);
    CHECK(asked > 1000);
    CHECK(asksWithPieces < 20);
}

TEST_CASE("verdicts along a path hold where its values are large beside their range, as time stamps are") {
    const double lower = 1.7e9, range = 0.01;
    int wrong = 0;
    for (int k = 0; k < 60; ++k) {
        Motion motion;
        Dof path = joints::slide(Vec3::UnitX(), lower, lower + range);
        path.kind = DofKind::Path;
        path.path = {{lower, Vec3::Zero(), Eigen::Quaterniond::Identity()},
                     {lower + range, Vec3(4, 0, 0), Eigen::Quaterniond::Identity()}};
        path.rest = lower;
        motion.dofs = {path};
        if (k % 2) motion.dofs.push_back(joints::slide(Vec3::UnitY(), 0, 1e-3));
        const double x = 1.2 + 0.0433 * k;
        const Table table = makeTable({{Vec3(x, 0, 0), 0.1}}, {{Vec3::Zero(), 0.1}}, {{0, 0}}, {}, motion);
        const PreparedTable prepared(table);
        const auto pairs = tablePairs(table);
        double q = lower + range * ((x - 0.2) / 4);
        for (int i = 0; i < 60; ++i) q = std::nextafter(q, 0.0);
        for (int i = 0; i < 120; ++i, q = std::nextafter(q, 2 * lower)) {
            const std::vector<double> at = k % 2 ? std::vector{q, 1e-5 * i / 120} : std::vector{q};
            const auto gap = static_cast<double>(exact::gap(motion, pairs, at));
            if (prepared.hit(at.data()) ? gap > prepared.signBand() + 1e-12 : gap < -1e-12) ++wrong;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("no verdict is known beyond the limits") {
    Random random(5);
    for (int dofs = 1; dofs <= 3; ++dofs) {
        const Motion motion = random_table::motion(random, dofs, 1, false);
        const Table table = random_table::table(random, motion, 6, 6, 1);
        const VerdictGrid verdicts(motion, tablePairs(table), 0);
        for (int k = 0; k < dofs; ++k) {
            const Dof& dof = motion.dofs[std::size_t(k)];
            const double range = dof.upper - dof.lower;
            for (double bad : {dof.lower - 0.01 * range, dof.upper + 0.01 * range, 1e300, -1e300,
                               std::numeric_limits<double>::infinity()}) {
                std::vector<double> q = random_table::values(random, motion);
                q[std::size_t(k)] = bad;
                CHECK(verdicts.verdict(q.data()) == Verdict::Ask);
                CHECK(verdicts.clearance(q.data()) == 0);
            }
        }
    }
}

TEST_CASE("a hinge's verdicts take a kilobyte, and more than three DOFs have none") {
    Random random(9);
    const Motion hinge = random_table::motion(random, 1, 1, false);
    const VerdictGrid one(hinge, tablePairs(random_table::table(random, hinge, 3, 3, 1)), 1e-9);
    CHECK(one.bytes() <= 1024);
    CHECK(one.asked() == 0);
    const Motion chain = random_table::motion(random, 4, 1, false);
    CHECK(VerdictGrid(chain, tablePairs(random_table::table(random, chain, 3, 3, 1)), 0).empty());
}

TEST_CASE("tests under a margin are found whether or not the verdicts already exclude them") {
    long none = 0, some = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Table table = random_table::anyTable(random);
        PrepareOptions bare;
        bare.cells = CellUse::Never;
        const PreparedTable with(table), without(table, bare);
        double size = 0;
        for (const Sphere& s : table.a) size = std::max(size, s.radius);
        std::vector<std::uint32_t> x(with.testRoom()), y(without.testRoom());
        for (int i = 0; i < 200; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            const double margin = random_table::between(random, 0, 2) * size;
            const std::uint32_t n = with.testsWithin(q.data(), margin, x.data());
            const std::uint32_t m = without.testsWithin(q.data(), margin, y.data());
            none += n == 0;
            some += n > 0;
            // Both may report what is a little beyond; none may leave out what is within.
            const std::vector<TablePair> pairs = tablePairs(table);
            for (std::uint32_t p = 0; p < pairs.size(); ++p) {
                if (exact::gap(table.motion, pairs[p], q) > margin) continue;
                REQUIRE(std::find(x.begin(), x.begin() + n, p) != x.begin() + n);
                REQUIRE(std::find(y.begin(), y.begin() + m, p) != y.begin() + m);
            }
        }
    }
    CHECK(none > 500);
    CHECK(some > 500);
}
