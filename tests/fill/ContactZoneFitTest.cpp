#include "bake/fill/ContactZoneFit.h"

#include "bake/base/Error.h"
#include "bake/spheres/FitMetrics.h"
#include "tests/fill/RealPairs.h"
#include "tests/geometry/TestMeshes.h"

using namespace tss;
using namespace tss::test;
using namespace zone;

namespace {

/// Two lumpy balls, one on a joint of two turns that brings them together.
Scene lumpyPair(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Scene scene;
    scene.a = lumpyMesh(random, 2, 0.3);
    scene.b = transformed(lumpyMesh(random, 2, 0.3), Eigen::Affine3d(Eigen::Translation3d(2.4, 0, 0)));
    scene.motion.dofs = {turn({1.2, 2, 0}, Vec3::UnitZ(), -0.3, 0.3),
                         turn({1.2, 2, 0}, Vec3::UnitX(), -0.2, 0.2)};
    return scene;
}

/// A box that slides by 1 over the unit cube.
Scene slidingOver(TriangleMesh box) {
    Dof slide;
    slide.name = "slide";
    slide.kind = DofKind::Translation;
    slide.upper = 1;
    Scene scene{boxMesh({0, 0, 0}, {1, 1, 1}), std::move(box), {}};
    scene.motion.dofs = {slide};
    return scene;
}

/// A box above the unit cube that comes down on it.
Scene pressedOnto(double gap) {
    Scene scene = slidingOver(boxMesh({0, 0, 1 + gap}, {1, 1, 2}));
    scene.motion.dofs[0].axis = -Vec3::UnitZ();
    return scene;
}

/// 0.0035 apart, which large triangles would tell at once: spheres of 0.004 touch, and patches of the next
/// level are known to be out of reach.
Scene passingClosely() {
    Scene scene = slidingOver(quartered(boxMesh({0.8, 0.48, 1.0035}, {1.8, 0.52, 2}), 5));
    scene.a = quartered(scene.a, 5);
    return scene;
}

void checkApart(const ContactZoneFit& fit, const Motion& motion) {
    const SphereTree a(fit.a.fit.spheres), b(fit.b.fit.spheres);
    for (double q = 0; q <= 1; q += 0.01) CHECK(smallestGap(a, b, pose(motion, std::vector{q}), 1) > 0);
}

} // namespace

TEST_CASE("spheres fine in the contact zone alone miss no contact and claim none beyond their tolerance") {
    const std::uint64_t seed = GENERATE(1u, 2u);
    CAPTURE(seed);
    const Scene scene = lumpyPair(seed);
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.005));
    CHECK(fit.levels.size() > 1);
    CHECK_FALSE(fit.neverMeet);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 0.005, 1000);
}

TEST_CASE("each level has the zone before it covered and its zone is smaller") {
    const Scene scene = lumpyPair(4);
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.003));
    REQUIRE(fit.levels.size() > 1);
    for (std::size_t i = 1; i < fit.levels.size(); ++i) {
        CHECK(fit.levels[i].areaA <= fit.levels[i - 1].areaA);
        CHECK(fit.levels[i].tolerance == Approx(fit.levels[i - 1].tolerance / 2));
        CHECK(fit.levels[i - 1].undecided > 0);
    }
    for (const auto& [mesh, body] : {std::pair(&scene.a, &fit.a), std::pair(&scene.b, &fit.b)}) {
        const FitMetrics metrics = measureFit(Solid(*mesh), body->fit.spheres, body->zone);
        CHECK(metrics.coverage == 0);
        CHECK(metrics.protrusion <= 0.003);
        CHECK(body->fine > 0);
        CHECK(body->fine < body->fit.spheres.size());
        // The coarser ones are inside.
        const SphereSet coarse(body->fit.spheres.begin() + static_cast<std::ptrdiff_t>(body->fine),
                               body->fit.spheres.end());
        CHECK(measureFit(Solid(*mesh), coarse, {}).protrusion < 1e-12);
    }
}

