#include "bake/report/Report.h"
#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/SceneFile.h"
#include "tests/report/Arm.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <png.h>

using namespace tss;
using namespace tss::reporting;

namespace {

/// A report's figures without what a clock says.
nlohmann::json withoutTimes(nlohmann::json json) {
    if (json.is_object()) json.erase("times");
    if (json.is_structured())
        for (auto& part : json) part = withoutTimes(part);
    return json;
}

nlohmann::json figuresIn(const std::string& folder) {
    return withoutTimes(nlohmann::json::parse(readWholeFile(folder + "/report.json")));
}

} // namespace

TEST_CASE(
    "a report holds every method that was asked for, errors within what it states, times, plots and text") {
    const OutFolder folder;
    const SceneModel scene = armScene(0.6);
    const Report report = makeReport(scene, "somewhere/arm.tss", folder.path, quickOptions());
    REQUIRE(report.pairs.size() == 1);
    const PairStudy& study = report.pairs[0];
    CHECK_FALSE(study.never);
    CHECK(study.touchingUniform > 100);
    CHECK(study.touchingUniform < study.uniformPoses);
    CHECK(study.nearPoses >= 100);
    std::size_t ours = 0, exact = 0;
    for (const Row& row : study.rows) {
        INFO(row.method << " " << row.setting);
        CHECK(row.times.median > 0);
        CHECK(row.times.low <= row.times.median);
        CHECK(row.times.median <= row.times.high);
        if (row.about.stated.miss == 0) CHECK(row.misses() == 0);
        if (row.about.stated.miss)
            CHECK(std::max(row.uniform.deepestMiss, row.near.deepestMiss) <= *row.about.stated.miss + 1e-9);
        if (row.about.stated.early)
            CHECK(std::max(row.uniform.farthestEarly, row.near.farthestEarly) <=
                  *row.about.stated.early + 1e-9);
        ours += row.method == "tss";
        if (row.method == "fcl-obbrss") {
            ++exact;
            CHECK(row.worst() == 0);
            CHECK(row.uniform.missed + row.uniform.early == 0);
        }
    }
    std::size_t tables = 0; // a recipe may find nothing to collide
    for (const auto* points : {&study.tolerances, &study.epsilons, &study.recipes})
        for (const BakePoint& point : *points) tables += point.tests > 0 ? 1 : 0;
    CHECK(ours == tables - 1); // the base is in both sweeps
    CHECK(exact == 1);
    for (const Plot& plot : report.pairPlots[0]) {
        const std::string svg = readWholeFile(folder.path + "/" + plot.file);
        CHECK(svg.find("<svg") != std::string::npos);
        CHECK(svg.find("</svg>") != std::string::npos);
    }
    const auto json = nlohmann::json::parse(readWholeFile(folder.path + "/report.json"));
    CHECK(json["pairs"][0]["rows"].size() == study.rows.size());
    const std::string text = readWholeFile(folder.path + "/report.md");
    CHECK(text.find("arm.tss") != std::string::npos);
    CHECK(text.find("somewhere") == std::string::npos);
    CHECK(text.find("bent ellipsoid") == std::string::npos); // not asked for: not even as not run
    CHECK(text.find("skull") == std::string::npos);          // the user's scene alone
    CHECK(text.find("Goals") == std::string::npos);
    const std::string page = readWholeFile(folder.path + "/index.html"); // tests/report/page.sh looks at it
    CHECK(page.find("REPORT_DATA") == std::string::npos);
    for (const Row& row : study.rows) CHECK(page.find('"' + row.method + '"') != std::string::npos);
    REQUIRE(report.pairPictures.at(0).size() == 3);
    for (const Picture& picture : report.pairPictures[0]) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        REQUIRE(png_image_begin_read_from_memory(&image, picture.png.data(), picture.png.size()) != 0);
        image.format = PNG_FORMAT_RGBA;
        std::vector<std::uint32_t> pixels(std::size_t{image.width} * image.height);
        REQUIRE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) != 0);
        const auto clear = std::count(pixels.begin(), pixels.end(), 0u);
        CHECK(clear < static_cast<std::ptrdiff_t>(pixels.size() * 99 / 100)); // something is drawn
    }
    const std::string csv = readWholeFile(folder.path + "/report.csv");
    CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == study.rows.size() + 1);
}

