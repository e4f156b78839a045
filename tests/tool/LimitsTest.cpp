// What the commands say and answer beyond the limits of joints and of tables.
#include "tests/tool/Swing.h"

#include <nlohmann/json.hpp>
#include <sstream>

using Json = nlohmann::json;

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

TEST_CASE("a query beyond limits that are far from 0 is not answered at a pose within them") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({9, -1, -1}, {11, 1, 1}), folder / "b.obj");
    writeText(folder.path() / "way.csv", "value,tx,ty,tz\n1700000000,0,0,0\n1700000100,-20,0,0\n");
    REQUIRE(
        runTss("make -o far.tss --a a.obj --b b.obj --dof path:way.csv:1700000000:1700000030", folder.path())
            .exit == 0);
    REQUIRE(runTss("bake far.tss -o baked.tss --tolerance 0.1", folder.path()).exit == 0);
    writeText(folder.path() / "poses.csv", "path\n1700000000\n1700000030\n1700000050\n");
    for (const std::string pairs : {"", " --all-pairs"}) {
        const Ran ran =
            runTss("query baked.tss --json --poses poses.csv -o answers.csv" + pairs, folder.path());
        INFO(ran.err);
        CHECK(Json::parse(ran.out)["outsideRows"] == Json{2}); // where the boxes overlap
    }
}

TEST_CASE("a query beyond the limits says so, and claims nothing there") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.1, -1, -1}, {2, 1, 1}), folder / "b.obj");
    // What 6 printed digits round a limit to is the limit; a sixth of the range is not.
    writeText(folder / "q.csv", "0\n-0.5\n1\n3.00001\n4\n");
    const auto asked = [&](const std::string& limits) {
        REQUIRE(
            runTss("make -o in.tss --a a.obj --b b.obj --dof trans:1,0,0:" + limits, folder.path()).exit ==
            0);
        REQUIRE(runTss("bake in.tss -o baked.tss --tolerance 0.02", folder.path()).exit == 0);
        const Ran said = runTss("query baked.tss --poses q.csv -o r.csv", folder.path());
        CHECK(said.out.find("outside the limits") != std::string::npos);
        return Json::parse(runTss("query baked.tss --poses q.csv -o r.csv --json", folder.path()).out);
    };
    const Json apart = asked("0:3"); // they never meet there; at -0.5 they do
    CHECK(apart["hits"] == 0);
    CHECK(apart["outsideLimits"] == 2);
    CHECK(apart["outsideRows"] == Json::array({1, 4}));
    const std::string rows = readText(folder / "r.csv");
    CHECK(rows.find("nan,nan,-1,,,,,,\n") != std::string::npos);
    const Json table = asked("-0.3:3");
    CHECK(table["outsideRows"] == Json::array({1, 4}));
    CHECK(table["hits"] == 0); // the one beyond the limits is none of the table's
    std::istringstream lines(readText(folder.path() / "r.csv"));
    for (const char* hit : {"hit", "0", "nan", "0", "0", "nan"}) {
        std::string line, cell;
        std::getline(lines, line);
        std::istringstream cells(line);
        std::getline(cells, cell, ',');
        std::getline(cells, cell, ',');
        CHECK(cell == hit);
    }
}

TEST_CASE("all pairs are asked at once from the values of all joints, and beyond limits nothing is claimed") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.1, -1, -1}, {2, 1, 1}), folder / "b.obj");
    writeObj(boxMesh({-1, 2.5, -1}, {1, 4, 1}), folder / "c.obj");
    REQUIRE(runTss("make -o in.tss --pairs all --body a.obj --body b.obj --body c.obj --joint "
                   "X=a,b:trans:1,0,0:-0.3:3 "
                   "--joint Y=b,c:trans:0,1,0:-2:3",
                   folder.path())
                .exit == 0);
    REQUIRE(runTss("bake in.tss -o baked.tss --tolerance 0.1", folder.path()).exit == 0);
    // Free; a and b meet; a and c do; the second joint is beyond its limits; it is, and a and b meet.
    writeText(folder / "q.csv", "0.5,0\n-0.25,0\n0.5,-2\n0.5,4\n-0.25,4\n");
    const Ran said = runTss("query baked.tss --all-pairs --poses q.csv -o r.csv --json", folder.path());
    INFO(said.err);
    REQUIRE(said.exit == 0);
    const Json found = Json::parse(said.out);
    CHECK(found["poses"] == 5);
    CHECK(found["hits"] == 3);
    CHECK(found["outsideRows"] == Json::array({3}));
    std::istringstream rows(readText(folder / "r.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(rows, line);) lines.push_back(line);
    REQUIRE(lines.size() == 6);
    CHECK(lines[0] == "hit,pair");
    CHECK(lines[1] == "0,");
    CHECK(lines[2].substr(0, 3) == "1,/");
    CHECK(lines[3].substr(0, 3) == "1,/");
    CHECK(lines[4] == "nan,");
    CHECK(lines[5] == lines[2]);
    // A scene with a pair that is not baked has no answer.
    CHECK(runTss("query in.tss --all-pairs --poses q.csv -o r.csv", folder.path()).exit != 0);
}
