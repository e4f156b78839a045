// What the commands refuse or remark upon, and what they then leave as it was.
#include "tests/tool/Swing.h"

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

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
    CHECK(never("--tolerance 0.2 --no-conservative")); // finer than asked for, so that they are apart at rest
    CHECK_FALSE(never("--spheres growth"));            // none at all
}

TEST_CASE("never to collide takes a distance of the meshes, and touching is none") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.1, -1, -1}, {2, 1, 1}), folder / "near.obj");
    writeObj(boxMesh({1, -1, -1}, {2, 1, 1}), folder / "at.obj");
    const auto baked = [&](const std::string& b, const std::string& settings) {
        REQUIRE(runTss("make -o in.tss --a a.obj --b " + b + " --dof trans:1,0,0:0:3", folder.path()).exit ==
                0);
        const Ran ran = runTss("bake in.tss -o baked.tss --json --tolerance 0.02 " + settings, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        return Json::parse(ran.out)["pairs"][0];
    };
    for (const std::string settings : {"", "--no-conservative", "--no-conservative --spheres shrinking"}) {
        INFO(settings);
        const Json pair = baked("near.obj", settings);
        CHECK(pair["neverCollides"].get<bool>());
        CHECK(pair["clearance"].get<double>() > 0);
        CHECK(pair["clearance"].get<double>() <= 0.1); // inscribed spheres are farther apart than that
    }
    // Inscribed spheres of boxes that touch are apart.
    CHECK_FALSE(baked("at.obj", "--no-conservative")["neverCollides"].get<bool>());
    CHECK_FALSE(baked("at.obj", "--at-rest collide")["neverCollides"].get<bool>());
}

TEST_CASE("a setting that does nothing with the others is refused, and one of the scene's counts") {
    const Folder folder;
    writeSwing(folder);
    const auto exits = [&](const std::string& arguments) {
        const Ran ran = runTss("bake " + arguments + " -o out.tss --quiet --tolerance 1mm", folder.path());
        INFO(ran.err);
        return ran.exit;
    };
    CHECK(exits("swing.tss --samples 100") == 2);
    CHECK(exits("swing.tss --growth 0.01,0.01,0.1,0.02") == 2);
    CHECK(exits("swing.tss --samples 100 --spheres growth") == 2);
    CHECK_FALSE(std::filesystem::exists(folder / "out.tss"));
    CHECK_THAT(runTss("bake swing.tss -o out.tss --samples 100", folder.path()).err,
               Catch::Contains("--search sampled"));
    CHECK(exits("swing.tss --samples 100 --reduce minimal") == 0);
    CHECK(exits("swing.tss --samples 100 --search sampled") == 0);
    std::filesystem::rename(folder / "out.tss", folder / "sampled.tss");
    CHECK(exits("sampled.tss --samples 200") == 0); // the scene has kept --search sampled
}

TEST_CASE("a report refuses a motion that leaves the limits, and a seed below 0") {
    const Folder folder;
    writeSwing(folder);
    if (runTss("report --help", folder.path()).exit != 0) {
        WARN("skipped, this build has no report");
        return;
    }
    writeText(folder.path() / "m.csv", "rot\n0\n91\n");
    const Ran beyond = runTss("report swing.tss -o out --quick --motion m.csv", folder.path());
    CHECK(beyond.exit == 1);
    CHECK_THAT(beyond.err, Catch::Contains("m.csv: row 2 is outside the limits"));
    const Ran seed = runTss("report swing.tss -o out --quick --seed -1", folder.path());
    CHECK(seed.exit == 2);
    CHECK_THAT(seed.err, Catch::Contains("from 0 on"));
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
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
    refused("make -o out.tss --a a.obj --b a.obj --dof trans:0,0,1:0:+-1", "found \"+-1\"");
    refused("make -o out.tss --a a.obj --b a.obj --dof swing:0,0,1:0:1", "rot:ORIGIN");
    for (const std::string unit : {"0", "-1", "nan", "mm", "1 parsec"})
        refused("make -o out.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1 --meters-per-unit '" + unit +
                    "'",
                "such as 1mm, found \"" + unit + "\"");
    refused("make -o a.obj --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", "ends in .tss");
    refused("make -o out.stl --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", "ends in .tss");
    refused("make -o no/out.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", "no folder no");
    CHECK(readText(folder.path() / "a.obj").starts_with("v "));
    CHECK(fileCount(folder.path()) == 3);

    REQUIRE(runTss("make -o ok.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:0:1", folder.path()).exit == 0);
    refused("query ok.tss --poses bad.tss -o r.csv", "no table");
    refused("bake ok.tss -o out.tss --tolerance -1mm", "--tolerance");
    refused("bake ok.tss -o out.tss --tolerance 1furlong",
            "tss: --tolerance: length"); // no fault of the file
    refused("bake ok.tss -o out.tss --tolerance 300nm", "a number with um, mm, cm, m, km, in or ft");
    refused("bake ok.tss -o out.tss --spheres cubes", "medial");
    refused("bake ok.tss -o out.tss --spheres growth --growth 0.1,0.1mm,1,1", "START,STEP,END,MAXRADIUS");
    refused("bake ok.tss -o out.tss --spheres growth --growth 0.1,0.1,1", "START,STEP,END,MAXRADIUS");
    refused("bake ok.tss -o no/such/folder/out.tss --tolerance 0.1", "no/such/folder");
    CHECK(fileCount(folder.path()) == 4);
}

