#include "bake/report/Report.h"
#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/AddPair.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <unistd.h>

using namespace tss;
using namespace tss::reporting;

namespace {

/// A ball on an arm that turns down to a ball on a base, and slides a little.
SceneModel armScene(double lowest) {
    SceneModel scene;
    scene.defaultPrim = "Arm";
    scene.metersPerUnit = 0.01;
    const auto body = [&](const std::string& name, const TriangleMesh& mesh) {
        Body part;
        part.path = "/Arm/" + name;
        part.mesh = mesh;
        part.rigid = true;
        scene.bodies.push_back(part);
    };
    body("Base", ballMesh({3, 0, -1}, 0.8, 3));
    body("Lever", ballMesh({3, 0, 0.9}, 0.7, 3));
    Motion motion;
    Dof turn;
    turn.name = "turn";
    turn.axis = Vec3::UnitY();
    turn.lower = -0.2;
    turn.upper = lowest;
    Dof slide;
    slide.name = "slide";
    slide.kind = DofKind::Translation;
    slide.axis = Vec3::UnitY();
    slide.lower = -0.5;
    slide.upper = 0.5;
    motion.dofs = {slide, turn};
    addPair(scene, 0, 1, motion, "Hinge");
    return scene;
}

struct OutFolder {
    std::string path =
        (std::filesystem::temp_directory_path() / ("tss-report-" + std::to_string(getpid()))).string();
    ~OutFolder() { std::filesystem::remove_all(path); }
};

ReportOptions quickOptions() {
    ReportOptions options;
    options.quick = true;
    options.methods = {"tss", "fcl-obbrss", "tree-all", "gap-grid", "angular-region"};
    return options;
}

std::vector<std::string> figuresOf(const Report& report) {
    std::vector<std::string> figures;
    for (const Row& row : report.pairs[0].rows)
        for (const ErrorFigures* e : {&row.uniform, &row.near})
            figures.push_back(row.method + " " + row.setting + " " + std::to_string(e->poses) + " " +
                              std::to_string(e->touching) + " " + std::to_string(e->missed) + " " +
                              std::to_string(e->early) + " " + std::to_string(e->deepestMiss) + " " +
                              std::to_string(e->farthestEarly) + " " + std::to_string(row.tests));
    return figures;
}

} // namespace

TEST_CASE(
    "a report holds every method that was asked for, errors within what it states, times, plots and text") {
    const OutFolder folder;
    const SceneModel scene = armScene(0.6);
    const Report report = makeReport(scene, "somewhere/arm.tss", folder.path, quickOptions());
    REQUIRE(report.pairs.size() == 1);
    const PairStudy& study = report.pairs[0];
    CHECK_FALSE(study.neverCollides);
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
        if (row.about.stated.early >= 0)
            CHECK(std::max(row.uniform.farthestEarly, row.near.farthestEarly) <=
                  row.about.stated.early + 1e-9);
        ours += row.method == "tss";
        if (row.method == "fcl-obbrss") {
            ++exact;
            CHECK(row.worst() == 0);
            CHECK(row.uniform.missed + row.uniform.early == 0);
        }
    }
    CHECK(ours == study.bakes.size());
    CHECK(exact == 1);
    for (const Plot& plot : report.plots[0]) {
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
    const std::string csv = readWholeFile(folder.path + "/report.csv");
    CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) == study.rows.size() + 1);
}

TEST_CASE("two runs of a report agree on every error figure") {
    const OutFolder folder;
    const SceneModel scene = armScene(0.6);
    ReportOptions options = quickOptions();
    options.methods = {"tss", "gap-grid", "angular-region"};
    const Report first = makeReport(scene, "arm.tss", folder.path, options);
    const Report second = makeReport(scene, "arm.tss", folder.path, options);
    CHECK(figuresOf(first) == figuresOf(second));
    REQUIRE(first.pairs[0].sampling.size() == second.pairs[0].sampling.size());
    for (std::size_t k = 0; k < first.pairs[0].sampling.size(); ++k)
        CHECK(first.pairs[0].sampling[k].missedNear == second.pairs[0].sampling[k].missedNear);
}

TEST_CASE("a pair that never meets is reported as proven, with nothing to compare") {
    const OutFolder folder;
    const Report report = makeReport(armScene(0.05), "arm.tss", folder.path, quickOptions());
    CHECK(report.pairs[0].neverCollides);
    CHECK(report.pairs[0].clearance > 0);
    CHECK(report.pairs[0].rows.empty());
    CHECK(readWholeFile(folder.path + "/report.md").find("can never meet") != std::string::npos);
}

TEST_CASE("a report on a scene without pairs, or on a path that is not there, says so") {
    const OutFolder folder;
    CHECK_THROWS_WITH(makeReport(SceneModel{}, "empty.tss", folder.path, quickOptions()),
                      Catch::Contains("empty.tss") && Catch::Contains("expected a scene with a pair"));
    ReportOptions options = quickOptions();
    options.pairs = {"/Nobody"};
    CHECK_THROWS_WITH(makeReport(armScene(0.6), "arm.tss", folder.path, options), Catch::Contains("/Nobody"));
}
