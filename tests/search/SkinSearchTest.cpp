#include "bake/search/SkinSearch.h"
#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/motion/PoseBlend.h"
#include "tests/BentEllipsoid.h"
#include "tests/FloatTraps.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

using namespace tss;

namespace {

struct Scene {
    TriangleMesh skin;
    std::unique_ptr<MuscleDeformer> muscle;
    SphereSet spheres;
    std::vector<SkinSearchMuscle> muscles() const { return {{muscle.get(), spheres}}; }
};

/// Skin vertices strewn about a contracting muscle; the triangles only give them normals.
Scene randomScene(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    Scene scene;
    for (int i = 0; i < 600; ++i)
        scene.skin.vertices.push_back(Vec3{1.5 * unit(random), 0.6 * unit(random), 0.6 * unit(random)});
    for (int i = 0; i + 2 < 600; i += 3) scene.skin.triangles.emplace_back(i, i + 1, i + 2);
    test::BentEllipsoid shape;
    shape.bend = 0.2;
    Muscle muscle = test::bentEllipsoid(shape);
    muscle.maxContraction = 0.5;
    muscle.activationLower = -0.3;
    scene.muscle = std::make_unique<MuscleDeformer>(std::move(muscle));
    for (int i = 0; i < 40; ++i) {
        const Vec3 centre = scene.muscle->fibre().point((i + 0.5) / 40);
        scene.spheres.push_back({centre, 0.02 + 0.05 * std::abs(unit(random))});
    }
    return scene;
}

SkinSearchOptions options(SkinPath path) {
    SkinSearchOptions o;
    o.thickness = 0.02;
    o.travel = 0.01;
    o.path = path;
    return o;
}

} // namespace

TEST_CASE("every skin sphere that a muscle sphere reaches at some activation is in the table") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const Scene scene = randomScene(seed);
        for (const SkinPath path : {SkinPath::AtRest, SkinPath::Carried}) {
            const SkinTable table = searchSkin(scene.skin, scene.muscles(), options(path));
            std::set<std::pair<std::uint32_t, double>> found; // skin vertex, sphere's place along x
            for (const SpherePair& p : tests(table.table))
                found.insert({table.skinVertices[p.a], table.table.b[p.b].centre.x()});
            std::vector<MusclePoint> centres, skin;
            for (const Sphere& sphere : scene.spheres) centres.push_back(scene.muscle->bind(sphere.centre));
            for (const Vec3& v : scene.skin.vertices) skin.push_back(scene.muscle->bind(v));
            std::size_t met = 0;
            for (int k = 0; k <= 60; ++k) {
                const MuscleState state = scene.muscle->state(-0.3 + 1.3 * k / 60);
                for (std::uint32_t v = 0; v < skin.size(); ++v) {
                    const Vec3& rest = scene.skin.vertices[v];
                    const Vec3 x = path == SkinPath::AtRest
                                       ? rest
                                       : Vec3(0.4 * rest + 0.6 * scene.muscle->map(skin[v], state));
                    for (std::size_t j = 0; j < centres.size(); ++j) {
                        // 1e-3: the track is not the exact motion between its nodes.
                        const double reach =
                            0.03 - 1e-3 +
                            scene.spheres[j].radius * scene.muscle->thickness(centres[j].s, state);
                        if ((x - scene.muscle->map(centres[j], state)).norm() > reach) continue;
                        ++met;
                        INFO("seed " << seed << ", vertex " << v << ", activation " << state.activation);
                        REQUIRE(found.count({v, scene.spheres[j].centre.x()}) == 1);
                    }
                }
            }
            CHECK(met > 100);
        }
    }
}

