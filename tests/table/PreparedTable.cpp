#include "bake/base/Error.h"
#include "bake/table/TableKernels.h"
#include "tests/Joints.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

namespace {

constexpr KernelTarget targets[] = {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                    KernelTarget::Avx512, KernelTarget::Neon};

/// Every way to query a table that this processor and this motion allow.
std::vector<PreparedTable> allPreparations(const Table& table) {
    std::vector<PreparedTable> all;
    for (KernelTarget target : targets) {
        if (!available(target)) continue;
        for (KernelForm form : {KernelForm::Fold, KernelForm::Direct})
            for (KernelPrecision precision : {KernelPrecision::Float, KernelPrecision::Double})
                for (CellUse cells : {CellUse::Never, CellUse::Always}) {
                    try {
                        all.emplace_back(table, PrepareOptions{target, form, precision, cells});
                    } catch (const InputError&) {
                        REQUIRE(form == KernelForm::Fold);
                    }
                }
    }
    return all;
}

std::string describe(const PreparedTable& t) {
    return std::string(name(t.target())) + " " + name(t.form()) + " " + name(t.precision()) +
           (t.kernels().cells().empty() ? "" : " with cells");
}

Dof hinge(const Vec3& origin, const Vec3& axis, double lower = -0.4, double upper = 0.6) {
    return joints::turn(origin, axis, lower, upper);
}

Dof slideAlong(const Vec3& axis) {
    return joints::slide(axis, -3, 5);
}

Table tableOver(const std::vector<Dof>& dofs) {
    Random random(7);
    Motion m;
    m.dofs = dofs;
    return random_table::table(random, m, 12, 12, 20);
}

} // namespace

TEST_CASE("sine and versine are those of long double") {
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
        const double x =
            random_table::between(random, -1, 1) * std::pow(10.0, random_table::between(random, -9, 5));
        double s, v;
        sinVersin(x, s, v);
        const long double half = std::sin(0.5L * x);
        REQUIRE(std::abs(s - std::sin(static_cast<long double>(x))) <= 2.5e-16L * std::min(1.0, std::abs(x)));
        REQUIRE(std::abs(v - 2 * half * half) <= 4.5e-16L * std::min(1.0, 0.5 * x * x));
    }
}

TEST_CASE("no kernel misses a touch, and verdicts and gaps are right outside the stated band") {
    long inside = 0, checked = 0;
    double tightest = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        Table table = random_table::anyTable(random);
        table.gapMargin = table.gapDepth = table.a[0].radius;
        const std::vector<TablePair> pairs = tablePairs(table);
        std::vector<long double> gaps;
        std::vector<std::vector<double>> poses;
        for (int i = 0; i < 100; ++i) {
            poses.push_back(random_table::values(random, table.motion));
            gaps.push_back(exact::gap(table.motion, pairs, poses.back()));
        }
        for (const PreparedTable& t : allPreparations(table)) {
            CAPTURE(describe(t), t.signBand(), t.gapBand());
            for (std::size_t i = 0; i < poses.size(); ++i) {
                TableFeatures f;
                t.features(poses[i].data(), f);
                ++checked;
                if (gaps[i] <= 0 || gaps[i] > t.signBand())
                    REQUIRE((t.hit(f) == (gaps[i] <= 0) && t.hit(poses[i].data()) == (gaps[i] <= 0)));
                else
                    ++inside;
                const TableGap g = t.gap(f);
                REQUIRE(g.test >= 0);
                if (gaps[i] > -table.gapDepth && gaps[i] < table.gapMargin) {
                    REQUIRE(std::abs(g.gap - gaps[i]) <= t.gapBand());
                    tightest = std::max(tightest, double(std::abs(g.gap - gaps[i]) / t.gapBand()));
                    const long double named = exact::gap(table.motion, pairs[std::size_t(g.test)], poses[i]);
                    REQUIRE(named <= gaps[i] + 2 * t.gapBand());
                }
            }
        }
    }
    INFO(inside << " of " << checked << " inside the band, worst error " << tightest << " of the band");
    CHECK(inside < checked / 100);
    CHECK(tightest > 0.02);
}

