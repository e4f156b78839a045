// What the commands do, as scripts count on it.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Swing.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

using Json = nlohmann::json;

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
    CHECK(line == "table_gap,hit,pair,px,py,pz,nx,ny,nz");
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

TEST_CASE("of a table without a test no gap is told, where none is") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({5, -1, -1}, {6, 1, 1}), folder / "b.obj");
    REQUIRE(runTss("make -o far.tss --a a.obj --b b.obj --dof trans:1,0,0:0:3", folder.path()).exit == 0);
    const Ran baked = runTss("bake far.tss -o baked.tss --tolerance 0.2 --search sampled --samples 50 --json",
                             folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    REQUIRE(Json::parse(baked.out)["pairs"][0]["tests"] == 0);
    writeText(folder.path() / "q.csv", "0\n3\n9\n");
    REQUIRE(runTss("query baked.tss --poses q.csv -o r.csv", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "r.csv") ==
          "table_gap,hit,pair,px,py,pz,nx,ny,nz\n,0,-1,,,,,,\n,0,-1,,,,,,\n,nan,-1,,,,,,\n");
    REQUIRE(runTss("play baked.tss -o p.csv", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "p.csv").find("inf") == std::string::npos);
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

TEST_CASE("a baked table is verified, and one with its tests taken out is not") {
    const Folder folder;
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    const Ran good = runTss("verify baked.tss --json", folder.path());
    INFO(good.err);
    CHECK(good.exit == 0);
    CHECK(Json::parse(good.out)["holds"] == true);
    CHECK(Json::parse(good.out)["pairs"][0]["decided"] == true);
    const Ran hasty = runTss("verify baked.tss --json --budget 1e-9", folder.path());
    CHECK(hasty.exit == 1);
    CHECK(hasty.err.find("not decided within 1e-09 s") != std::string::npos);
    CHECK(Json::parse(hasty.out)["holds"] == false);
    CHECK(Json::parse(hasty.out)["pairs"][0]["decided"] == false);

    tss::SceneModel scene = tss::loadScene(folder / "baked.tss");
    tss::Table damaged = *scene.pairs[0].table;
    REQUIRE(damaged.testCount() > 1);
    damaged.columns.clear();
    damaged.rowOffsets.assign(damaged.rowOffsets.size(), 0);
    scene.pairs[0].table = std::make_shared<tss::Table>(damaged);
    tss::saveScene(scene, folder / "damaged.tss");
    const Ran bad = runTss("verify damaged.tss", folder.path());
    CHECK(bad.exit == 1);
    CHECK(bad.err.find("/swing/Joint") != std::string::npos);
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

    // Rows are joined the short way round: three quarters of a turn forwards are one quarter back.
    writeText(folder.path() / "way.csv", "0,0,0,0,0,0,0\n1,0,0,0,0,270,0\n2,0,0,0,0,280,0\n");
    CHECK(runTss(make + "-o turned.tss --dof path:way.csv:0:2", folder.path())
              .out.find("with rotation, by at most 90 degrees from row to row") != std::string::npos);

    const auto refused = [&](const char* rows, const std::string& words) {
        writeText(folder.path() / "bad.csv", rows);
        const Ran ran = runTss(make + "-o bad.tss --dof path:bad.csv:0:1", folder.path());
        INFO(ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("bad.csv: " + words) != std::string::npos);
    };
    refused("0,0,0\n1,-20,0\n", "expected 4 or 7 columns");
    refused("0,0,0,0\n0.5,-20,0,0\n",
            "its values go from 0 to 0.5; expected rows that cover the limits 0 to 1");
    refused("0,0,0,0\n0,-20,0,0\n1,0,0,0\n", "expected values that rise, found 0 after 0");
    refused("tx,ty,tz,t\n0,0,0,0\n1,0,0,1\n", "column 1 is called tx; expected the order value,tx,ty,tz");
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
