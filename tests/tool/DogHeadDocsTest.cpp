// The dog's head of docs/SKIN.md, by the command that stands there.
#include "bake/scene/SceneFile.h"
#include "tests/SharedMeshes.h"
#include "tests/tool/Shell.h"

namespace {

/// The command of the page that begins so, with its lines joined.
std::string commandOf(const std::string& page, const std::string& begin) {
    auto at = page.find("    " + begin);
    REQUIRE(at != page.npos);
    std::string command;
    for (bool goesOn = true; goesOn; ++at) {
        const auto end = page.find('\n', at);
        command += page.substr(at, end - at);
        goesOn = command.ends_with("\\");
        if (goesOn) command.pop_back();
        at = end;
    }
    return command.substr(command.find("tss ") + 4);
}

void makeHead(const Folder& folder) {
    for (const char* name : {"dog_jaw", "dog_face"})
        std::filesystem::create_directory_symlink(std::filesystem::absolute(sharedMesh(name)),
                                                  folder.path() / name);
    const Ran made =
        runTss(commandOf(readText(OSGTSS_SOURCE_DIR "/docs/SKIN.md"), "tss make -o dog.tss"), folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
}

} // namespace

TEST_CASE("the dog's head of the documentation is made by one command from its meshes") {
    REQUIRE_SHARED_MESHES();
    const Folder folder;
    makeHead(folder);
    const tss::SceneModel scene = tss::loadScene(folder / "dog.tss");
    CHECK(scene.muscles.size() == 11);
    REQUIRE(scene.skins.size() == 1);
    CHECK(scene.skins[0].bones.size() == 2);
    CHECK(scene.skins[0].muscles.size() == 11);
    REQUIRE(scene.joints.size() == 1);
    CHECK(scene.pairs.size() == 1);
    int between = 0;
    for (const tss::MuscleModel& muscle : scene.muscles) {
        CHECK(muscle.bone == 0);
        between += muscle.insertionBone == 1;
    }
    CHECK(between == 6);
}

TEST_CASE("the dog's head of the documentation is baked by one command", "[.long]") {
    REQUIRE_SHARED_MESHES();
    const Folder folder;
    makeHead(folder);
    const Ran baked =
        runTss(commandOf(readText(OSGTSS_SOURCE_DIR "/docs/SKIN.md"), "tss bake dog.tss"), folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    const tss::SceneModel scene = tss::loadScene(folder / "dog_baked.tss");
    CHECK(scene.skins.at(0).table);
    CHECK((scene.pairs.at(0).table || scene.pairs.at(0).proof));
}
