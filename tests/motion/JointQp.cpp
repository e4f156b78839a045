#include "bake/motion/JointQp.h"
#include "tests/table/RandomTable.h"

#include <bit>
#include <catch2/catch.hpp>

using namespace tss;
using random_table::between;
using random_table::Random;

namespace {

QpRows randomRows(Random& random, int n, int count) {
    QpRows rows{std::size_t(count)};
    rows.clear(n);
    for (int i = 0; i < count; ++i) {
        double* row = rows.add();
        double squared = 0;
        for (int l = 0; l < n; ++l) {
            row[l] = between(random, -1, 1);
            squared += row[l] * row[l];
        }
        for (int l = 0; l < n; ++l) row[l] /= std::sqrt(squared);
        row[n] = between(random, -1, 0.5);
    }
    return rows;
}

QpRows inPlane(std::initializer_list<std::array<double, 3>> demands) {
    QpRows rows(demands.size());
    rows.clear(2);
    for (const std::array<double, 3>& demand : demands) std::copy(demand.begin(), demand.end(), rows.add());
    return rows;
}

double excess(const QpRows& rows, int row, const DofValues& y) {
    double sum = -rows.bound(row);
    for (int l = 0; l < rows.unknowns(); ++l) sum += rows.normal(row)[l] * y[l];
    return sum;
}

double leastExcess(const QpRows& rows, const DofValues& y) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < rows.count(); ++i) least = std::min(least, excess(rows, i, y));
    return least;
}

/// The least length of a point that meets all rows, by trying every set of rows that could hold with
/// equality; infinity where no point does.
double leastLength(const QpRows& rows) {
    const int n = rows.unknowns();
    double least = std::numeric_limits<double>::infinity();
    for (unsigned set = 0; set < 1u << rows.count(); ++set) {
        const int count = std::popcount(set);
        if (count > n) continue;
        Eigen::MatrixXd normals(count, n);
        Eigen::VectorXd bounds(count);
        for (int i = 0, k = 0; i < rows.count(); ++i) {
            if (!(set >> i & 1)) continue;
            normals.row(k) = Eigen::Map<const Eigen::RowVectorXd>(rows.normal(i), n);
            bounds(k++) = rows.bound(i);
        }
        DofValues y{};
        if (count > 0)
            Eigen::Map<Eigen::VectorXd>(y.data(), n) =
                normals.completeOrthogonalDecomposition().solve(bounds);
        if (leastExcess(rows, y) > -1e-9)
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
        const QpRows rows = randomRows(random, n, 1 + int(random() % 9));
        const double least = leastLength(rows);
        DofValues y;
        if (!nearestToOrigin(rows, 1e-12, y)) {
            REQUIRE(least == std::numeric_limits<double>::infinity());
            ++refused;
            continue;
        }
        ++solved;
        REQUIRE(Eigen::Map<Eigen::VectorXd>(y.data(), n).norm() == Approx(least).epsilon(1e-8).margin(1e-9));
        REQUIRE(leastExcess(rows, y) > -1e-9);
        for (int i = 0; i < rows.count(); ++i) active += excess(rows, i, y) < 1e-9;
    }
    CHECK(solved > 100);
    CHECK(active > 100);
    CHECK(refused > 10);
}

TEST_CASE("demands that contradict each other are told") {
    DofValues y;
    CHECK_FALSE(nearestToOrigin(inPlane({{0, 1, 3}, {1, 0, 1}, {-1, 0, 1}}), 1e-12, y));
    CHECK(nearestToOrigin(inPlane({{0, 1, 3}, {1, 0, 1}}), 1e-12, y));
    CHECK(y[0] == Approx(1));
    CHECK(y[1] == Approx(3));
}

TEST_CASE("the same demand many times over is one demand") {
    const std::array<double, 3> same{0.6, 0.8, 2};
    DofValues y;
    REQUIRE(nearestToOrigin(inPlane({same, same, same, same, same, same}), 1e-12, y));
    CHECK(y[0] == Approx(1.2));
    CHECK(y[1] == Approx(1.6));
}
