#include "bake/base/Parallel.h"
#include "bake/search/NearSurface.h"
#include "bake/search/UndecidedCells.h"
#include "tests/geometry/TestMeshes.h"
#include "tests/search/Scenes.h"

#include <catch2/catch.hpp>

using namespace tss;
using scenes::Random;

namespace {

std::vector<double> poseIn(Random& random, const Motion& motion) {
    for (;;) {
        std::vector<double> q;
        for (const Dof& dof : motion.dofs) q.push_back(random.in(dof.lower, dof.upper));
        if (withinLimits(motion, q)) return q;
    }
}

bool contains(const CellTree& tree, const std::vector<double>& q) {
    for (std::size_t k = 0; k < q.size(); ++k)
        if (q[k] < tree.cell.lower[k] || q[k] > tree.cell.upper[k]) return false;
    if (tree.children.empty()) return true;
    for (const CellTree& child : tree.children)
        if (contains(child, q)) return true;
    return false;
}

/// The smallest gap at a pose of the spheres, or of the balls inside, without the pairs of the region.
double gapAt(const LevelSpheres& a, const LevelSpheres& b, const Motion& motion, const std::vector<double>& q,
             bool inner) {
    const Pose at = pose(motion, q);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < a.spheres.size(); ++i)
        for (std::size_t j = 0; j < b.spheres.size(); ++j) {
            if (!a.region.empty() && !b.region.empty() && a.region[i] && b.region[j]) continue;
            const double sum = inner ? a.inner[i] + b.inner[j] : a.spheres[i].radius + b.spheres[j].radius;
            best = std::min(best, (at * b.spheres[j].centre - a.spheres[i].centre).norm() - sum);
        }
    return best;
}

LevelSpheres cloud(Random& random, int count, const Vec3& about, double size, bool region = false) {
    LevelSpheres level;
    for (int i = 0; i < count; ++i) {
        level.spheres.push_back({about + random.inBox(size), random.in(0.04, 0.3)});
        level.inner.push_back(level.spheres.back().radius - random.in(0.01, 0.03));
        if (region) level.region.push_back(random.below(2) != 0);
    }
    return level;
}

Motion randomMotion(Random& random) {
    Motion motion;
    motion.dofs.push_back(joints::turn(random.inBox(1), random.direction(), -0.8, 0.9));
    motion.dofs.push_back(random.below(2) ? joints::turn(random.inBox(1), random.direction(), -0.3, 0.3)
                                          : joints::slide(random.direction(), -0.2, 0.3));
    motion.base.translation() = random.inBox(0.2);
    return motion;
}

UndecidedOptions within(double resolution) {
    UndecidedOptions options;
    options.resolution = resolution;
    return options;
}

} // namespace

TEST_CASE("a pose that is no longer open is a true hit or truly free") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u, 6u);
    CAPTURE(seed);
    Random random(seed);
    const Motion motion = randomMotion(random);
    const bool region = seed % 2 == 0;
    const LevelSpheres a = cloud(random, 30, {0, 0, 0}, 0.5, region),
                       b = cloud(random, 30, {0.9, 0.3, 0}, 0.5, region);
    const Undecided left = undecidedCells(a, b, motion, wholeQ(motion), within(0.02));
    int open = 0, hits = 0, free = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::vector<double> q = poseIn(random, motion);
        if (left.cells && contains(*left.cells, q)) {
            ++open;
            continue;
        }
        const bool isFree = gapAt(a, b, motion, q, false) > 0;
        const bool isHit = gapAt(a, b, motion, q, true) <= 0;
        CHECK((isFree || isHit));
        hits += isHit;
        free += isFree;
    }
    CHECK((hits == 0 || left.hits));
    CHECK(open < 2000);
    CHECK(hits + free > 0);
}

TEST_CASE("poses within the margin and contacts less deep than asked stay open") {
    Random random(7);
    const Motion motion = randomMotion(random);
    const LevelSpheres a = cloud(random, 20, {0, 0, 0}, 0.4), b = cloud(random, 20, {0.8, 0.3, 0}, 0.4);
    UndecidedOptions options = within(0.02);
    options.margin = 0.1;
    options.depth = 0.05;
    const Undecided left = undecidedCells(a, b, motion, wholeQ(motion), options);
    REQUIRE(left.cells);
    for (int i = 0; i < 1000; ++i) {
        const std::vector<double> q = poseIn(random, motion);
        const bool wanted = gapAt(a, b, motion, q, false) <= 0.1 && gapAt(a, b, motion, q, true) > -0.05;
        if (wanted) CHECK(contains(*left.cells, q));
    }
}

TEST_CASE("going on from the cells left finds what the search from the beginning finds") {
    Random random(8);
    const Motion motion = randomMotion(random);
    const LevelSpheres a = cloud(random, 20, {0, 0, 0}, 0.4), b = cloud(random, 20, {0.8, 0.3, 0}, 0.4);
    const Undecided coarse = undecidedCells(a, b, motion, wholeQ(motion), within(0.1));
    REQUIRE(coarse.cells);
    const Undecided fine = undecidedCells(a, b, motion, *coarse.cells, within(0.01));
    const Undecided direct = undecidedCells(a, b, motion, wholeQ(motion), within(0.01));
    REQUIRE((fine.cells && direct.cells));
    CHECK(fine.cells->leaves() >= coarse.cells->leaves());
    int differ = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::vector<double> q = poseIn(random, motion);
        differ += contains(*fine.cells, q) != contains(*direct.cells, q);
    }
    CHECK(differ == 0);
}

