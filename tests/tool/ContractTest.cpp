#include "bake/scene/SceneFile.h"
#include "tests/Shapes.h"
#include "tests/tool/Shell.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

using Json = nlohmann::json;

namespace {

/// A ball of radius 10 and one of radius 5 that swings about the Z axis and can hit it.
void writeSwing(const Folder& folder) {
    writeObj(ballMesh({0, 0, 0}, 10, 3), folder / "still.obj");
    writeObj(ballMesh({0, 30, 0}, 5, 3), folder / "swing.obj");
    const Ran made = runTss("make -o swing.tss --a still.obj --b swing.obj --meters-per-unit 0.001 "
                            "--dof rot:25,0,0:0,0,1:-40:90",
                            folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
}

} // namespace

TEST_CASE("every command answers --help with exit 0, and an unknown one is a usage error") {
    const Folder folder;
    for (const char* command :
         {"make", "bake", "merge", "info", "verify", "query", "play", "validate", "convert", "bench"}) {
        const Ran help = runTss(std::string(command) + " --help", folder.path());
        CHECK(help.exit == 0);
        CHECK(help.out.find("--json") != std::string::npos);
    }
    CHECK(runTss("--help", folder.path()).exit == 0);
    CHECK(runTss("", folder.path()).exit == 2);
    const Ran nonsense = runTss("nonsense", folder.path());
    CHECK(nonsense.exit == 2);
    CHECK(nonsense.err.find("\"nonsense\"") != std::string::npos);
    CHECK(nonsense.err.find("verify") != std::string::npos);
    CHECK(runTss("bake", folder.path()).exit == 2);
    CHECK(runTss("info --nonsense x.tss", folder.path()).exit == 2);
}

TEST_CASE("two meshes and a hinge become a table that stops the motion where the meshes meet") {
    const Folder folder;
    writeSwing(folder);
    const Ran baked = runTss("bake swing.tss -o baked.tss --tolerance 0.2mm --json", folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    const Json pair = Json::parse(baked.out)["pairs"][0];
    CHECK(pair["certified"] == true);
    CHECK(pair["tests"].get<int>() > 0);
    CHECK(pair["boundMiss"].get<double>() <= 1e-3);
    CHECK(pair["boundEarly"].get<double>() <= 0.4 + 1e-3);

    // The balls touch where their centres are 15 apart; the small one circles (25,0,0) at |(−25,30,0)|.
    std::string poses;
    for (int angle = -40; angle <= 90; ++angle) poses += std::to_string(angle) + "\n";
    writeText(folder.path() / "q.csv", poses);
    REQUIRE(runTss("query baked.tss --poses q.csv -o r.csv", folder.path()).exit == 0);
    std::istringstream rows(readText(folder.path() / "r.csv"));
    std::string line;
    std::getline(rows, line);
    CHECK(line == "gap,hit,pair,px,py,pz,nx,ny,nz");
    int wrong = 0, hits = 0;
    for (int angle = -40; angle <= 90; ++angle) {
        REQUIRE(std::getline(rows, line));
        const bool hit = line[line.find(',') + 1] == '1';
        const tss::Vec3 centre =
            Eigen::AngleAxisd(angle * M_PI / 180, tss::Vec3::UnitZ()) * tss::Vec3(-25, 30, 0) +
            tss::Vec3(25, 0, 0);
        const double clearance = centre.norm() - 15;
        hits += hit;
        wrong += hit ? clearance > 0.8 : clearance < -0.2; // the balls are polyhedra, up to 0.2 inside
    }
    CHECK(hits > 0);
    CHECK(hits < 131);
    CHECK(wrong == 0);

    writeText(folder.path() / "m.csv", "0\n20\n40\n60\n90\n");
    REQUIRE(runTss("play baked.tss --motion m.csv -o played.csv --mesh-out f_%02d.obj", folder.path()).exit ==
            0);
    CHECK(std::filesystem::exists(folder.path() / "f_04.obj"));
    CHECK(readText(folder.path() / "played.csv").find("blocked") != std::string::npos);

    // Without a motion of one's own, the scene's: to both limits and back in 48 steps.
    REQUIRE(runTss("play baked.tss -o own.csv", folder.path()).exit == 0);
    const std::string own = readText(folder.path() / "own.csv");
    CHECK(std::count(own.begin(), own.end(), '\n') == 50);
    CHECK(own.find("\n36,90,") != std::string::npos);
    CHECK(own.find("blocked") != std::string::npos);
}

TEST_CASE("the same bake gives the same bytes with one thread and with two") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o one.tss --tolerance 0.3 --threads 1 --quiet", folder.path()).exit == 0);
    REQUIRE(runTss("bake swing.tss -o two.tss --tolerance 0.3 --threads 2 --quiet", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "one.tss") == readText(folder.path() / "two.tss"));
}

TEST_CASE("bodies that cannot meet get a proof, no table, and play as asked") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({5, -1, -1}, {6, 1, 1}), folder / "b.obj");
    REQUIRE(runTss("make -o far.tss --a a.obj --b b.obj --dof trans:1,0,0:0:3", folder.path()).exit == 0);
    const Ran baked = runTss("bake far.tss -o baked.tss --tolerance 0.1 --json", folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    CHECK(Json::parse(baked.out)["pairs"][0]["neverCollides"] == true);
    CHECK(readText(folder.path() / "baked.tss").find("TssNeverCollides") != std::string::npos);
    CHECK(readText(folder.path() / "baked.tss").find("\"TssTable\"") == std::string::npos);
}

