// What a report says of pairs that are not as most are.
#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/pipeline/BakePair.h"
#include "bake/report/Text.h"
#include "tests/report/Arm.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::reporting;

namespace {

/// The arm with its ball in that of the base, which it never leaves.
SceneModel stuckScene() {
    SceneModel scene = armScene(0.05);
    for (Vec3& v : scene.bodies[1].mesh.vertices) v.z() -= 1.4;
    return scene;
}

ReportOptions fewMethods() {
    ReportOptions options;
    options.quick = true;
    options.methods = {"tss-scalar", "all-pairs-simd"};
    return options;
}

std::string textOf(const SceneModel& scene, const OutFolder& folder, Report* report = nullptr) {
    const Report made = makeReport(scene, "arm.tss", folder.path, fewMethods());
    if (report) *report = made;
    return readWholeFile(folder.path + "/report.md");
}

} // namespace

TEST_CASE("of a pair that never meets a report and a bake give one distance") {
    const OutFolder folder;
    SceneModel scene = armScene(0.05);
    Pair baked = scene.pairs[0];
    PairReport notes;
    bakePair(scene, baked, optionsFor(scene, baked), notes, {});
    REQUIRE(baked.proof);
    CHECK_THAT(textOf(scene, folder),
               Catch::Contains("stay more than " + lengthText(baked.proof->clearance, 0.01) + " apart"));
}

TEST_CASE("of a pair that always touches it says so, and what its table excepts") {
    const OutFolder folder;
    Report report;
    const std::string text = textOf(stuckScene(), folder, &report);
    CHECK_THAT(text, Catch::Contains("touch at every one of these poses"));
    CHECK_THAT(text, Catch::Contains("the table called \"at rest: offset\""));
    CHECK_THAT(text, !Catch::Contains("of the 0 free ones"));
    CHECK_THAT(text, !Catch::Contains("| never |")); // no way was looked along
    CHECK_THAT(readWholeFile(folder.path + "/report.json"), Catch::Contains("at every one of these poses"));
}

TEST_CASE("a scene's own word on overlap at rest is that of its report") {
    const OutFolder folder;
    SceneModel scene = stuckScene();
    scene.pairs[0].settings["at-rest"] = "ignore";
    const std::string text = textOf(scene, folder);
    CHECK_THAT(text, Catch::Contains("the table called \"at rest: ignore\""));
    CHECK_THAT(text, !Catch::Contains("at rest: offset"));
    scene.pairs[0].settings["at-rest"] = "collide";
    CHECK_THAT(textOf(scene, folder), !Catch::Contains("at rest: "));
}

TEST_CASE("a table of sampled poses is not called proven, and growth certified is") {
    const OutFolder folder;
    SceneModel scene = armScene(0.6);
    scene.pairs[0].settings["search"] = "sampled";
    scene.pairs[0].settings["samples"] = "300";
    Report report;
    const std::string text = textOf(scene, folder, &report);
    CHECK_THAT(text,
               Catch::Contains("0.1 mm, sampled poses only") || Catch::Contains("1 mm, sampled poses only"));
    CHECK_THAT(text, !Catch::Contains("every pose proven"));
    CHECK_THAT(text, Catch::Contains("made from sampled poses, as the scene asks"));
    for (const BakePoint& point : report.pairs[0].recipes)
        if (point.name == "growth, certified" && point.tests > 0) CHECK(point.certified);
}

TEST_CASE("a scene that asks for few spheres is studied by the tolerance that these reach") {
    const OutFolder folder;
    SceneModel scene = armScene(0.6);
    scene.pairs[0].settings = {{"max-spheres", "40"}, {"spheres", "surface"}};
    Report report;
    CHECK_THAT(textOf(scene, folder, &report), Catch::Contains("asks for at most 40 spheres a body"));
    const BakePoint& base = report.pairs[0].base;
    CHECK(base.protrusion <= base.tolerance * (1 + 1e-9));
}

TEST_CASE("slides have units, and regions that are angular only where something turns") {
    const OutFolder folder;
    SceneModel scene = armScene(0.6);
    CHECK_THAT(textOf(scene, folder), Catch::Contains("slide: -0.5 to 0.5 times 10 mm") &&
                                          Catch::Contains("turn: -11.46 to 34.38 degrees"));
    Dof slide;
    slide.kind = DofKind::Translation;
    slide.axis = {0, 0, 2};
    CHECK(unitOf(slide, 0.01) == "times 20 mm");
}

TEST_CASE("of a region that holds free poses it is said how many collide") {
    RegionCurve region{{-15, -5, 5, 15}, {0, 0.5, 0, 1}, -10, 20};
    CHECK(region.meanShare() == Approx(0.5));
    CHECK(RegionCurve{}.meanShare() == 0);
}

TEST_CASE("what was judged at fewer poses is on no front") {
    Row exact, slow;
    exact.times.median = 10;
    slow.times.median = 1;
    slow.about.slow = true;
    const auto time = [](const Row& row) { return row.times.median; };
    const std::vector<Row> rows{exact, slow};
    const auto front = paretoFront(rows, time, [](const Row&) { return 0.0; });
    REQUIRE(front.size() == 1);
    CHECK(front[0] == &rows[0]);
}

TEST_CASE("a folder that cannot be written into is refused before anything is measured") {
    const OutFolder folder;
    std::filesystem::create_directories(folder.path);
    writeFileAtomically(folder.path + "/plots", "");
    CHECK_THROWS_AS(makeReport(armScene(0.6), "arm.tss", folder.path, fewMethods()), InputError);
    std::filesystem::remove(folder.path + "/plots");
    std::filesystem::create_directories(folder.path + "/report.md");
    CHECK_THROWS_WITH(makeReport(armScene(0.6), "arm.tss", folder.path, fewMethods()),
                      Catch::Contains("it is a folder"));
    CHECK_FALSE(std::filesystem::exists(folder.path + "/report.csv"));
}
