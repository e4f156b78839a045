#include "bake/respond/SkinSolver.h"
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <random>

using namespace tss;

namespace {

constexpr int side = 48; // vertices: more than a block of constraints has

/// A grid of springs with Laplacians, random directions, masses and compliances, some vertices fixed; bends
/// of several sizes and weighted ones along two sides.
struct RandomSheet {
    SkinSheet sheet;
    std::vector<Move> reference;
    std::mt19937_64 random{3};

    float any(double least, double most) {
        return static_cast<float>(std::uniform_real_distribution<double>(least, most)(random));
    }
    Move move(double size) { return {any(-size, size), any(-size, size), any(-size, size), 0}; }

    RandomSheet() {
        for (int v = 0; v < side * side; ++v) {
            sheet.inverseMass.push_back(v % 37 == 0 ? 0 : any(0.2, 1));
            reference.push_back(v % 37 == 0 ? Move(Move::Zero()) : move(1));
        }
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                if (x + 1 < side) addEdge(x, y, x + 1, y);
                if (y + 1 < side) addEdge(x, y, x, y + 1);
                addBend(x, y);
            }
    }

    static std::uint32_t at(int x, int y) { return static_cast<std::uint32_t>(y * side + x); }

    void addEdge(int x, int y, int x2, int y2) {
        SheetEdge edge;
        edge.direction = move(1).normalized();
        edge.i = at(x, y);
        edge.j = at(x2, y2);
        const float mass = sheet.inverseMass[edge.i] + sheet.inverseMass[edge.j];
        edge.compliance = any(0.5, 2);
        edge.inverse = 1 / (mass + edge.compliance);
        sheet.edges.push_back(edge);
    }

    void addBend(int x, int y) {
        SheetBend bend;
        bend.centre = at(x, y);
        bend.first = static_cast<std::uint32_t>(sheet.ring.size());
        if (sheet.inverseMass[bend.centre] == 0) return;
        const bool weighted = y == 0 || y == side - 1;
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
            const bool inside = x + dx >= 0 && x + dx < side && y + dy >= 0 && y + dy < side;
            if (inside && !(weighted && dy != 0)) sheet.ring.push_back(at(x + dx, y + dy));
        }
        bend.last = static_cast<std::uint32_t>(sheet.ring.size());
        const std::uint32_t size = bend.last - bend.first;
        for (std::uint32_t k = 0; k < size; ++k)
            sheet.ringShare.push_back(weighted && size == 2 ? (k == 0 ? 0.3f : 0.7f)
                                                            : 1.0f / static_cast<float>(size));
        float mass = sheet.inverseMass[bend.centre];
        for (std::uint32_t k = bend.first; k < bend.last; ++k)
            mass += sheet.inverseMass[sheet.ring[k]] * sheet.ringShare[k] * sheet.ringShare[k];
        bend.compliance = any(0.5, 2);
        bend.inverse = 1 / (mass + bend.compliance);
        sheet.bends.push_back(bend);
    }

    /// The minimum, from the normal equations in double.
    std::vector<Vec3> solved() const {
        const int n = side * side;
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * n);
        for (int v = 0; v < n; ++v)
            for (int k = 0; k < 3; ++k) {
                const double w = static_cast<double>(sheet.inverseMass[v]);
                entries.emplace_back(3 * v + k, 3 * v + k, w > 0 ? 1 / w : 1e9);
                right[3 * v + k] = w > 0 ? static_cast<double>(reference[v][k]) / w : 0;
            }
        using Row = std::vector<std::pair<int, double>>;
        const auto add = [&](const Row& row, double compliance) {
            for (const auto& [i, a] : row)
                for (const auto& [j, b] : row) entries.emplace_back(i, j, a * b / compliance);
        };
        for (const SheetEdge& e : sheet.edges) {
            Row row;
            for (int k = 0; k < 3; ++k) {
                row.emplace_back(3 * e.i + k, e.direction[k]);
                row.emplace_back(3 * e.j + k, -e.direction[k]);
            }
            add(row, e.compliance);
        }
        for (const SheetBend& b : sheet.bends)
            for (int k = 0; k < 3; ++k) {
                Row row{{3 * b.centre + k, 1.0}};
                for (std::uint32_t r = b.first; r < b.last; ++r)
                    row.emplace_back(3 * sheet.ring[r] + k, -sheet.ringShare[r]);
                add(row, b.compliance);
            }
        Eigen::SparseMatrix<double> matrix(3 * n, 3 * n);
        matrix.setFromTriplets(entries.begin(), entries.end());
        const Eigen::VectorXd x = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
        std::vector<Vec3> result;
        result.reserve(n);
        for (int v = 0; v < n; ++v) result.emplace_back(x.segment<3>(3 * v));
        return result;
    }
};