TEST_CASE("the paper's bake: growth, sampled search, co-occurrence, with the growth's lengths as fractions "
          "or in units") {
    const Folder folder;
    writeSwing(folder);
    const std::string paper =
        " --search sampled --samples 500 --reduce cooccurrence --spheres growth --quiet --json ";
    const auto spheres = [&](const std::string& growth) {
        const Ran ran = runTss("bake swing.tss -o baked.tss" + paper + growth, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        const Json fit = Json::parse(runTss("info baked.tss --json", folder.path()).out)["pairs"][0];
        CHECK(fit["fit"]["A"]["coverage"].get<double>() >= fit["fit"]["A"]["coverageP95"].get<double>());
        CHECK(fit["fit"]["A"]["coverageMean"].get<double>() > 0);
        CHECK(fit["fit"]["A"]["protrusion"].get<double>() >= fit["fit"]["A"]["protrusionP95"].get<double>());
        CHECK(fit["fit"]["A"]["volumeRatio"].get<double>() > 0);
        return fit["spheresA"].get<int>();
    };
    CHECK(spheres("--growth 1mm,0.5mm,12mm,12mm") > 0);
    CHECK(spheres("--growth 0.03,0.015,0.35,0.35") > 0);
}

TEST_CASE("spheres that lack a part of the surface prove nothing by staying apart") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.1, -1, -1}, {2, 1, 1}), folder / "b.obj");
    REQUIRE(runTss("make -o near.tss --a a.obj --b b.obj --dof trans:1,0,0:0:3", folder.path()).exit == 0);
    const auto never = [&](const std::string& settings) {
        const Ran ran = runTss("bake near.tss -o baked.tss --json " + settings, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        return Json::parse(ran.out)["pairs"][0]["neverCollides"].get<bool>();
    };
    CHECK(never("--tolerance 0.02"));
    CHECK(never("--tolerance 0.02 --no-conservative"));
    CHECK_FALSE(never("--tolerance 0.2 --no-conservative"));
    CHECK_FALSE(never("--spheres growth")); // none at all
}

TEST_CASE("bad input is exit 1 with a message that says where, and leaves no file") {
    const Folder folder;
    writeObj(boxMesh({0, 0, 0}, {1, 1, 1}), folder / "a.obj");
    writeText(folder.path() / "bad.tss",
              R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": 7})");
    writeText(folder.path() / "empty.obj", "");
    const auto refused = [&](const std::string& arguments, const std::string& expected) {
        const Ran ran = runTss(arguments, folder.path());
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find(expected) != std::string::npos);
    };
    refused("info missing.tss", "missing.tss");
    refused("info bad.tss", "/primChildren");
    refused("bake bad.tss -o out.tss", "/primChildren");
    refused("validate bad.tss", "/primChildren");
    refused("make -o out.tss --a missing.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", "missing.obj");
    refused("make -o out.tss --a empty.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", "empty.obj");
    refused("make -o out.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,0:0:1", "axis that is not zero");
    refused("make -o out.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:5:1", "LO <= HI");
    refused("make -o out.tss --a a.obj --b a.obj --dof trans:0,0,1:nan:1", "finite number");
    refused("make -o out.tss --a a.obj --b a.obj --dof swing:0,0,1:0:1", "rot:ORIGIN");
    CHECK(fileCount(folder.path()) == 3);

    REQUIRE(runTss("make -o ok.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", folder.path()).exit == 0);
    refused("query ok.tss --poses bad.tss -o r.csv", "no table");
    refused("bake ok.tss -o out.tss --tolerance -1mm", "--tolerance");
    refused("bake ok.tss -o out.tss --tolerance 1furlong", "length");
    refused("bake ok.tss -o out.tss --spheres cubes", "medial");
    refused("bake ok.tss -o out.tss --spheres growth --growth 0.1,0.1mm,1,1", "START,STEP,END,MAXRADIUS");
    refused("bake ok.tss -o out.tss --spheres growth --growth 0.1,0.1,1", "START,STEP,END,MAXRADIUS");
    refused("bake ok.tss -o no/such/folder/out.tss --tolerance 0.1", "no/such/folder");
    CHECK(fileCount(folder.path()) == 4);
}