TEST_CASE("every skin sphere that a swinging bone reaches, or is swung to, is in the table") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> unit(-1, 1);
        Scene scene = randomScene(seed);
        Muscle bone = scene.muscle->muscle();
        bone.activationLower = bone.activationUpper = 0; // no contraction: what swings is all that moves
        scene.muscle = std::make_unique<MuscleDeformer>(std::move(bone));
        std::vector<double> share;
        for (std::size_t v = 0; v < scene.skin.vertices.size(); ++v)
            share.push_back(std::max(0.0, unit(random)));
        const Vec3 axis = Vec3{unit(random), unit(random), unit(random)}.normalized(), origin(0.8, 0, 0);
        const auto swung = [&](double angle) {
            return Pose(Eigen::Translation3d(origin) * Eigen::AngleAxisd(angle, axis) *
                        Eigen::Translation3d(-origin));
        };
        SkinSearchOptions o = options(SkinPath::Carried);
        const std::size_t without = searchSkin(scene.skin, scene.muscles(), o).table.testCount();
        o.shares = {share};
        BoneSwing swing;
        for (int k = 1; k <= 16; ++k) swing.push_back({swung(1.2 * k / 16)});
        o.swings = {swing};
        const SkinTable table = searchSkin(scene.skin, scene.muscles(), o);
        std::set<std::pair<std::uint32_t, double>> found;
        for (const SpherePair& p : tests(table.table))
            found.insert({table.skinVertices[p.a], table.table.b[p.b].centre.x()});
        CHECK(table.table.testCount() > 2 * without);
        for (int k = 0; k <= 100; ++k) {
            const Pose pose = swung(1.2 * k / 100);
            for (std::uint32_t v = 0; v < share.size(); ++v) {
                const Vec3& rest = scene.skin.vertices[v];
                PoseBlend blend;
                blend.add(share[v], DualPose(pose));
                const Vec3 x = blend.pose() * rest;
                for (const Sphere& sphere : scene.spheres) {
                    if ((x - pose * sphere.centre).norm() > 0.03 + sphere.radius) continue;
                    INFO("seed " << seed << ", vertex " << v << ", angle " << 1.2 * k / 100);
                    REQUIRE(found.count({v, sphere.centre.x()}) == 1);
                }
            }
        }
    }
}

TEST_CASE("what stays out of reach of all activations is not in the table") {
    const Scene scene = randomScene(5);
    std::vector<MuscleState> states;
    for (int k = 0; k < 64; ++k) states.push_back(scene.muscle->state(-0.3 + 1.3 * k / 63));
    const SkinTable table = searchSkin(scene.skin, scene.muscles(), options(SkinPath::AtRest));
    for (const SpherePair& p : tests(table.table)) {
        const Vec3& x = table.table.a[p.a].centre;
        const Sphere& s = table.table.b[p.b];
        const MusclePoint point = scene.muscle->bind(s.centre);
        double gap = 1e9, step = 0;
        Vec3 before = s.centre;
        for (int k = 0; k < 64; ++k) {
            const MuscleState& state = states[k];
            const Vec3 centre = scene.muscle->map(point, state);
            if (k > 0) step = std::max(step, (centre - before).norm());
            before = centre;
            gap = std::min(gap, (x - centre).norm() - s.radius * scene.muscle->thickness(point.s, state));
        }
        // The radius of a stretch is that of its thicker end.
        CHECK(gap < 0.03 + step + 0.01);
    }
    CHECK(table.table.a.size() < table.table.record.spheresA);
    CHECK(table.table.record.spheresA == scene.skin.vertices.size());
}

TEST_CASE("a table of skin carries its overlap at rest and its travel") {
    const Scene scene = randomScene(6);
    const SkinTable table = searchSkin(scene.skin, scene.muscles(), options(SkinPath::AtRest));
    CHECK(table.travel == 0.01);
    CHECK_FALSE(table.table.certified); // nothing is proven of muscles and bones that move at once
    REQUIRE_FALSE(table.table.restGaps.empty());
    const std::vector<SpherePair> pairs = tests(table.table);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const Sphere &a = table.table.a[pairs[k].a], &b = table.table.b[pairs[k].b];
        const double gap = (a.centre - b.centre).norm() - a.radius - b.radius;
        CHECK(table.table.restGaps[k] == std::min(0.0, gap));
    }
}

TEST_CASE("the table of a skin does not depend on the number of threads") {
    const Scene scene = randomScene(8);
    std::vector<SpherePair> one, many;
    {
        ThreadLimit limit(1);
        one = tests(searchSkin(scene.skin, scene.muscles(), options(SkinPath::Carried)).table);
    }
    many = tests(searchSkin(scene.skin, scene.muscles(), options(SkinPath::Carried)).table);
    CHECK(one == many);
}

TEST_CASE("a skin far from its muscles has an empty table") {
    Scene scene = randomScene(9);
    for (Vec3& v : scene.skin.vertices) v.z() += 10;
    CHECK(searchSkin(scene.skin, scene.muscles(), options(SkinPath::Carried)).table.testCount() == 0);
}

TEST_CASE("a travel that is no length is refused") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    const Scene scene = randomScene(10);
    for (const double travel : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        SkinSearchOptions o;
        o.travel = travel;
        CHECK_THROWS_AS(searchSkin(scene.skin, scene.muscles(), o), InputError);
    }
}
