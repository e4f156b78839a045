#include "bake/respond/JointQp.h"
#include "tests/table/RandomTable.h"

#include <bit>
#include <catch2/catch.hpp>

using namespace tss;
using random_table::between;
using random_table::Random;

namespace {

std::vector<QpRow> randomRows(Random& random, int n, int count) {
    std::vector<QpRow> rows(count);
    for (QpRow& row : rows) {
        double squared = 0;
        for (int l = 0; l < n; ++l) {
            row.normal[l] = between(random, -1, 1);
            squared += row.normal[l] * row.normal[l];
        }
        for (int l = 0; l < n; ++l) row.normal[l] /= std::sqrt(squared);
        row.bound = between(random, -1, 0.5);
    }
    return rows;
}

double excess(int n, const QpRow& row, const JointValues& y) {
    double sum = -row.bound;
    for (int l = 0; l < n; ++l) sum += row.normal[l] * y[l];
    return sum;
}

/// The least length of a point that meets all rows, by trying every set of rows that could hold with
/// equality; infinity where no point does.
double leastLength(int n, const std::vector<QpRow>& rows) {
    double least = std::numeric_limits<double>::infinity();
    for (unsigned set = 0; set < 1u << rows.size(); ++set) {
        const int count = std::popcount(set);
        if (count > n) continue;
        Eigen::MatrixXd normals(count, n);
        Eigen::VectorXd bounds(count);
        for (unsigned i = 0, k = 0; i < rows.size(); ++i) {
            if (!(set >> i & 1)) continue;
            normals.row(k) = Eigen::Map<const Eigen::RowVectorXd>(rows[i].normal.data(), n);
            bounds(k++) = rows[i].bound;
        }
        JointValues y{};
        if (count > 0)
            Eigen::Map<Eigen::VectorXd>(y.data(), n) =
                normals.completeOrthogonalDecomposition().solve(bounds);
        if (std::all_of(rows.begin(), rows.end(),
                        [&](const QpRow& row) { return excess(n, row, y) > -1e-9; }))
            least = std::min(least, Eigen::Map<Eigen::VectorXd>(y.data(), n).norm());
    }
    return least;
}

} // namespace

TEST_CASE("the nearest point under linear demands is the nearest of all corners, edges and faces") {
    int solved = 0, active = 0, refused = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const int n = 1 + int(random() % 5);
        const std::vector<QpRow> rows = randomRows(random, n, 1 + int(random() % 9));
        const double least = leastLength(n, rows);
        JointValues y;
        if (!nearestToOrigin(n, rows.data(), int(rows.size()), 1e-12, y)) {
            REQUIRE(least == std::numeric_limits<double>::infinity());
            ++refused;
            continue;
        }
        ++solved;
        REQUIRE(Eigen::Map<Eigen::VectorXd>(y.data(), n).norm() == Approx(least).epsilon(1e-8).margin(1e-9));
        for (const QpRow& row : rows) {
            REQUIRE(excess(n, row, y) > -1e-9);
            active += excess(n, row, y) < 1e-9;
        }
    }
    CHECK(solved > 100);
    CHECK(active > 100);
    CHECK(refused > 10);
}

TEST_CASE("demands that contradict each other are told") {
    QpRow left{{1, 0}, 1}, right{{-1, 0}, 1}, up{{0, 1}, 3};
    const QpRow rows[] = {up, left, right};
    JointValues y;
    CHECK_FALSE(nearestToOrigin(2, rows, 3, 1e-12, y));
    CHECK(nearestToOrigin(2, rows, 2, 1e-12, y));
    CHECK(y[0] == Approx(1));
    CHECK(y[1] == Approx(3));
}

TEST_CASE("the same demand many times over is one demand") {
    const std::vector<QpRow> rows(10, QpRow{{0.6, 0.8}, 2});
    JointValues y;
    REQUIRE(nearestToOrigin(2, rows.data(), 10, 1e-12, y));
    CHECK(y[0] == Approx(1.2));
    CHECK(y[1] == Approx(1.6));
}