TEST_CASE("validation says line and column of everything wrong") {
    const Folder folder;
    writeText(folder / "bad.tss", "{\"format\": \"osgtss\", \"formatVersion\": \"1.0\",\n"
                                  " \"metadata\": {\"upAxis\": \"X\", \"metersPerUnit\": 0}}");
    const Ran text = runTss("validate bad.tss", folder.path());
    CHECK(text.exit == 1);
    CHECK(text.err.find("bad.tss:2:47: /metadata/metersPerUnit: expected a number above 0") !=
          std::string::npos);
    CHECK(text.err.find("bad.tss:2:25: /metadata/upAxis: ") != std::string::npos);
    const Json json = Json::parse(runTss("validate bad.tss --json", folder.path()).out);
    REQUIRE(json["errors"].size() == 2);
    CHECK(json["errors"][0]["pointer"] == "/metadata/metersPerUnit");
    CHECK(json["errors"][0]["line"] == 2);
    CHECK(json["errors"][0]["column"] == 47);
}

TEST_CASE(
    "a scene is converted to and from a buffer beside it, and a save that cannot end leaves the old files") {
    const Folder folder;
    writeSwing(folder);
    CHECK(runTss("convert swing.tss plain.tss", folder.path()).exit == 0);
    const Ran packed = runTss("convert swing.tss packed.tss --buffers --json", folder.path());
    REQUIRE(packed.exit == 0);
    const std::string buffer = Json::parse(packed.out)["buffer"];
    CHECK(std::filesystem::exists(folder / buffer));
    CHECK(runTss("convert packed.tss again.tss", folder.path()).exit == 0);
    CHECK(readText(folder / "again.tss") == readText(folder / "plain.tss"));

    const auto files = fileCount(folder.path());
    const Ran full = runTss("convert swing.tss packed.tss", folder.path(), "ulimit -f 1"); // 512 bytes
    CHECK(full.exit == 1);
    CHECK(full.err.find("packed.tss: cannot be written") != std::string::npos);
    CHECK(fileCount(folder.path()) == files);
    CHECK(runTss("validate packed.tss", folder.path()).exit == 0);
}

TEST_CASE("with --json one object stands on stdout, also when it fails") {
    const Folder folder;
    const Ran ran = runTss("info missing.tss --json", folder.path());
    CHECK(ran.exit == 1);
    const Json error = Json::parse(ran.out);
    CHECK(error["error"]["file"] == "missing.tss");
}

TEST_CASE("a scene goes from JSON to binary and back without a change, and to .usda") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o a.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    REQUIRE(runTss("convert a.tss b.tss --binary", folder.path()).exit == 0);
    REQUIRE(runTss("convert b.tss c.tss", folder.path()).exit == 0);
    REQUIRE(runTss("convert c.tss d.usda", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "a.tss") == readText(folder.path() / "c.tss"));
    CHECK(readText(folder.path() / "a.tss") != readText(folder.path() / "b.tss"));
    CHECK(readText(folder.path() / "d.usda").starts_with("#usda 1.0"));
    CHECK(runTss("info b.tss", folder.path()).exit == 0);
}

TEST_CASE("pairs baked apart and merged give the bytes of the plain bake") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o whole.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    REQUIRE(runTss("bake swing.tss -o part.tss --tolerance 0.5 --pair /swing/Joint --quiet", folder.path())
                .exit == 0);
    REQUIRE(runTss("merge swing.tss part.tss -o merged.tss", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "whole.tss") == readText(folder.path() / "merged.tss"));
}