TEST_CASE("all tests under a margin are found, and none far above it") {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table table = random_table::anyTable(random);
        const std::vector<TablePair> pairs = tablePairs(table);
        const double size = table.a[0].radius;
        for (const PreparedTable& t : allPreparations(table)) {
            CAPTURE(describe(t));
            std::vector<std::uint32_t> found(t.testRoom());
            for (double margin : {0.0, 0.1 * size, 3 * size}) {
                const std::vector<double> q = random_table::values(random, table.motion);
                TableFeatures f;
                t.features(q.data(), f);
                const std::uint32_t count = t.testsWithin(f, margin, found.data());
                std::vector<std::uint32_t> same(t.testRoom());
                REQUIRE(t.testsWithin(q.data(), margin, same.data()) == count);
                REQUIRE(std::equal(same.begin(), same.begin() + count, found.begin()));
                std::vector<bool> in(pairs.size());
                for (std::uint32_t i = 0; i < count; ++i) {
                    REQUIRE(found[i] < pairs.size());
                    REQUIRE_FALSE(in[found[i]]);
                    in[found[i]] = true;
                }
                for (std::size_t p = 0; p < pairs.size(); ++p) {
                    const long double gap = exact::gap(table.motion, pairs[p], q);
                    if (gap <= margin) REQUIRE(in[p]);
                    if (gap > margin + 10 * (t.signBand() + t.gapBand()) + 1e-4 * margin)
                        REQUIRE_FALSE(in[p]);
                }
            }
        }
    }
}

TEST_CASE("many instances at once answer as one at a time") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table table = random_table::anyTable(random);
        const std::uint32_t count = 1 + std::uint32_t(random() % 600);
        std::vector<double> q;
        for (std::uint32_t i = 0; i < count; ++i)
            for (double v : random_table::values(random, table.motion)) q.push_back(v);
        for (const PreparedTable& t : allPreparations(table)) {
            CAPTURE(describe(t));
            InstanceFeatures all;
            t.instanceFeatures(q.data(), count, all);
            std::vector<std::uint8_t> hits(count);
            t.hits(all, hits.data());
            for (std::uint32_t i = 0; i < count; ++i) {
                TableFeatures f;
                t.features(q.data() + i * table.motion.dofCount(), f);
                if (std::abs(t.gap(f).gap) > 2 * (t.signBand() + t.gapBand()))
                    REQUIRE(bool(hits[i]) == t.hit(f));
            }
        }
    }
}

TEST_CASE("contact gives the query's point and normal, and the gap's gradient") {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table table = random_table::anyTable(random);
        const PreparedTable t(table);
        for (int i = 0; i < 20; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            TableFeatures f;
            MotionFrame frame;
            t.features(q.data(), f);
            t.frame(q.data(), frame);
            TableContact c;
            t.contact(f, frame, c);
            const TableContact alone = t.contact(q.data());
            REQUIRE((alone.test == c.test && alone.gap == c.gap && alone.point == c.point));
            REQUIRE(t.gap(q.data()).gap == t.gap(f).gap);
            const QueryResult plain = query(table, q);
            if (c.test != plain.test) {
                REQUIRE(c.gap == Approx(plain.gap).margin(2 * t.gapBand() + 1e-5 * std::abs(plain.gap)));
                continue;
            }
            const double size = table.a[0].radius;
            REQUIRE(c.gap == Approx(plain.gap).margin(1e-11 * size));
            REQUIRE((c.point - plain.point).norm() < 1e-10 * size);
            REQUIRE((c.normal - plain.normal).norm() < 1e-10);
            for (std::size_t k = 0; k < q.size(); ++k) {
                std::vector<double> ahead = q;
                const double step = 1e-6 * (table.motion.dofs[k].upper - table.motion.dofs[k].lower);
                ahead[k] += step;
                const std::vector<TablePair> pairs = tablePairs(table);
                const long double difference = (exact::gap(table.motion, pairs[std::size_t(c.test)], ahead) -
                                                exact::gap(table.motion, pairs[std::size_t(c.test)], q)) /
                                               static_cast<long double>(ahead[k] - q[k]);
                const TablePair& pair = t.pair(std::size_t(c.test));
                const double speed = frame.twists[k].velocity(frame.pose * pair.b).norm();
                REQUIRE(c.gradient[k] == Approx(double(difference)).margin(1e-3 * speed));
            }
        }
    }
}