double largestDifference(std::span<const Move> a, const std::vector<Vec3>& b) {
    double largest = 0;
    for (std::size_t v = 0; v < b.size(); ++v)
        largest = std::max(largest, (a[v].head<3>().cast<double>() - b[v]).cwiseAbs().maxCoeff());
    return largest;
}

} // namespace

TEST_CASE("every kernel brings a sheet to the minimum of its energy") {
    RandomSheet random;
    const SheetPatch patch = patchOf(random.sheet, std::vector<bool>(side * side, true));
    const std::vector<Vec3> expected = random.solved();
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon, KernelTarget::Best}) {
        if (!available(target)) continue;
        INFO(name(target));
        SkinSolver solver(patch.sheet, target);
        std::vector<SheetPlane> none;
        solver.solve(random.reference, none, 300, 1e-7f);
        CHECK(largestDifference(solver.displacements(), expected) < 1e-5);
        // From the multipliers of before it is there at once.
        CHECK(solver.solve(random.reference, none, 1, 0) < 1e-5f);
    }
}

TEST_CASE("a part of a sheet is solved as if nothing lay around it") {
    RandomSheet random;
    std::vector<bool> inside(side * side);
    for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = v % side < 30;
    const SheetPatch patch = patchOf(random.sheet, inside);
    CHECK(patch.vertices.size() == 30 * side);
    for (std::size_t v = 0; v < inside.size(); ++v) // what is fixed and asked for nothing is not there either
        if (!inside[v]) {
            random.sheet.inverseMass[v] = 0;
            random.reference[v].setZero();
        }
    std::erase_if(random.sheet.edges, [&](const SheetEdge& e) { return !inside[e.i] || !inside[e.j]; });
    std::erase_if(random.sheet.bends, [&](const SheetBend& b) {
        bool whole = inside[b.centre];
        for (std::uint32_t k = b.first; k < b.last; ++k) whole = whole && inside[random.sheet.ring[k]];
        return !whole;
    });
    const std::vector<Vec3> expected = random.solved();
    SkinSolver solver(patch.sheet);
    std::vector<SheetPlane> none;
    std::vector<Move> reference;
    for (const std::uint32_t v : patch.vertices) reference.push_back(random.reference[v]);
    solver.solve(reference, none, 300, 1e-7f);
    std::vector<Vec3> there;
    for (const std::uint32_t v : patch.vertices) there.push_back(expected[v]);
    CHECK(largestDifference(solver.displacements(), there) < 1e-5);
}

