#include "bake/verify/Kernel.h"
#include "bake/base/Error.h"
#include "bake/table/TableKernels.h"
#include "bake/verify/KernelProofs.h"
#include "tests/table/RandomTable.h"
#include "tests/verify/Baked.h"

#include <catch2/catch.hpp>
#include <optional>

using namespace tss;

namespace {

/// The table as it is prepared in every form and precision that its motion allows.
std::vector<PreparedTable> allForms(const Table& table) {
    std::vector<PreparedTable> forms;
    for (KernelForm form : {KernelForm::Fold, KernelForm::Direct})
        for (KernelPrecision precision : {KernelPrecision::Float, KernelPrecision::Double})
            for (CellUse cells : {CellUse::Never, CellUse::Always}) {
                try {
                    forms.emplace_back(table, PrepareOptions{KernelTarget::Best, form, precision, cells});
                } catch (const InputError&) { // no fold for this motion
                }
            }
    return forms;
}

} // namespace

TEST_CASE("the kernels of random tables keep what they promise about rounding, in every form and precision") {
    int folds = 0, directs = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        random_table::Random random(seed);
        const Table table = random_table::anyTable(random);
        const TriedPoses poses = posesToTry(table);
        for (const PreparedTable& prepared : allForms(table)) {
            const KernelVerdict verdict = verifyKernel(table, prepared, poses);
            INFO(name(prepared.form()) << " " << name(prepared.precision()) << ": " << verdict.reason);
            CHECK(verdict.proven);
            CHECK(verdict.seen <= verdict.gapOff);
            ++(prepared.form() == KernelForm::Fold ? folds : directs);
        }
    }
    CHECK(folds > 20);
    CHECK(directs > 100);
}

TEST_CASE(
    "the kernels of bodies far from their axes, and of turns many times round, keep their promise too") {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        random_table::Random random(seed);
        const bool wide = seed % 2;
        Motion motion = random_table::motion(random, wide ? 4 + int(random() % 4) : 1 + int(random() % 3), 1);
        if (wide)
            for (Dof& dof : motion.dofs) {
                if (dof.kind != DofKind::Rotation) continue;
                dof.upper = std::pow(10.0, random_table::between(random, 1, 4.5));
                dof.lower = -0.5 * dof.upper;
            }
        Table table = random_table::table(random, motion, 6, 6, 1);
        if (!wide) { // all of B moved along, and A after it
            const Vec3 away =
                std::pow(10.0, random_table::between(random, 3, 5)) * random_table::direction(random);
            for (std::size_t k = 0; k < table.b.size(); ++k) {
                Sphere &a = table.a[k], &b = table.b[k];
                b.centre += away;
                const double apart = a.radius + b.radius + random_table::between(random, -0.01, 0.03);
                a.centre = pose(motion, random_table::values(random, motion)) * b.centre +
                           apart * random_table::direction(random);
            }
        }
        const TriedPoses poses = posesToTry(table);
        for (const PreparedTable& prepared : allForms(table)) {
            const KernelVerdict verdict = verifyKernel(table, prepared, poses);
            INFO(name(prepared.form()) << " " << name(prepared.precision()) << ": " << verdict.reason);
            CHECK(verdict.proven);
            Table moved = table;
            for (Sphere& s : moved.b) s.centre.x() += 200 * prepared.signBand() + 1e-5;
            CHECK_FALSE(verifyKernel(moved, prepared, posesToTry(moved)).proven);
        }
    }
}

TEST_CASE("tests that no touch is deep enough for say no contact early") {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        random_table::Random random(seed);
        Table table = random_table::anyTable(random);
        table.restGaps.resize(table.testCount(), 0);
        for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i)
            for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; k += 2)
                table.restGaps[k] =
                    static_cast<float>(-1.5 * (table.a[i].radius + table.b[table.columns[k]].radius));
        const TriedPoses poses = posesToTry(table);
        for (const PreparedTable& prepared : allForms(table)) {
            const KernelVerdict verdict = verifyKernel(table, prepared, poses);
            INFO(name(prepared.form()) << " " << name(prepared.precision()) << ": " << verdict.reason);
            CHECK(verdict.proven);
        }
    }
}