TEST_CASE("spheres far apart leave nothing to decide and no hit") {
    Random random(9);
    const Motion motion = randomMotion(random);
    const LevelSpheres a = cloud(random, 5, {0, 0, 0}, 0.1), b = cloud(random, 5, {40, 0, 0}, 0.1);
    const Undecided left = undecidedCells(a, b, motion, wholeQ(motion), within(0.01));
    CHECK_FALSE(left.cells);
    CHECK_FALSE(left.hits);
}

TEST_CASE("every piece of surface that comes near the other body is within reach") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
    CAPTURE(seed);
    Random random(seed);
    std::mt19937_64 engine(seed);
    const Motion motion = randomMotion(random);
    const TriangleMesh a = test::lumpyMesh(engine, 2, 0.3);
    const TriangleMesh b = test::transformed(test::lumpyMesh(engine, 2, 0.3),
                                             Eigen::Affine3d(Eigen::Translation3d(1.3, 0.3, 0.2)));
    const MeshQuery queryA(a), queryB(b);
    const double margin = seed % 2 ? 0.0 : 0.1, size = 0.05;
    const std::vector<Patch> zoneA =
        findNearSurface(patchesOf(a), Side::A, queryB, motion, wholeQ(motion), size, margin);
    const std::vector<Patch> zoneB =
        findNearSurface(patchesOf(b), Side::B, queryA, motion, wholeQ(motion), size, margin);
    for (const Patch& patch : zoneA) CHECK(patch.radius() <= size);
    const auto distance = [](const std::vector<Patch>& zone, const Vec3& p) {
        TriangleMesh mesh;
        for (const Patch& patch : zone) {
            const auto first = static_cast<int>(mesh.vertices.size());
            mesh.vertices.insert(mesh.vertices.end(), patch.corners.begin(), patch.corners.end());
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        return MeshQuery(mesh).distance(p);
    };
    int near = 0;
    for (int i = 0; i < 1000; ++i) {
        const Pose at = pose(motion, poseIn(random, motion));
        const std::size_t t = engine() % a.triangles.size();
        const double u = random.in(0, 1), v = random.in(0, 1 - u);
        const Vec3 onA = (1 - u - v) * a.corner(t, 0) + u * a.corner(t, 1) + v * a.corner(t, 2);
        const Vec3 onB = (1 - u - v) * b.corner(t, 0) + u * b.corner(t, 1) + v * b.corner(t, 2);
        if (queryB.distance(at.inverse() * onA) <= margin) {
            CHECK(distance(zoneA, onA) < 1e-9);
            ++near;
        }
        if (queryA.distance(at * onB) <= margin) {
            CHECK(distance(zoneB, onB) < 1e-9);
            ++near;
        }
    }
    CHECK((near > 0 || margin == 0)); // that a random point lies exactly on the other is not to be had
}

TEST_CASE("a slide brings only the faces that look at each other within reach") {
    Motion motion;
    motion.dofs.push_back(joints::slide(Vec3::UnitX(), 0, 0.5));
    const TriangleMesh a = boxMesh({0, 0, 0}, {1, 1, 1}), b = boxMesh({-1, 0, 0}, {-0.4, 1, 1});
    const MeshQuery queryA(a), queryB(b);
    for (const auto& [side, mesh, other, x] :
         {std::tuple(Side::A, &a, &queryB, 0.0), std::tuple(Side::B, &b, &queryA, -0.4)}) {
        double area = 0;
        for (const Patch& patch :
             findNearSurface(patchesOf(*mesh), side, *other, motion, wholeQ(motion), 0.02, 0)) {
            area += patch.area();
            for (const Vec3& c : patch.corners) CHECK(std::abs(c.x() - x) < 0.2);
        }
        CHECK(area >= 1); // the face, all of it
        CHECK(area < 1.8);
    }
    CHECK(findNearSurface(patchesOf(a), Side::A, MeshQuery(boxMesh({-9, 0, 0}, {-8, 1, 1})), motion,
                          wholeQ(motion), 0.02, 0)
              .empty());
}

TEST_CASE("reach and undecided cells are the same for any number of threads") {
    Random random(10);
    std::mt19937_64 engine(10);
    const Motion motion = randomMotion(random);
    const TriangleMesh a = test::lumpyMesh(engine, 2, 0.3);
    const MeshQuery b(test::transformed(a, Eigen::Affine3d(Eigen::Translation3d(2, 0, 0))));
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        std::vector<double> corners;
        for (const Patch& p : findNearSurface(patchesOf(a), Side::A, b, motion, wholeQ(motion), 0.1, 0))
            corners.insert(corners.end(), {p.corners[0].x(), p.corners[1].y(), p.corners[2].z()});
        return corners;
    };
    const std::vector<double> one = run(1);
    CHECK(one.size() > 0);
    CHECK(one == run(2));
}