TEST_CASE("a baked table is verified, and one with a test taken out is not") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    const Ran good = runTss("verify baked.tss --json", folder.path());
    INFO(good.err);
    CHECK(good.exit == 0);
    CHECK(Json::parse(good.out)["holds"] == true);

    tss::SceneModel scene = tss::loadScene(folder / "baked.tss");
    tss::Table damaged = *scene.pairs[0].table;
    REQUIRE(damaged.testCount() > 1);
    damaged.columns.pop_back();
    --damaged.rowOffsets.back();
    scene.pairs[0].table = std::make_shared<tss::Table>(damaged);
    tss::saveScene(scene, folder / "damaged.tss");
    const Ran bad = runTss("verify damaged.tss", folder.path());
    CHECK(bad.exit == 1);
    CHECK(bad.err.find("/swing/Joint") != std::string::npos);
}

TEST_CASE("a table made for other limits is refused by all that answer from it, and shown as stale") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    std::string text = readText(folder.path() / "baked.tss");
    const std::size_t limit = text.find("upperLimit");
    const std::size_t value = text.find("90", limit);
    REQUIRE(value != std::string::npos);
    writeText(folder.path() / "stale.tss", text.replace(value, 2, "80"));
    writeText(folder.path() / "q.csv", "0\n10\n");
    for (const char* command :
         {"query stale.tss --poses q.csv -o r.csv", "play stale.tss --motion q.csv -o r.csv",
          "bench stale.tss --queries 10", "verify stale.tss"}) {
        const Ran ran = runTss(command, folder.path());
        INFO(command << ": " << ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("/swing/Joint") != std::string::npos);
        CHECK(ran.err.find("limits") != std::string::npos);
    }
    const Ran info = runTss("info stale.tss", folder.path());
    CHECK(info.exit == 0);
    CHECK(info.out.find("stale") != std::string::npos);
    CHECK(runTss("info baked.tss", folder.path()).out.find("stale") == std::string::npos);
}

TEST_CASE("a baked table is timed with each question, and with as many hits whichever way it is asked") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    const auto bench = [&](const std::string& options) {
        const Ran ran = runTss("bench baked.tss --queries 3000 --json " + options, folder.path());
        INFO(options << ": " << ran.err);
        REQUIRE(ran.exit == 0);
        return Json::parse(ran.out);
    };
    const Json best = bench("");
    CHECK(best["queries"] == 3000);
    CHECK(best["tests"].get<int>() > 0);
    CHECK(best["ns"].get<double>() > 0);
    CHECK(best["hits"].get<int>() > 0);
    CHECK(best["hits"].get<int>() < 3000);
    for (const char* options : {"--kernel scalar", "--with gap", "--with contact", "--with pose"}) {
        INFO(options);
        const Json other = bench(options);
        CHECK(other["ns"].get<double>() > 0);
        CHECK(std::abs(other["hits"].get<int>() - best["hits"].get<int>()) <= 3); // at the very verge
    }
    CHECK(bench("--with features")["hits"] == 0); // no test is asked
    const Ran unknown = runTss("bench baked.tss --with luck", folder.path());
    CHECK(unknown.exit == 1);
    CHECK(unknown.err.find("luck") != std::string::npos);
}

TEST_CASE("a degree of freedom along a measured path stops where the meshes meet") {
    const Folder folder;
    writeObj(ballMesh({0, 0, 0}, 10, 3), folder / "still.obj");
    writeObj(ballMesh({30, 0, 0}, 5, 3), folder / "moving.obj");
    // 20 units along -x, then out sideways.
    writeText(folder.path() / "way.csv", "0,0,0,0\n1,-20,0,0\n2,-20,40,0\n");
    const std::string make = "make --a still.obj --b moving.obj --meters-per-unit 0.001 ";
    const Ran made = runTss(make + "-o path.tss --dof path:way.csv:0:2", folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
    REQUIRE(runTss("bake path.tss -o baked.tss --tolerance 0.2mm --quiet", folder.path()).exit == 0);
    // Centres 30, 16, 14, 10, 12.8 and 41 apart; the radii make 15.
    writeText(folder.path() / "q.csv", "0\n0.7\n0.8\n1\n1.2\n2\n");
    REQUIRE(runTss("query baked.tss --poses q.csv -o r.csv", folder.path()).exit == 0);
    std::istringstream rows(readText(folder.path() / "r.csv"));
    std::string verdicts, row;
    std::getline(rows, row);
    while (std::getline(rows, row)) verdicts += row[row.find(',') + 1];
    CHECK(verdicts == "001110");

    writeText(folder.path() / "short.csv", "0,0,0\n1,-20,0\n");
    const Ran short_ = runTss(make + "-o short.tss --dof path:short.csv:0:1", folder.path());
    CHECK(short_.exit == 1);
    CHECK(short_.err.find("short.csv") != std::string::npos);
    CHECK(short_.err.find("4 or 7 columns") != std::string::npos);
}

TEST_CASE("a motion played without tables says that nothing is kept apart") {
    const Folder folder;
    writeSwing(folder);
    writeText(folder.path() / "q.csv", "0\n10\n");
    const Ran ran = runTss("play swing.tss --motion q.csv -o r.csv", folder.path());
    CHECK(ran.exit == 0);
    CHECK(ran.out.find("/swing/Joint is not kept apart") != std::string::npos);
}

TEST_CASE("a motion that asks for more than the limits is played up to them, and that is said") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    writeText(folder.path() / "q.csv", "0\n10\n90\n170\n");
    const Ran ran = runTss("play baked.tss --motion q.csv -o r.csv", folder.path());
    CHECK(ran.exit == 0);
    CHECK(ran.out.find("1 of 4 steps") != std::string::npos);
    writeText(folder.path() / "q.csv", "0\n10\n90\n");
    CHECK(runTss("play baked.tss --motion q.csv -o r.csv", folder.path()).out.find("limits") ==
          std::string::npos);
}