TEST_CASE("planes hold what they meet, alone or between three vertices") {
    RandomSheet random;
    const SheetPatch patch = patchOf(random.sheet, std::vector<bool>(side * side, true));
    std::vector<SheetPlane> planes(2);
    planes[0].normal = Move(0, 0, 1, 0);
    planes[0].vertex[0] = 700;
    planes[0].weight[0] = 1;
    planes[0].vertices = 1;
    planes[0].bound = 1.5;
    planes[1].normal = Move(0, 0.6f, 0.8f, 0);
    for (int k = 0; k < 3; ++k) {
        planes[1].vertex[k] = 1500 + static_cast<std::uint32_t>(k);
        planes[1].weight[k] = k == 0 ? 0.5f : 0.25f;
    }
    planes[1].bound = 1;
    SkinSolver solver(patch.sheet);
    solver.solve(random.reference, planes, 300, 1e-7f);
    const std::span<const Move> u = solver.displacements();
    // Held softly: by a hundredth of its inverse mass.
    CHECK(u[700][2] == Approx(1.5 - planes[0].compliance * planes[0].multiplier).margin(1e-4));
    CHECK(u[700][2] > 1.4f);
    float along = 0;
    for (int k = 0; k < 3; ++k) along += planes[1].weight[k] * planes[1].normal.dot(u[planes[1].vertex[k]]);
    CHECK(along == Approx(1 - planes[1].compliance * planes[1].multiplier).margin(1e-4));
    // Nothing pulls: a plane that is kept anyway has no say.
    std::vector<SheetPlane> far = planes;
    for (SheetPlane& p : far) {
        p.bound = -100;
        p.multiplier = 0;
    }
    solver.solve(random.reference, far, 300, 1e-7f);
    CHECK(largestDifference(solver.displacements(), random.solved()) < 1e-5);
}

TEST_CASE("planes that move on are followed where they push, what is not moved is left alone") {
    RandomSheet random;
    const SheetPatch patch = patchOf(random.sheet, std::vector<bool>(side * side, true));
    const std::vector<Move> still(side * side, Move::Zero());
    constexpr float calm = 1e-3f;
    SheetPlane plane;
    plane.normal = Move(0, 0.6f, 0.8f, 0);
    for (int k = 0; k < 3; ++k) {
        plane.vertex[k] = 700 + static_cast<std::uint32_t>(k);
        plane.weight[k] = k == 0 ? 0.5f : 0.25f;
    }
    std::vector<SheetPlane> followed{plane}, solved{plane};
    SkinSolver following(patch.sheet), solving(patch.sheet);
    const auto difference = [&] {
        double largest = 0;
        for (std::size_t v = 0; v < still.size(); ++v)
            largest = std::max(
                largest,
                static_cast<double>(
                    (following.displacements()[v] - solving.displacements()[v]).cwiseAbs().maxCoeff()));
        return largest;
    };
    const auto solve = [&] { solving.solve(still, solved, 300, 1e-7f); };
    std::vector<Move> before;
    for (int step = 1; step <= 50; ++step) {
        followed[0].bound = solved[0].bound = 0.02f * static_cast<float>(step);
        before.assign(following.displacements().begin(), following.displacements().end());
        following.follow(followed, 8, 1e-7f, calm);
        solve();
        INFO("step " << step);
        CHECK(difference() < 4 * calm);
    }
    CHECK(following.slack(followed[0]) > -0.05f);
    std::size_t same = 0;
    for (std::size_t v = 0; v < before.size(); ++v) same += before[v] == following.displacements()[v];
    CHECK(same > still.size() / 2);
    for (int step = 0; step < 600; ++step)
        following.follow(followed, 8, 1e-7f, calm); // longer than rounding adds up
    CHECK(difference() < 4 * calm);
    // A plane that is no longer there has no say, and one that turns pushes the new way.
    followed[0].normal = solved[0].normal = Move(0.8f, 0, 0.6f, 0);
    for (int step = 0; step < 20; ++step) following.follow(followed, 8, 1e-7f, calm);
    solve();
    CHECK(difference() < 4 * calm);
    followed[0].normal = solved[0].normal = Move::Zero();
    for (int step = 0; step < 20; ++step) following.follow(followed, 8, 1e-7f, calm);
    solve();
    CHECK(difference() < 4 * calm);
    CHECK(following.displacements()[700].head<3>().norm() < 4 * calm);
}