TEST_CASE("bodies that never come near need no spheres") {
    Scene scene = lumpyPair(5);
    scene.b = transformed(scene.b, Eigen::Affine3d(Eigen::Translation3d(50, 0, 0)));
    scene.motion.dofs[0].lower = scene.motion.dofs[1].lower = -0.01;
    scene.motion.dofs[0].upper = scene.motion.dofs[1].upper = 0.01;
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.01));
    CHECK(fit.neverMeet);
    CHECK(fit.a.fit.spheres.empty());
}

TEST_CASE("bodies that pass closely without touching get spheres that show it") {
    // 0.03 apart; the reach of patches of the first level does not tell, the spheres do.
    const Scene scene = slidingOver(boxMesh({-1, 0, 1.03}, {1, 1, 2}));
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.01));
    CHECK(fit.neverMeet);
    checkApart(fit, scene.motion);
}

TEST_CASE("bodies that pass more closely than coarse spheres stick out get finer ones that show it") {
    const Scene scene = passingClosely();
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.0005));
    CHECK(fit.neverMeet);
    REQUIRE(!fit.levels.empty());
    CHECK(fit.levels.front().tolerance > 0.003);
    CHECK(fit.a.fit.protrusion < 0.003);
    CHECK(fit.a.fit.note.empty());
    checkApart(fit, scene.motion);
}

TEST_CASE("where a limit on spheres keeps bodies that never meet from being told apart, that is said") {
    const Scene scene = passingClosely();
    ContactZoneOptions options = tolerance(0.0005);
    const ContactZoneLevel first = fitContactZone(scene.a, scene.b, scene.motion, options).levels.front();
    options.maxSpheres = static_cast<int>(std::max(first.spheresA, first.spheresB));
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, options);
    CHECK(fit.neverMeet);
    CHECK(fit.a.fit.protrusion > 0.002);
    CHECK(fit.a.fit.note.find("spheres do not suffice") != std::string::npos);
}

TEST_CASE("faces too near to each other at rest are refused soon, with a clearance that can be had") {
    for (const double clearance : {1e-6, 1e-3}) {
        CAPTURE(clearance);
        ContactZoneOptions options = tolerance(0.02);
        options.atRest = AtRest::Offset;
        if (clearance == 1e-3) options.medial.mostPatches = 100'000; // they would do, of so large a gap
        const auto fitted = [&](double gap, const Progress& progress) {
            const Scene scene = pressedOnto(gap);
            return fitContactZone(scene.a, scene.b, scene.motion, options, progress);
        };
        int asked = 0; // once for every so many patches
        std::string refusal;
        try {
            fitted(clearance,
                   [&](std::string_view step, double) { return (asked += step == "patches") < 1000; });
        } catch (const RestTooClose& error) {
            refusal = error.message;
        }
        INFO(refusal);
        CHECK(asked < 200);
        const auto lengthAfter = [&](const std::string& words) {
            const std::size_t at = refusal.find(words);
            REQUIRE(at != std::string::npos);
            return std::stod(refusal.substr(at + words.size()));
        };
        const double proposed = lengthAfter("expected a clearance of at least ");
        CHECK(proposed > 2 * clearance);
        CHECK(proposed < 0.1);
        CHECK(lengthAfter("need a tolerance of ") == Approx(0.38 * clearance).epsilon(0.1));
        if (clearance == 1e-3) CHECK(fitted(proposed, {}).a.fit.coverage == 0);
        options.atRest = AtRest::Collide; // the other proposal
        CHECK(fitted(clearance, {}).a.fit.coverage == 0);
    }
}

TEST_CASE("a limit on spheres keeps the finest level that fits and says so") {
    const Scene scene = lumpyPair(6);
    ContactZoneOptions options = tolerance(0.004);
    options.maxSpheres = 150;
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, options);
    CHECK(fit.a.fit.note.find("150 spheres do not suffice") != std::string::npos);
    CHECK(fit.a.fit.spheres.size() <= 150);
    CHECK(fit.b.fit.spheres.size() <= 150);
    CHECK(fit.a.fit.protrusion > 0.004);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, fit.levels.back().tolerance, 1000);
}