TEST_CASE("a file that is read is not overwritten by the answer") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    writeText(folder.path() / "q.csv", "0\n10\n");
    for (const char* command :
         {"query baked.tss --poses q.csv -o ./q.csv", "query baked.tss --poses q.csv -o baked.tss",
          "play baked.tss --motion q.csv -o q.csv"}) {
        const Ran ran = runTss(command, folder.path());
        INFO(command << ": " << ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("another name") != std::string::npos);
    }
    CHECK(readText(folder.path() / "q.csv") == "0\n10\n");
}

TEST_CASE("a first line of nan is a bad number, not a header") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    for (const char* value : {"nan", "NaN", "inf", "-inf"}) {
        writeText(folder.path() / "q.csv", std::string(value) + "\n0\n");
        const Ran ran = runTss("query baked.tss --poses q.csv -o r.csv", folder.path());
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("q.csv:1: column 1") != std::string::npos);
    }
}

TEST_CASE("columns that are named in another order than the joint has them are refused") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.5, -1, -1}, {2, 1, 1}), folder / "b.obj");
    REQUIRE(runTss("make -o two.tss --a a.obj --b b.obj --dof rot:0,0,0:0,1,0:-5:5 --dof trans:1,0,0:-1:1 "
                   "--rest 2,0.5",
                   folder.path())
                .exit == 0);
    REQUIRE(runTss("bake two.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    const Ran info = runTss("info baked.tss", folder.path());
    CHECK(info.out.find("rot -5 to 5 degrees, rest 2; trans -1 to 1, rest 0.5") != std::string::npos);
    const auto run = [&](const std::string& header, const std::string& command) {
        writeText(folder.path() / "q.csv", header + "\n" + (command == "query" ? "0,0\n" : "0,0,0\n"));
        return runTss(command + " baked.tss " + (command == "query" ? "--poses" : "--motion") +
                          " q.csv -o r.csv",
                      folder.path());
    };
    CHECK(run("rot,trans", "query").exit == 0);
    CHECK(run("pitch,reach", "query").exit == 0);
    CHECK(run("time,rot,trans", "play").exit == 0);
    for (const auto& [header, command] : {std::pair{"trans,rot", "query"}, {"time,trans,rot", "play"}}) {
        const Ran ran = run(header, command);
        INFO(ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("expected the degree of freedom \"rot\", found \"trans\"") != std::string::npos);
    }
}

TEST_CASE("an axis that is in another unit than the meshes is remarked upon") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.5, -1, -1}, {2, 1, 1}), folder / "b.obj");
    const auto said = [&](const std::string& origin) {
        const Ran ran =
            runTss("make -o s.tss --a a.obj --b b.obj --dof rot:" + origin + ":0,1,0:0:5", folder.path());
        CHECK(ran.exit == 0);
        return ran.out + ran.err;
    };
    CHECK(said("1200,0,300").find("same unit") != std::string::npos);
    CHECK(said("1.2,5000,0.3").find("same unit") == std::string::npos); // anywhere along the axis
}

TEST_CASE("--pair may be repeated, and takes nothing after its path") {
    const Folder folder;
    writeSwing(folder);
    const Ran ran = runTss("bake --pair /swing/Joint swing.tss -o baked.tss --tolerance 0.5", folder.path());
    INFO(ran.err);
    CHECK(ran.exit == 0);
    const Ran twice = runTss("bake --pair /swing/Joint --pair /swing/No swing.tss -o b.tss", folder.path());
    CHECK(twice.exit == 1);
    CHECK(twice.err.find("/swing/No") != std::string::npos);
}