TEST_CASE("a kernel made from other spheres or another axis is refused") {
    int tried = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const scenes::Scene scene = scenes::randomScene(seed, 1 + int(seed % 3), 30, false);
        const Table table = baked(scene);
        if (table.testCount() < 2) continue;
        for (const PreparedTable& prepared : allForms(table)) {
            INFO(name(prepared.form()) << " " << name(prepared.precision()));
            REQUIRE(verifyKernel(table, prepared, posesToTry(table)).proven);
            Table larger = table, smaller = table, moved = table, turned = table;
            const double little = 20 * prepared.signBand() + 1e-9;
            for (Sphere& s : larger.a) s.radius += little;
            for (Sphere& s : smaller.a) s.radius -= little;
            for (Sphere& s : moved.b) s.centre.x() += 10 * little;
            turned.motion.base.translation().z() += 10 * little;
            for (const Table* other : {&larger, &smaller, &moved, &turned}) {
                CHECK_FALSE(verifyKernel(*other, prepared, posesToTry(*other)).proven);
                ++tried;
            }
        }
    }
    CHECK(tried >= 4 * 20);
}

namespace {

/// Whether some cell is divided.
bool hasParts(const VerdictGrid& grid) {
    std::array<std::uint32_t, 3> step{1, 1, 1}, end{1, 1, 1};
    for (std::size_t k = 0; k < 3; ++k) step[k] = grid.partsPerCell(k), end[k] = grid.cellCount(k) * step[k];
    VerdictGrid::Place at{};
    for (at[2] = 0; at[2] < end[2]; at[2] += step[2])
        for (at[1] = 0; at[1] < end[1]; at[1] += step[1])
            for (at[0] = 0; at[0] < end[0]; at[0] += step[0])
                if (grid.divided(at)) return true;
    return false;
}

} // namespace

namespace {

/// Whether what the grid says of some of many poses is not so of these tests.
bool shownWrong(const Table& table, const VerdictGrid& grid) {
    scenes::Random random(7);
    for (int k = 0; k < 3000; ++k) {
        const std::vector<double> q = scenes::randomPose(random, table.motion);
        const Verdict verdict = grid.verdict(q.data());
        const double gap = query(table, q).gap;
        if ((verdict == Verdict::Touch && gap > 1e-6) || (verdict == Verdict::Free && gap < -1e-6))
            return true;
    }
    return false;
}

} // namespace

TEST_CASE("verdicts made for other spheres are refused, and for the right ones proven") {
    int tried = 0, refused = 0, pieces = 0, divided = 0;
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        const Table table = baked(scenes::randomScene(seed, 1 + int(seed % 3), 30, false));
        if (table.testCount() < 2) continue;
        const PreparedTable prepared(table);
        if (prepared.verdicts().empty()) continue;
        REQUIRE(verify::refuteVerdicts(table, prepared) == "");
        pieces += !prepared.verdicts().pieces().empty();
        divided += hasParts(prepared.verdicts());
        double radius = 0;
        for (const Sphere& s : table.a) radius = std::max(radius, s.radius);
        Table larger = table, smaller = table;
        for (Sphere& s : larger.a) s.radius += 0.2 * radius;
        for (Sphere& s : smaller.a) s.radius -= 0.2 * radius;
        for (const Table* other : {&larger, &smaller}) {
            const bool isRefused = verify::refuteVerdicts(*other, prepared) != "";
            CHECK((isRefused || !shownWrong(*other, prepared.verdicts())));
            refused += isRefused;
        }
        ++tried;
    }
    CHECK(tried >= 15);
    CHECK(refused >= 1.8 * tried); // what never touches may go on so with other spheres
    CHECK(pieces >= 5);
    CHECK(divided >= 5);
}

