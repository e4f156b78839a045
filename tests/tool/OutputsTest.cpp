// Where the commands write: under what names, and what of that is never lost.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Swing.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

using Json = nlohmann::json;

namespace {

/// swing.tss and its table, baked.tss.
void writeBaked(const Folder& folder) {
    writeSwing(folder);
    REQUIRE(runTss("bake swing.tss -o baked.tss --tolerance 2mm --budget 1 --quiet", folder.path()).exit ==
            0);
}

bool exists(const std::string& file) {
    return std::filesystem::exists(file);
}

/// Of a command that is to be refused.
void refused(const Folder& folder, const std::string& command, const std::string& words, int exit = 1) {
    const Ran ran = runTss(command, folder.path());
    INFO(command << "\n" << ran.err);
    CHECK(ran.exit == exit);
    CHECK(ran.err.find(words) != std::string::npos);
}

} // namespace

TEST_CASE("scenes are written under names of scenes alone, answers and frames under none of what is read") {
    const Folder folder;
    writeBaked(folder);
    writeText(folder.path() / "q.csv", "rot\n0\n10\n");
    const std::string mesh = readText(folder.path() / "still.obj");
    for (const char* name : {"still.obj", "swing.usda", "swing.urdf", "swing", "q.csv"}) {
        refused(folder, std::string("bake swing.tss -o ") + name, "ends in .tss");
        refused(folder, std::string("merge baked.tss -o ") + name, "ends in .tss");
        refused(folder, std::string("make --a still.obj --b swing.obj --dof trans:1,0,0:0:1 -o ") + name,
                "ends in .tss");
    }
    for (const char* name : {"still.obj", "swing.tss"}) {
        refused(folder, std::string("query baked.tss --poses q.csv -o ") + name, "such as out.csv");
        refused(folder, std::string("play baked.tss --motion q.csv -o ") + name, "such as out.csv");
    }
    refused(folder, "play baked.tss --motion q.csv --mesh-out f_%d.tss", "like f_%04d.obj");
    CHECK(readText(folder.path() / "still.obj") == mesh);
}

TEST_CASE("what cannot be written is refused before anything is done, and links are followed") {
    const Folder folder;
    writeBaked(folder);
    writeText(folder.path() / "q.csv", "0\n");
    refused(folder, "bake swing.tss -o none/out.tss", "there is no folder none");
    refused(folder, "query baked.tss --poses q.csv -o none/out.csv", "there is no folder none");
    refused(folder, "convert swing.tss none/out.usda", "there is no folder none");
    refused(folder, "bake swing.tss -o " + std::string(260, 'x') + ".tss", "File name too long");
    REQUIRE(mkfifo((folder / "pipe.tss").c_str(), 0600) == 0);
    refused(folder, "bake swing.tss -o pipe.tss", "expected a regular file");

    const std::string longest = std::string(245, 'x') + ".tss"; // as long as a name may nearly be
    CHECK(runTss("merge baked.tss -o " + longest, folder.path()).exit == 0);
    CHECK(exists(folder / longest));
    std::filesystem::create_symlink("target.tss", folder.path() / "link.tss");
    CHECK(runTss("merge baked.tss -o link.tss", folder.path()).exit == 0);
    CHECK(std::filesystem::is_symlink(folder.path() / "link.tss"));
    CHECK(exists(folder / "target.tss"));
}

TEST_CASE("what an earlier bake has kept is not lost to a later one, and goes once that is whole") {
    const Folder folder;
    writeSwing(folder);
    tss::SceneModel scene = tss::loadScene(folder / "swing.tss");
    scene.pairs[0].settings = {{"search", "sampled"}, {"budget", "1e-9"}};
    tss::saveScene(scene, folder / "fails.tss");
    writeText(folder.path() / "out.incomplete.tss", "of hours");
    CHECK(runTss("bake fails.tss -o out.tss", folder.path()).exit == 1);
    CHECK(runTss("bake swing.tss -o out.tss --tolerance 2mm", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "out.incomplete.tss") == "of hours");

    std::filesystem::copy_file(folder.path() / "swing.tss", folder.path() / "next.incomplete.tss");
    CHECK(runTss("bake next.incomplete.tss -o next.tss --tolerance 2mm", folder.path()).exit == 0);
    CHECK(exists(folder / "next.tss"));
    CHECK_FALSE(exists(folder / "next.incomplete.tss"));
}

TEST_CASE("what is said has got out, or the exit says that it has not") {
    const Folder folder;
    writeBaked(folder);
    for (const char* command :
         {"info baked.tss", "info baked.tss --paths", "info baked.tss --json", "--help"})
        CHECK(runTss(std::string(command) + " >/dev/full #", folder.path()).exit == 1);
    CHECK(Json::parse(runTss("info baked.tss --paths --json", folder.path()).out)["paths"] ==
          Json::array({"/swing/Joint"}));
    CHECK(runTss("info baked.tss --quiet", folder.path()).out.find("bounds") != std::string::npos);
}