TEST_CASE("a method that there is none of is refused before anything is made") {
    const OutFolder folder;
    ReportOptions options = quickOptions();
    options.methods.push_back("foo");
    CHECK_THROWS_WITH(makeReport(armScene(0.6), "arm.tss", folder.path, options),
                      Catch::Contains("\"foo\"") && Catch::Contains("bullet-gimpact"));
    options.methods = {""};
    CHECK_THROWS_WITH(makeReport(armScene(0.6), "arm.tss", folder.path, options),
                      Catch::Contains("an empty one"));
    CHECK_FALSE(std::filesystem::exists(folder.path));
}

TEST_CASE("two runs of a report agree on every error figure") {
    const OutFolder folder;
    const SceneModel scene = armScene(0.6);
    ReportOptions options = quickOptions();
    options.methods = {"tss", "gap-grid", "angular-region"};
    makeReport(scene, "arm.tss", folder.path, options);
    const auto first = figuresIn(folder.path);
    makeReport(scene, "arm.tss", folder.path, options);
    CHECK(first["pairs"][0]["rows"].size() > 5);
    CHECK(first == figuresIn(folder.path));
}

TEST_CASE(
    "a skin's report: methods over the same spheres agree, and enough sweeps come to the converged solve") {
    const OutFolder folder;
    const SceneModel scene = loadScene(OSGTSS_SOURCE_DIR "/scenes/dog_frontalis.tss");
    const Report report = makeReport(scene, "dog_frontalis.tss", folder.path, quickOptions());
    REQUIRE(report.skins.size() == 1);
    const SkinStudy& study = report.skins[0];
    const auto method = [&](const std::string& name) {
        return *std::find_if(study.methods.begin(), study.methods.end(),
                             [&](const SkinMethod& m) { return m.name == name; });
    };
    const SkinMethod table = method("tss");
    CHECK(table.tests == Approx(static_cast<double>(study.tests)));
    for (const char* name : {"all-pairs", "tree-all-8", "tree-used-8"}) {
        INFO(name);
        CHECK(method(name).missed == table.missed);
        CHECK(method(name).early == table.early);
        CHECK(method(name).farthestEarly == table.farthestEarly);
        CHECK(method(name).tests > table.tests);
    }
    CHECK(study.motion.touched > 0);
    CHECK(study.motion.farthestMove > 0);
    CHECK(study.motion.muscleVolume < 1e-9);
    for (const SkinAnswer& answer : study.motion.answers) {
        INFO(answer.sweeps << " sweeps");
        CHECK(answer.nanoseconds > 0);
        CHECK(answer.deepest <= study.motion.untouched + 1e-9);
        CHECK(answer.rms <= answer.farthest);
    }
    CHECK(study.motion.answers.back().rms <= 1e-3 * study.motion.farthestMove);
    CHECK(report.skinPlots[0].size() >= 2);
    CHECK(readWholeFile(folder.path + "/report.md").find("/DogFrontalis/Skin") != std::string::npos);
}

TEST_CASE("a pair that never meets is reported as proven, with nothing to compare") {
    const OutFolder folder;
    const Report report = makeReport(armScene(0.05), "arm.tss", folder.path, quickOptions());
    REQUIRE(report.pairs[0].never);
    CHECK_THAT(*report.pairs[0].never, Catch::Contains("can never meet") && Catch::Contains("mm apart"));
    CHECK(report.pairs[0].rows.empty());
    CHECK(readWholeFile(folder.path + "/report.md").find("can never meet") != std::string::npos);
}

TEST_CASE("a pair of which no spheres meet, and no clearance is proven, has nothing to compare either") {
    const OutFolder folder;
    SceneModel scene = armScene(0.05);
    scene.pairs[0].settings["search"] = "sampled";
    const Report report = makeReport(scene, "arm.tss", folder.path, quickOptions());
    REQUIRE(report.pairs[0].never);
    CHECK_THAT(*report.pairs[0].never, Catch::StartsWith("At none of the poses explored"));
    CHECK(report.pairs[0].rows.empty());
}

TEST_CASE("a report on a scene without pairs, or on a path that is not there, says so") {
    const OutFolder folder;
    CHECK_THROWS_WITH(makeReport(SceneModel{}, "empty.tss", folder.path, quickOptions()),
                      Catch::Contains("empty.tss") && Catch::Contains("expected a scene with a pair"));
    ReportOptions options = quickOptions();
    options.pairs = {"/Nobody"};
    CHECK_THROWS_WITH(makeReport(armScene(0.6), "arm.tss", folder.path, options), Catch::Contains("/Nobody"));
}