TEST_CASE("sizes and limits that look like another unit are remarked upon, others are not") {
    const Folder folder;
    writeObj(boxMesh({0, 0, 0}, {30, 1, 1}), folder / "a.obj");
    const auto said = [&](const std::string& arguments) {
        const Ran ran =
            runTss("make -o out.tss --a a.obj --b a.obj --dof rot:0,0,0:0,0,1:" + arguments, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        return ran.out;
    };
    const auto tells = [&](const std::string& arguments, const std::string& note) {
        return said(arguments).find(note) != std::string::npos;
    };
    CHECK(tells("0:90", "--meters-per-unit 0.001"));
    CHECK(tells("0:90", "30 m x 1 m x 1 m"));
    CHECK_FALSE(tells("0:90 --meters-per-unit 0.001", "note:"));
    CHECK(tells("0:90 --meters-per-unit 1mm", "30 mm x 1 mm x 1 mm"));
    CHECK(tells("-0.35:0.6 --meters-per-unit 0.001", "not radians"));
    const Ran baked = runTss("bake out.tss -o baked.tss --tolerance 1e-4 --spheres growth", folder.path());
    CHECK(baked.out.find("very many spheres") != std::string::npos);
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

TEST_CASE("a motion played without tables says that nothing is kept apart") {
    const Folder folder;
    writeSwing(folder);
    writeText(folder.path() / "q.csv", "0\n10\n");
    const Ran ran = runTss("play swing.tss --motion q.csv -o r.csv", folder.path());
    CHECK(ran.exit == 0);
    CHECK(ran.out.find("not kept apart: 1 pair without a table, which tss bake makes: /swing/Joint") !=
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

TEST_CASE("columns are read as the first line names them, in any order") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.5, -1, -1}, {2, 1, 1}), folder / "b.obj");
    REQUIRE(runTss("make -o two.tss --a a.obj --b b.obj --dof rot:0,0,0:0,1,0:-5:5 --dof trans:1,0,0:-1:1 "
                   "--rest 2,0.5",
                   folder.path())
                .exit == 0);
    REQUIRE(runTss("bake two.tss -o baked.tss --tolerance 0.5 --quiet", folder.path()).exit == 0);
    const Ran info = runTss("info baked.tss", folder.path());
    CHECK(info.out.find("rot -5 to 5 degrees, rest 2; trans -1 to 1 times 1 m, rest 0.5") !=
          std::string::npos);
    const auto run = [&](const std::string& text, const std::string& command) {
        writeText(folder.path() / "q.csv", text);
        return runTss(command + " baked.tss " + (command == "query" ? "--poses" : "--motion") +
                          " q.csv -o r.csv",
                      folder.path());
    };
    const auto answer = [&](const std::string& text, const std::string& command) {
        const Ran ran = run(text, command);
        INFO(ran.err);
        CHECK(ran.exit == 0);
        CHECK((ran.out + ran.err).find("its first line") == std::string::npos);
        return readText(folder.path() / "r.csv");
    };
    const std::string pose = answer("1,0.25\n", "query"), step = answer("1,0.25\n", "play");
    CHECK(answer("rot,trans\n1,0.25\n", "query") == pose);
    CHECK(answer("trans,rot\n0.25,1\n", "query") == pose);
    CHECK(answer("Joint:trans,rot\n0.25,1\n", "query") == pose);
    CHECK(answer("\xEF\xBB\xBFtrans,rot\r\n0.25,1\r\n", "query") == pose); // as spreadsheets write it
    CHECK(answer("time,trans,rot\n0,0.25,1\n", "play") == step);
    CHECK(answer("trans,rot\n0.25,1\n", "play") == step);
    CHECK(answer("Trans,ROT\n0.25,1\n", "query") == pose);
    CHECK(answer("Time,Trans,Rot\n0,0.25,1\n", "play") == step);
    CHECK(answer("  # one pose\n1,0.25\n", "query") == pose);
    CHECK(answer("0.25,1\n", "query") != pose);

    CHECK(run("trans\n0.25\n", "query").err.find("expected a column of rot") != std::string::npos);
    CHECK(answer("trans\n0.25\n", "play") == answer("2,0.25\n", "play")); // the other one rests
    const Ran rests = run("step,trans\n0,0.25\n", "play");
    CHECK((rests.out + rests.err).find("no column of rot: what has none stays where it rests") !=
          std::string::npos);

    const Ran own = run("pitch,reach\n1,0.25\n", "query");
    CHECK(own.exit == 0);
    CHECK((own.out + own.err).find("has none of the names rot, trans: the columns are taken in that order") !=
          std::string::npos);
    CHECK(readText(folder.path() / "r.csv") == pose);
    for (const auto& [header, words] :
         {std::pair{"trans,rots", "\"rots\" is no degree of freedom: expected rot, trans, in any order"},
          {"trans,trans", "expected one column of trans"},
          {"rot;trans\n1;2", "q.csv:2: column 1: expected one finite number, and commas between columns"},
          {"rot\ttrans\n1\t2", "expected one finite number, and commas between columns"}}) {
        const Ran ran = run(std::string(header) + "\n0.25,1\n", "query");
        INFO(ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find(words) != std::string::npos);
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