TEST_CASE("of many degrees of freedom no cells are decided, under a limit on spheres neither") {
    Scene scene = lumpyPair(6);
    ContactZoneOptions options = tolerance(0.004);
    options.maxSpheres = 150;
    options.whole = true;
    bool cells = false;
    const ContactZoneFit fit =
        fitContactZone(scene.a, scene.b, scene.motion, options, [&](auto step, double) {
            cells |= step == "undecided cells";
            return true;
        });
    CHECK_FALSE(cells);
    CHECK(fit.levels.size() == 1);
    CHECK(fit.a.fit.note.find("150 spheres do not suffice") != std::string::npos);
    CHECK(fit.a.fit.spheres.size() <= 150);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, fit.levels.back().tolerance, 1000);
}

TEST_CASE("a limit on spheres that what overlaps at rest takes alone leaves the zone as many") {
    Scene scene = lumpyPair(6);
    scene.b = transformed(scene.b, Eigen::Affine3d(Eigen::Translation3d(-0.6, 0, 0)));
    ContactZoneOptions options = tolerance(0.01);
    options.atRest = AtRest::Offset;
    options.maxSpheres = 20;
    options.whole = true;
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, options);
    REQUIRE_FALSE(fit.a.fit.region.empty());
    const auto region =
        static_cast<std::size_t>(std::count(fit.a.fit.region.begin(), fit.a.fit.region.end(), 1));
    REQUIRE(region > 20);
    CHECK(fit.a.fit.spheres.size() > region);
    CHECK(fit.a.fit.spheres.size() <= 2 * region);
    CHECK(fit.a.fit.protrusion < 0.5);
}

TEST_CASE("bodies near each other at rest that take more spheres than a limit are told of soon, or refused") {
    const auto fitted = [](double gap, int most, int& looks) {
        const Scene scene = pressedOnto(gap);
        ContactZoneOptions options = tolerance(0.02);
        options.atRest = AtRest::Offset;
        options.maxSpheres = most;
        looks = 0;
        return fitContactZone(scene.a, scene.b, scene.motion, options,
                              [&](std::string_view step, double done) {
                                  looks += step == "patches" && done == 1;
                                  return true;
                              });
    };
    int looks = 0;
    const ContactZoneFit fit = fitted(0.004, 50, looks);
    CHECK(fit.a.fit.spheres.size() > 50);
    CHECK(fit.a.fit.note.find("0.004 scene units apart at rest") != std::string::npos);
    CHECK(fit.a.fit.note.find("more than the 50 asked for") != std::string::npos);
    CHECK(looks <= 8); // of two bodies: asked for, twice as coarse, and made
    std::string refusal;
    try {
        fitted(1e-4, 50, looks);
    } catch (const RestTooClose& error) {
        refusal = error.message;
    }
    CHECK(refusal.find("or no limit of 50 spheres") != std::string::npos);
}

TEST_CASE("a work stopped early is coarser and misses nothing") {
    const Scene scene = lumpyPair(7);
    const auto fitted = [&](const Progress& progress) {
        return fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.0005), progress);
    };
    const ContactZoneFit fit = fitted([](std::string_view step, double) { return step != "contact zone"; });
    CHECK(fit.a.fit.note.find("stopped") != std::string::npos);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, fit.levels.back().tolerance, 1000);

    // Before there is any level no time goes into one.
    CHECK_THROWS_WITH(fitted([](std::string_view step, double) { return step != "patches"; }),
                      Catch::Contains("stopped before the spheres were made"));
}

TEST_CASE("inscribed spheres claim no contact that is none") {
    const Scene scene = lumpyPair(8);
    ContactZoneOptions options = tolerance(0.005);
    options.conservative = false;
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, options);
    const GroundTruth truth(scene.a, scene.b);
    const SphereTree a(fit.a.fit.spheres), b(fit.b.fit.spheres);
    int hits = 0;
    for (const auto& q : tss::randomPoses(scene.motion, 1000, 3))
        if (smallestGap(a, b, pose(scene.motion, q), 1) <= 0) {
            ++hits;
            CHECK(truth.touches(pose(scene.motion, q)));
        }
    CHECK(hits > 0);
    CHECK(fit.a.fit.coverage <= 0.005);
    CHECK(fit.a.fit.protrusion == 0);
}

