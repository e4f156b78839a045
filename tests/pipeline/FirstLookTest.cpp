#include "bake/pipeline/FirstLook.h"

#include "bake/model/AddPair.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

#include <span>

using namespace tss;

namespace {

/// A box, and one of half its edges that stands so far from it along x, which turns; a second joint of four
/// values makes the pairs long chains, of which alone a first look has tolerances of its own.
SceneModel boxesApart(double apart) {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "S";
    const auto body = [&](const char* name, const Vec3& low, const Vec3& high) {
        Body made;
        made.path = std::string("/S/") + name;
        made.mesh = boxMesh(low, high);
        scene.bodies.push_back(made);
    };
    body("A", {0, 0, 0}, {2, 2, 2});
    body("B", {2 + apart, 0, 0}, {3 + apart, 1, 1});
    body("C", {-90, 0, 0}, {-89, 1, 1});
    Motion motion;
    motion.dofs = {joints::turn({0, 0, 0}, {0, 0, 1}, -0.1, 0.1)};
    addPair(scene, 0, 1, motion, "AB");
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        motion.dofs.push_back(joints::slide(axis, -1, 1));
    addPair(scene, 0, 2, motion, "AC");
    return scene;
}

} // namespace

TEST_CASE("a first look knows how near bodies are as far as room makes their tolerance finer") {
    const double diagonal = std::sqrt(3.0), ninth = diagonal / 9;
    for (const double apart : {0.0, 0.01, 0.1, 0.9 * ninth, 1.1 * ninth, 1.0, 40.0}) {
        SceneModel scene = boxesApart(apart);
        const std::vector<double> distances = distancesAtRest(scene);
        REQUIRE(distances.size() == 2);
        INFO(apart);
        if (apart < ninth)
            CHECK(distances[0] == Approx(apart));
        else
            CHECK((distances[0] >= 0.999 * ninth && distances[0] <= apart));
        CHECK(distances[1] > 80);
        CHECK(distances[1] < 88.99); // balls about both, not the surfaces, which no tolerance depends on
        setFirstTolerances(scene, distances);
        const double finest = diagonal / 500, usual = diagonal / 30,
                     expected = apart == 0 ? diagonal / 100 : std::clamp(0.3 * apart, finest, usual);
        CHECK(std::stod(scene.pairs[0].settings.at("tolerance")) == Approx(1000 * expected).epsilon(0.05));
    }
}

TEST_CASE("what a motion brings near is seen at any of its keys, and how long surfaces cross") {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "S";
    for (const double x : {0.0, 5.0}) {
        Body body;
        body.path = x > 0 ? "/S/B" : "/S/A";
        body.mesh = boxMesh({x, 0, 0}, {x + 1, 1, 1});
        scene.bodies.push_back(body);
    }
    Motion motion;
    motion.dofs = {joints::slide({1, 0, 0}, -5, 5)};
    addPair(scene, 0, 1, motion, "AB");
    const double ninth = std::sqrt(3.0) / 9;
    const auto contact = [&](const TimeSamples& drive) {
        scene.joints[0].drives = {drive};
        const std::pair<int, int> both(0, 1);
        return contactsInMotion(scene, std::span(&both, 1)).front();
    };
    CHECK_FALSE(contact({{0, 1, 2}, {0, -4 + 1.01 * ninth, 0}}).near);
    CHECK(contact({{0, 1, 2}, {0, -4 + 0.99 * ninth, 0}}).near);
    CHECK(contact({{0, 1, 2}, {0, -4 + 0.99 * ninth, 0}}).crossing == 0);
    CHECK(contact({{0, 1, 2, 3}, {0, -4.5, -4.2, 0}}).crossing == Approx(0.5));
    // Of a thousand keys 400 are looked at, first and last among them.
    TimeSamples many;
    for (int k = 0; k < 1000; ++k) {
        many.times.push_back(k);
        many.values.push_back(k == 999 ? -4.5 : 0);
    }
    CHECK(contact(many).crossing == Approx(1.0 / 400));
}
