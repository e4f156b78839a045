// What a bake refuses is refused before anything is baked, and what is baked is not lost to what comes later.
#include "bake/base/Stopwatch.h"
#include "bake/scene/SceneFile.h"
#include "tests/tool/Swing.h"

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

namespace {

/// A ball and two others that swing about the Z axis, each of which can hit it.
void writeTwo(const Folder& folder) {
    writeObj(ballMesh({0, 0, 0}, 10, 3), folder / "still.obj");
    tss::TriangleMesh open = ballMesh({0, 30, 0}, 5, 3);
    open.triangles.pop_back(); // which is told of it once its pair is baked
    writeObj(open, folder / "first.obj");
    writeObj(ballMesh({0, -30, 0}, 5, 3), folder / "second.obj");
    const Ran made =
        runTss("make -o two.tss --body still.obj --body first.obj --body second.obj --pairs neighbours "
               "--joint 'one=still,first:rot:25,0,0:0,0,1:-40:90' "
               "--joint 'two=still,second:rot:25,0,0:0,0,1:-90:40' --meters-per-unit 0.001",
               folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
}

/// two.tss with settings of each pair in `name`.
void set(const Folder& folder, const std::string& name, const tss::BakeSettings& first,
         const tss::BakeSettings& second) {
    tss::SceneModel scene = tss::loadScene(folder / "two.tss");
    REQUIRE(scene.pairs.size() == 2);
    scene.pairs[0].settings = first;
    scene.pairs[1].settings = second;
    tss::saveScene(scene, folder / name);
}

bool exists(const std::string& file) {
    return std::filesystem::exists(file);
}

} // namespace

TEST_CASE("a pair that fails at last leaves the others baked, in a file that is named as incomplete") {
    const Folder folder;
    writeTwo(folder);
    // A budget of next to nothing ends before any bound is proven, and samples prove nothing of all pairs.
    set(folder, "in.tss", {{"tolerance", "0.5"}},
        {{"tolerance", "0.5"}, {"search", "sampled"}, {"budget", "1e-9"}});
    const Ran ran = runTss("bake in.tss -o out.tss --json", folder.path());
    INFO(ran.err);
    CHECK(ran.exit == 1);
    CHECK(ran.err.find("in.tss (</two/two>): the budget ended") != std::string::npos);
    CHECK(ran.err.find("go on with\n  tss bake out.incomplete.tss -o out.tss") != std::string::npos);
    const Json result = Json::parse(ran.out);
    CHECK(result["complete"] == false);
    CHECK(result["missing"] == Json::array({"/two/two"}));
    CHECK_FALSE(exists(folder / "out.tss"));
    REQUIRE(exists(folder / "out.incomplete.tss"));
    const tss::SceneModel kept = tss::loadScene(folder / "out.incomplete.tss");
    CHECK(kept.pairs[0].table);
    CHECK_FALSE(kept.pairs[1].table);

    const Ran again = runTss("bake out.incomplete.tss -o out.tss", folder.path());
    CHECK(again.exit == 1); // nothing has changed
    CHECK(again.out.find("1 of 2 baked already") != std::string::npos);

    // With settings of its own the rest is baked, and the file is what one bake would have made.
    tss::SceneModel mended = kept;
    mended.pairs[1].settings = {{"tolerance", "0.5"}};
    tss::saveScene(mended, folder / "mended.tss");
    const Ran on = runTss("bake mended.tss -o out.tss", folder.path());
    INFO(on.err);
    REQUIRE(on.exit == 0);
    CHECK(on.out.find("1 of 2 baked already") != std::string::npos);
    set(folder, "whole.tss", {{"tolerance", "0.5"}}, {{"tolerance", "0.5"}});
    REQUIRE(runTss("bake whole.tss -o whole.tss", folder.path()).exit == 0);
    CHECK(readText(folder / "out.tss") == readText(folder / "whole.tss"));

    CHECK(runTss("bake out.tss -o out.tss", folder.path()).out.find("baked already") == std::string::npos);
    CHECK(runTss("bake mended.tss -o out.tss --again", folder.path()).out.find("baked already") ==
          std::string::npos);
}

TEST_CASE(
    "a bake that is interrupted keeps what is baked, remembers what was asked for, and is gone on with") {
    const Folder folder;
    writeTwo(folder);
    set(folder, "in.tss", {{"tolerance", "0.5"}}, {{"tolerance", "0.002"}}); // the second takes minutes
    // The first one's note is printed as soon as it is done.
    const Ran ran = runTss("info in.tss --quiet", folder.path(),
                           "{ env --default-signal=INT '" TSS_PROGRAM
                           "' bake in.tss -o out.tss --json --max-tests 900000 2>err & bake=$!; "
                           "until grep -q 'first: ' err || ! kill -0 $bake; do sleep 0.05; done; "
                           "kill -INT $bake; wait $bake; echo ended with $? >>err; }");
    REQUIRE(ran.exit == 0);
    const std::string err = readText(folder / "err");
    INFO(err);
    CHECK(err.find("ended with 130") != std::string::npos);
    CHECK(err.find("/two/two") != std::string::npos);
    CHECK_FALSE(exists(folder / "out.tss"));
    REQUIRE(exists(folder / "out.incomplete.tss"));
    const tss::SceneModel kept = tss::loadScene(folder / "out.incomplete.tss");
    CHECK(kept.pairs[0].table);
    CHECK_FALSE(kept.pairs[1].table);
    CHECK(kept.pairs[1].settings.at("max-tests") == "900000");

    const std::string settings = " --json --tolerance 0.5 --max-tests 900000";
    const Ran on = runTss("bake out.incomplete.tss -o out.tss" + settings, folder.path());
    INFO(on.err);
    REQUIRE(on.exit == 0);
    CHECK(on.err.find("1 of 2 baked already") != std::string::npos);
    REQUIRE(runTss("bake two.tss -o whole.tss" + settings, folder.path()).exit == 0);
    CHECK(readText(folder / "out.tss") == readText(folder / "whole.tss"));
}

TEST_CASE("a bake of many pairs whose budget ends keeps what was reached, whatever comes first, and names "
          "the rest") {
    const Folder folder;
    writeTwo(folder);
    tss::TriangleMesh fine = ballMesh({0, 30, 0}, 5, 5);
    fine.triangles.pop_back();
    writeObj(fine, folder / "fine.obj");
    std::string make = "make -o nine.tss --meters-per-unit 0.001 --pairs neighbours --body still.obj "
                       "--body a=fine.obj --joint 'to_a=still,a:rot:25,0,0:0,0,1:-40:90'";
    for (const std::string k : {"b", "c", "d", "e", "f", "g", "h", "i"})
        make += " --body " + k + "=second.obj --joint 'to_" + k + "=still," + k + ":rot:25,0,0:0,0,1:-90:40'";
    REQUIRE(runTss(make, folder.path()).exit == 0);
    tss::SceneModel nine = tss::loadScene(folder / "nine.tss");
    REQUIRE(nine.pairs.size() == 9);
    for (tss::Pair& pair : nine.pairs) pair.settings = {{"tolerance", "0.5"}};
    nine.pairs[0].settings = {{"tolerance", "0.002"}}; // takes minutes
    tss::saveScene(nine, folder / "in.tss");
    const tss::Stopwatch watch;
    const Ran ran = runTss("bake in.tss -o out.tss --json --budget 12", folder.path());
    INFO(ran.err);
    CHECK(watch.seconds() < 60);
    CHECK(ran.exit == 1);
    CHECK(ran.err.find("the budget of 12 s ended first\n") != std::string::npos);
    CHECK(ran.err.find("go on with\n  tss bake out.incomplete.tss -o out.tss --budget 12\n") !=
          std::string::npos);
    const Json result = Json::parse(ran.out);
    CHECK(result["complete"] == false);
    CHECK(result["missing"] == Json::array({"/nine/to_a"}));
    CHECK(result["failures"].empty());
    CHECK_FALSE(exists(folder / "out.tss"));
    const tss::SceneModel kept = tss::loadScene(folder / "out.incomplete.tss");
    CHECK_FALSE(kept.pairs[0].table);
    CHECK(kept.pairs[1].table);
    CHECK(kept.pairs[1].settings.count("budget") == 0);

    // What a budget was enough for is as without one, and it is gone on with.
    const Ran verified = runTss("verify out.incomplete.tss", folder.path());
    CHECK(verified.exit == 0);
    CHECK(verified.out.find("of 1 pair more nothing is known: not baked yet") != std::string::npos);

    // Where nothing comes to its end, more time is asked for.
    const Ran none = runTss("bake in.tss -o none.tss --budget 0.001", folder.path());
    CHECK(none.exit == 1);
    CHECK(none.err.find("expected a longer one, --budget 0.002 or more\n") != std::string::npos);
    const Ran stuck = runTss("bake out.incomplete.tss -o out.tss --budget 0.5", folder.path());
    CHECK(stuck.err.find("go on with\n  tss bake out.incomplete.tss -o out.tss --budget 1\n") !=
          std::string::npos);

    const Ran on = runTss("bake out.incomplete.tss -o out.tss --tolerance 0.5 --budget 1000", folder.path());
    INFO(on.err);
    REQUIRE(on.exit == 0);
    CHECK(on.out.find("8 of 9 baked already") != std::string::npos);
    REQUIRE(runTss("bake nine.tss -o whole.tss --tolerance 0.5", folder.path()).exit == 0);
    CHECK(readText(folder / "out.tss") == readText(folder / "whole.tss"));
}

TEST_CASE("few pairs are all baked to their end: a budget is that of their searches") {
    const Folder folder;
    writeTwo(folder);
    const Ran ran = runTss("bake two.tss -o out.tss --tolerance 0.5 --budget 0.001", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    for (const tss::Pair& pair : tss::loadScene(folder / "out.tss").pairs) {
        CHECK(pair.table);
        CHECK(pair.settings.at("budget") == "0.001");
    }
    CHECK(runTss("bake two.tss -o x.tss --budget -1", folder.path()).exit == 2);
}

TEST_CASE("of one pair that is baked alone, that pair is told") {
    const Folder folder;
    writeTwo(folder);
    const Ran ran = runTss("bake two.tss -o out.tss --tolerance 0.5 --pair /two/two", folder.path());
    REQUIRE(ran.exit == 0);
    CHECK(ran.out.find("/two/two\n") != std::string::npos);
    CHECK(ran.out.find("/two/one\n") == std::string::npos);
}

TEST_CASE("what cannot be baked is refused by validate, and by bake before anything is baked") {
    const Folder folder;
    writeTwo(folder);
    tss::TriangleMesh open = ballMesh({0, 0, 20}, 3, 2);
    open.triangles.resize(open.triangles.size() / 2);
    writeObj(open, folder / "muscle.obj");
    writeObj(ballMesh({0, 0, 0}, 60, 2), folder / "hide.obj");
    REQUIRE(runTss("make -o limb.tss --body still.obj --body first.obj --joint "
                   "'one=still,first:rot:25,0,0:0,0,1:-40:90' --muscle muscle.obj,from=still --skin hide.obj",
                   folder.path())
                .exit == 0);
    const Ran valid = runTss("validate limb.tss --json", folder.path());
    CHECK(valid.exit == 1);
    const Json errors = Json::parse(valid.out)["errors"];
    REQUIRE(errors.size() == 1);
    CHECK(errors[0]["path"] == "/limb/muscle");
    CHECK(errors[0]["line"].get<int>() > 1);
    CHECK(errors[0]["message"].get<std::string>().find("must be closed") != std::string::npos);
    const Ran baked = runTss("bake limb.tss -o out.tss --tolerance 0.5", folder.path());
    CHECK(baked.exit == 1);
    CHECK(baked.err.find("limb.tss (</limb/muscle>): ") != std::string::npos);
    CHECK_FALSE(exists(folder / "out.incomplete.tss")); // not even the joint was baked
    CHECK(runTss("bake limb.tss -o out.tss --tolerance 0.5 --pair /limb/one", folder.path()).exit == 0);

    // An epsilon that reaches across the clearance at rest, of both pairs.
    const Ran wide = runTss("bake two.tss -o out2.tss --epsilon 16mm", folder.path());
    CHECK(wide.exit == 1);
    for (const char* path : {"</two/one>", "</two/two>"}) CHECK(wide.err.find(path) != std::string::npos);
    CHECK(wide.err.find("mm apart at rest, and a table with --epsilon 16 mm") != std::string::npos);
    std::filesystem::create_directory(folder / "place.tss");
    CHECK(runTss("bake two.tss -o place.tss", folder.path()).err.find("it is a folder") != std::string::npos);
}