TEST_CASE("open meshes are refined like closed ones") {
    Scene scene = lumpyPair(9);
    scene.a.triangles.resize(scene.a.triangles.size() - 6);
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.01));
    CHECK(fit.a.fit.note.find("open") != std::string::npos);
    const GroundTruth truth(scene.a, scene.b);
    CHECK(verdicts(truth, fit, scene.motion, tss::randomPoses(scene.motion, 1000, 4)).missed == 0);
}

namespace {

/// What is left of a ball below a height: a bowl of one layer.
TriangleMesh bowl(double height) {
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, 2);
    std::erase_if(mesh.triangles, [&](const Tri& t) {
        return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).z() / 3 > height;
    });
    return mesh;
}

/// A ball that goes about inside the bowl, through its wall and over its rim.
Scene ballInBowl(double height) {
    Scene scene{bowl(height), ballMesh(Vec3::Zero(), 0.3, 1), {}};
    scene.motion.dofs = {slide(Vec3::UnitX(), -1, 1), slide(Vec3::UnitZ(), -1.2, 1)};
    return scene;
}

} // namespace

TEST_CASE("an open mesh that the other body enters is hollow: only its surface is touched") {
    const double height = GENERATE(0.0, 0.4, -0.4); // half a shell, a cup, a dish
    CAPTURE(height);
    Scene scene = ballInBowl(height);
    const bool turned = GENERATE(false, true), swapped = GENERATE(false, true);
    if (turned) scene.a = turnedInsideOut(scene.a);
    if (swapped) std::swap(scene.a, scene.b);
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.04));
    CHECK((swapped ? fit.b : fit.a).fit.hollow);
    CHECK_FALSE((swapped ? fit.a : fit.b).fit.hollow);
    CHECK((swapped ? fit.b : fit.a).fit.note.find("hollow") != std::string::npos);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 0.04, 1000);
}

TEST_CASE("a mesh with a hole that nothing enters stays filled") {
    Scene scene = lumpyPair(9);
    scene.a.triangles.resize(scene.a.triangles.size() - 6);
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.01));
    CHECK_FALSE(fit.a.fit.hollow);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 0.01, 1000);
}

TEST_CASE(
    "meshes of several overlapping bodies, faces given twice and T-junctions touch as their surfaces do") {
    Scene scene = lumpyPair(11);
    const TriangleMesh one = scene.a;
    const Eigen::Affine3d aside(Eigen::Translation3d(0, 0.5, 0));
    const int kind = GENERATE(0, 1, 2, 3);
    CAPTURE(kind);
    if (kind == 0) append(scene.a, transformed(one, aside));
    if (kind == 1) append(scene.a, turnedInsideOut(transformed(one, aside)));
    if (kind == 2) append(scene.a, turnedInsideOut(one));
    if (kind == 3)
        for (std::size_t i = 0; i < one.triangles.size(); i += 3) {
            const Tri t = one.triangles[i];
            const auto middle = static_cast<int>(scene.a.vertices.size());
            scene.a.vertices.emplace_back(0.5 * (one.vertices[t[0]] + one.vertices[t[1]]));
            scene.a.triangles[i] = Tri(t[0], middle, t[2]);
            scene.a.triangles.emplace_back(middle, t[1], t[2]);
        }
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.02));
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 0.02, 1000);
}

TEST_CASE("a motion without limits and a mesh of nothing are refused") {
    Scene scene = lumpyPair(10);
    CHECK_THROWS_AS(fitContactZone({}, scene.b, scene.motion, tolerance(0.01)), InputError);
    CHECK_THROWS_AS(fitContactZone(scene.a, scene.b, scene.motion, tolerance(-1)), InputError);
    scene.motion.dofs[0].upper = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.01)), InputError);
}

TEST_CASE("the dog's jaw at 0.6 mm misses no contact with at most 5000 spheres") {
    REQUIRE_SHARED_MESHES();
    const Scene scene = realPair("dog_jaw");
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(6e-4));
    CHECK(fit.a.fit.spheres.size() + fit.b.fit.spheres.size() <= 5000);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 6e-4, 200);
}