TEST_CASE("a name that is no UTF-8 is answered in JSON all the same") {
    const Folder folder;
    writeBaked(folder);
    std::filesystem::copy_file(folder.path() / "baked.tss", folder.path() / "ba\xe9.tss");
    const Ran ran = runTss("validate ba\xe9.tss --json", folder.path());
    CHECK(ran.exit == 0);
    CHECK_FALSE(Json::parse(ran.out).is_null());
    const Ran missing = runTss("info no\xe9.tss --json", folder.path());
    CHECK(missing.exit == 1);
    CHECK(Json::parse(missing.out)["exit"] == 1);
}

TEST_CASE("parts of another scene are not merged") {
    const Folder folder;
    writeBaked(folder);
    std::string text = readText(folder.path() / "swing.tss");
    const std::size_t limit = text.find("90", text.find("upperLimit"));
    REQUIRE(limit != std::string::npos);
    writeText(folder.path() / "other.tss", text.replace(limit, 2, "80"));
    REQUIRE(runTss("bake other.tss -o part.tss --tolerance 2mm --quiet", folder.path()).exit == 0);
    refused(folder, "merge swing.tss part.tss -o merged.tss", "was baked from another scene");
    CHECK_FALSE(exists(folder / "merged.tss"));
}

TEST_CASE("poses whose lines end as they did long ago are read, and a file of none is refused") {
    const Folder folder;
    writeBaked(folder);
    writeText(folder.path() / "old.csv", "rot\r0\r10\r");
    CHECK(Json::parse(
              runTss("query baked.tss --poses old.csv -o a.csv --json", folder.path()).out)["poses"] == 2);
    writeText(folder.path() / "none.csv", "rot\n");
    refused(folder, "query baked.tss --poses none.csv -o a.csv", "at least one row");
    refused(folder, "play baked.tss --motion none.csv", "at least one row");
    // One file of motion for all commands.
    writeText(folder.path() / "m.csv", "step,rot\n0,0\n4,20\n");
    const std::string make =
        "make --a still.obj --b swing.obj --meters-per-unit 0.001 --dof rot:25,0,0:0,0,1:-40:90 ";
    CHECK(runTss(make + "-o moved.tss --motion m.csv", folder.path()).exit == 0);
    CHECK(tss::loadScene(folder / "moved.tss").endTimeCode == 4);
    writeText(folder.path() / "far.csv", "step,rot\n0,0\n1e12,20\n");
    CHECK(runTss(make + "-o far.tss --motion far.csv", folder.path()).exit == 0);
    refused(folder, "play far.tss", "expected at most 1e+07");
}

TEST_CASE("idle options are refused") {
    const Folder folder;
    writeBaked(folder);
    refused(folder, "bake swing.tss -o out.tss --all-pairs --pairs-only --tolerance 5cm", "do nothing", 2);
    refused(folder, "bench baked.tss --queries 0", "queries", 2);
    refused(folder, "verify baked.tss --budget -1", "budget", 2);
    refused(folder, "convert still.obj x.tss --meters-per-unit 0", "expected a number > 0");
    CHECK(runTss("convert still.obj x.tss --meters-per-unit 1mm", folder.path()).exit == 0);
    CHECK(tss::loadScene(folder / "x.tss").metersPerUnit == 0.001);
}

TEST_CASE("what is said of each pair stands in a file as soon as it is known, in order with what is wrong") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({1.1, -1, -1}, {2, 1, 1}), folder / "b.obj");
    writeObj(boxMesh({-2, -1, -1}, {-1.1, 1, 1}), folder / "c.obj");
    REQUIRE(runTss("make -o in.tss --pairs neighbours --body a.obj --body b.obj --body c.obj --joint "
                   "X=a,b:trans:1,0,0:0:3 --joint Y=a,c:trans:1,0,0:-3:0",
                   folder.path())
                .exit == 0);
    REQUIRE(runTss("bake in.tss -o baked.tss", folder.path()).exit == 0);
    tss::SceneModel scene = tss::loadScene(folder / "baked.tss");
    REQUIRE(scene.pairs.size() == 2);
    REQUIRE(scene.pairs[1].proof);
    tss::NeverCollides wrong = *scene.pairs[1].proof;
    wrong.clearance = 1;
    scene.pairs[1].proof = std::make_shared<tss::NeverCollides>(wrong);
    tss::saveScene(scene, folder / "wrong.tss");
    const std::string command =
        "cd '" + folder.path().string() + "' && '" TSS_PROGRAM "' verify wrong.tss >both 2>&1";
    CHECK(std::system(command.c_str()) != 0);
    const std::string both = readText(folder / "both");
    INFO(both);
    const std::size_t holds = both.find("holds at every pose"),
                      fails = both.find("nearer than the clearance"), sum = both.find("2 pairs: 1 hold");
    REQUIRE(sum != std::string::npos);
    CHECK(holds < fails);
    CHECK(fails < sum);
}