TEST_CASE("the fold finds the span of a motion by itself") {
    const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
    struct Case {
        const char* name;
        std::vector<Dof> dofs;
        std::size_t features;
        bool shared;
    };
    const Case cases[] = {
        {"hinge", {hinge(Vec3(1, 2, 3), x)}, 2, false},
        {"slide", {slideAlong(Vec3(1, 2, 2))}, 1, true},
        {"hinge and slide along it", {hinge(Vec3(1, 0, 0), z), slideAlong(z)}, 3, true},
        {"hinge and slide across it", {hinge(Vec3(1, 0, 0), z), slideAlong(x)}, 5, true},
        {"two slides at right angles", {slideAlong(x), slideAlong(z)}, 2, true},
        {"three slides", {slideAlong(x), slideAlong(z), slideAlong(Vec3::UnitY())}, 3, true},
        {"two hinges", {hinge(Vec3(1, 0, 0), z), hinge(Vec3(0, 4, 0), x)}, 8, false},
        {"a slide of no width", {hinge(Vec3(1, 2, 3), x), hinge(Vec3::Zero(), z, 0.3, 0.3)}, 2, false},
    };
    for (const Case& c : cases) {
        CAPTURE(c.name);
        const PreparedTable t(tableOver(c.dofs), {KernelTarget::Best, KernelForm::Fold, {}});
        CHECK(t.kernels().featureCount() == c.features);
        CHECK(t.kernels().fold()->sharedFeatures.empty() != c.shared);
    }
}

TEST_CASE("a chain of many features takes the direct kernel") {
    const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
    const PreparedTable t(
        tableOver({hinge(Vec3(1, 2, 3), x), hinge(Vec3(4, 0, 1), z), hinge(Vec3(0, 1, 0), Vec3::UnitY())}));
    CHECK(t.form() == KernelForm::Direct);
    CHECK(t.kernels().featureCount() == 12);
}

TEST_CASE("float is taken where its band is within a tenth of epsilon, double below") {
    Table table = tableOver({hinge(Vec3(1, 2, 3), Vec3::UnitX())});
    table.epsilon = 1;
    CHECK(PreparedTable(table).precision() == KernelPrecision::Float);
    table.epsilon = 1e-9;
    const PreparedTable fine(table);
    CHECK(fine.precision() == KernelPrecision::Double);
    CHECK(fine.signBand() < 1e-10);
}

TEST_CASE("the kernels of an empty table never hit") {
    Table table;
    table.motion.dofs = {hinge(Vec3::Zero(), Vec3::UnitX())};
    for (const PreparedTable& t : allPreparations(table)) {
        CAPTURE(describe(t));
        TableFeatures f;
        const double q = 0.1;
        t.features(&q, f);
        CHECK_FALSE(t.hit(f));
        CHECK(t.gap(f).gap > 1e17);
        CHECK(t.gap(f).test == -1);
        std::vector<std::uint32_t> found(t.testRoom());
        CHECK(t.testsWithin(f, 1e3, found.data()) == 0);
    }
}

TEST_CASE("a pair of bodies far from the origin is as exact as one at it") {
    Random random(5);
    Motion near;
    near.dofs = {hinge(Vec3(1, 2, 3), Vec3(1, 1, 1))};
    Table table = random_table::table(random, near, 8, 8, 10);
    const double band = PreparedTable(table).signBand();
    const Vec3 away(1e6, -2e6, 3e6);
    for (Sphere& s : table.a) s.centre += away;
    table.motion.dofs[0].origin += away;
    table.motion.base.translation() += away;
    CHECK(PreparedTable(table).signBand() < 1.5 * band);
}

TEST_CASE("a kernel that does not exist is refused") {
    const Table table = tableOver({hinge(Vec3(1, 2, 3), Vec3::UnitX())});
    for (KernelTarget target : targets)
        if (!available(target)) CHECK_THROWS_AS(PreparedTable(table, {target, {}, {}}), InputError);
    KernelTarget target;
    CHECK(kernelTarget("avx2", target));
    CHECK(target == KernelTarget::Avx2);
    CHECK_FALSE(kernelTarget("mmx", target));
}
