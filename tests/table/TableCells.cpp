#include "bake/table/TableKernels.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace tss;
using random_table::Random;

TEST_CASE("codes never fall as gaps rise, and contact is told from clearance to the last bit") {
    Random random(3);
    const Table table = random_table::anyTable(random);
    const TableCells cells(table.motion, tablePairs(table), 8);
    CHECK(cells.code(0.0) == TableCells::contactCode);
    CHECK(cells.code(-1e-300) == TableCells::contactCode);
    CHECK(cells.code(std::numeric_limits<double>::denorm_min()) > TableCells::contactCode);
    CHECK(cells.code(std::numeric_limits<double>::infinity()) == TableCells::farCode);
    CHECK(cells.code(-std::numeric_limits<double>::infinity()) == 0);
    std::vector<double> gaps;
    for (int i = 0; i < 20000; ++i)
        gaps.push_back((i % 2 ? 1 : -1) * std::pow(10.0, random_table::between(random, -12, 6)));
    std::sort(gaps.begin(), gaps.end());
    for (std::size_t i = 1; i < gaps.size(); ++i) REQUIRE(cells.code(gaps[i - 1]) <= cells.code(gaps[i]));
}

TEST_CASE("the cell of a pose says nothing of its tests that is not so there") {
    long left = 0, touching = 0, apart = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Table table = random_table::anyTable(random);
        const std::vector<TablePair> pairs = tablePairs(table);
        constexpr std::uint32_t lanes = 4;
        const TableCells cells(table.motion, pairs, lanes);
        for (int i = 0; i < 300; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            const std::uint32_t row = cells.rowAt(q.data());
            REQUIRE(row >= 1);
            REQUIRE(row < cells.rowCount());
            const TableCells::Box box = cells.box(row);
            for (std::size_t k = 0; k < q.size(); ++k)
                REQUIRE(std::abs(q[k] - box.centre[k]) <= box.half[k] * (1 + 1e-9));
            long double least = std::numeric_limits<long double>::infinity();
            for (const TablePair& pair : pairs) least = std::min(least, exact::gap(table.motion, pair, q));
            if (cells.allTouch(row)) REQUIRE(least <= 0);
            if (cells.noneTouches(row)) REQUIRE(least > 0);
            touching += cells.allTouch(row);
            apart += cells.noneTouches(row);
            REQUIRE(cells.code(double(least)) <= cells.reachedCode(row));
            for (std::size_t place = 0; place < pairs.size(); ++place) {
                const std::uint8_t code = cells.blockCode(row, std::uint32_t(place / lanes));
                const long double gap = exact::gap(table.motion, pairs[cells.order()[place]], q);
                REQUIRE(cells.code(double(gap)) >= std::min(code, TableCells::nearCode));
                if (code > cells.reachedCode(row)) REQUIRE(gap >= least);
                left += code > TableCells::contactCode;
            }
        }
    }
    CHECK(left > 10000);
    CHECK(touching > 1000);
    CHECK(apart > 1000);
}

TEST_CASE("a pose beyond the limits is in no cell, and there every block may touch") {
    Random random(5);
    const Table table = random_table::anyTable(random);
    const std::vector<TablePair> pairs = tablePairs(table);
    const TableCells cells(table.motion, pairs, 1);
    std::vector<double> q = restValues(table.motion);
    const Dof& dof = table.motion.dofs[0];
    for (double bad : {dof.lower - 0.01 * (dof.upper - dof.lower), dof.upper + 0.01 * (dof.upper - dof.lower),
                       1e300, -1e300}) {
        q[0] = bad;
        CHECK(cells.rowAt(q.data()) == 0);
    }
    q[0] = dof.lower;
    CHECK(cells.rowAt(q.data()) > 0);
    q[0] = dof.upper;
    CHECK(cells.rowAt(q.data()) > 0);
    CHECK_FALSE(cells.allTouch(0));
    CHECK_FALSE(cells.noneTouches(0));
    for (std::uint32_t block = 0; block < pairs.size(); ++block) CHECK(cells.blockCode(0, block) == 0);
}

TEST_CASE("a DOF without a range takes no cell away from the others") {
    Random random(7);
    Motion motion = random_table::motion(random, 2, 1, false);
    for (double at : {0.0, 0.25}) {
        motion.dofs[1].lower = motion.dofs[1].upper = motion.dofs[1].rest = at;
        const Table table = random_table::table(random, motion, 12, 12, 20);
        const TableCells cells(table.motion, tablePairs(table), 4);
        CHECK(cells.rowCount() > 2);
        for (int i = 0; i < 100; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            REQUIRE(cells.rowAt(q.data()) > 0);
        }
    }
}

TEST_CASE("tests that no DOF moves have no cells, and all under a margin are found") {
    Motion motion;
    Dof turn;
    turn.kind = DofKind::Rotation;
    turn.axis = Vec3::UnitZ();
    turn.lower = -1;
    turn.upper = 1;
    motion.dofs.push_back(turn);
    SphereSet a, b;
    std::vector<SpherePair> pairs;
    for (std::uint32_t i = 0; i < 100; ++i) {
        a.push_back({Vec3(3 + 0.01 * i, 0, 0), 1});
        b.push_back({Vec3::Zero(), 1}); // on the axis
        pairs.push_back({i, i});
    }
    const Table table = makeTable(a, b, pairs, {}, motion);
    for (CellUse use : {CellUse::Auto, CellUse::Always}) {
        PrepareOptions options;
        options.cells = use;
        const PreparedTable prepared(table, options);
        CHECK(prepared.kernels().cells().empty());
        std::vector<std::uint32_t> found(prepared.testRoom());
        const double q = 0.5;
        CHECK(prepared.testsWithin(&q, 2.5, found.data()) == 100);
        CHECK_FALSE(prepared.hit(&q));
    }
}