TEST_CASE("how far apart verdicts say that bodies stay is proven too") {
    Motion motion;
    motion.dofs = {joints::slide(Vec3::UnitX(), 0, 1), joints::slide(Vec3::UnitY(), 0, 1)};
    const SphereSet a{{Vec3(3.1, 0, 0), 1}, {Vec3(3.1, 3, 0), 1}}, b{{Vec3::Zero(), 1}};
    const Table table = makeTable(a, b, {{0, 0}, {1, 0}}, {}, motion);
    const PreparedTable prepared(table);
    REQUIRE_FALSE(prepared.verdicts().empty());
    CHECK(verify::refuteVerdicts(table, prepared) == "");
    Table nearer = table; // free everywhere all the same
    for (Sphere& s : nearer.a) s.radius += 0.09;
    CHECK(verify::refuteVerdicts(nearer, prepared) != "");
}

TEST_CASE("clusters made for other spheres are refused, and for the right ones proven") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        random_table::Random random(seed);
        const Motion motion = random_table::motion(random, 4 + int(seed % 3), 1, false);
        const Table table = random_table::table(random, motion, 50, 50, 1);
        const PreparedTable prepared(table);
        REQUIRE_FALSE(prepared.kernels().clusters().empty());
        const KernelVerdict verdict = verifyKernel(table, prepared, posesToTry(table));
        CAPTURE(verdict.reason);
        REQUIRE(verdict.proven);
        std::vector<verify::Exact> tests = verify::exactTests(table);
        const double posed = 0;
        REQUIRE(verify::refuteClusters(prepared, tests, posed) == "");
        // One that reaches farther, one that lies elsewhere, one too few.
        const std::size_t some = tests.size() / 3;
        std::vector<verify::Exact> larger = tests, moved = tests;
        larger[some].contactDistance += 1;
        moved[some].b.x() += 1;
        CHECK(verify::refuteClusters(prepared, larger, posed) != "");
        CHECK(verify::refuteClusters(prepared, moved, posed) != "");
        tests.pop_back();
        CHECK(verify::refuteClusters(prepared, tests, posed) != "");
        // What rounding may do is not said to be more than there is room for.
        CHECK(verify::refuteClusters(prepared, verify::exactTests(table), 1) != "");
        // What is asked first is these tests and no others.
        const KernelData& first = prepared.kernels().likelyTests().rows;
        std::vector<std::uint32_t> likely = prepared.kernels().likely();
        CHECK(verify::rowsAreTests(prepared, first, likely));
        likely[0] = (likely[0] + 1) % static_cast<std::uint32_t>(prepared.testCount());
        CHECK_FALSE(verify::rowsAreTests(prepared, first, likely));
        likely = prepared.kernels().likely();
        likely.pop_back();
        CHECK_FALSE(verify::rowsAreTests(prepared, first, likely));
    }
}

TEST_CASE("cells made for other spheres are refused, and for the right ones proven") {
    int tried = 0, refused = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const Table table = baked(scenes::randomScene(seed, 1 + int(seed % 3), 30, false));
        if (table.testCount() < 2) continue;
        PrepareOptions withCells;
        withCells.cells = CellUse::Always;
        const PreparedTable prepared(table, withCells);
        if (prepared.kernels().cells().empty()) continue;
        REQUIRE(verify::refuteCells(table, prepared) == "");
        const TableCells& cells = prepared.kernels().cells();
        // As large as some ball on the joint moves within a cell: some cell's word must break.
        double move = 0;
        DofValues speeds{};
        for (const Sphere& b : table.b) {
            speedBounds(table.motion, b.centre, speeds.data());
            double sum = 0;
            for (std::size_t k = 0; k < table.motion.dofCount(); ++k) sum += speeds[k] * cells.box(1).half[k];
            move = std::max(move, sum);
        }
        Table larger = table, smaller = table;
        for (Sphere& s : larger.a) s.radius += 2 * move;
        for (Sphere& s : smaller.a) s.radius -= 2 * move;
        refused += verify::refuteCells(larger, prepared) != "";
        refused += verify::refuteCells(smaller, prepared) != "";
        ++tried;
    }
    CHECK(tried >= 20);
    CHECK(refused >= 1.9 * tried);
}
