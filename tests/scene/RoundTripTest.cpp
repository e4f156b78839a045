#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/ValidateScene.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomLayer.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <limits>

using namespace tss;
namespace fs = std::filesystem;

TEST_CASE("random layers come back equal, and are saved to the same bytes") {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        INFO("seed " << seed);
        const Layer layer = RandomLayer(seed).layer();
        const std::string saved = writeJson(layer);
        const Layer back = parseLayer(saved, "random.tss");
        REQUIRE(back == layer);
        REQUIRE(writeJson(back) == saved);
    }
}

TEST_CASE("every scene of the repository is saved to the bytes that it was loaded from, JSON and CBOR") {
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(std::string(OSGTSS_SOURCE_DIR) + "/scenes")) {
        if (entry.path().extension() != ".tss") continue;
        INFO(entry.path());
        ++scenes;
        const std::string file = entry.path().string(), bytes = readWholeFile(file);
        const Layer layer = layerOf(loadScene(file));
        const std::string json = writeJson(layer), cbor = writeCbor(layer);
        CHECK((bytes[0] == '{' ? json : cbor) == bytes);
        CHECK(writeJson(layerOf(readScene(parseLayer(cbor, file), file))) == json);
        CHECK(writeCbor(layerOf(readScene(parseLayer(json, file), file))) == cbor);
    }
    CHECK(scenes > 0);
}

TEST_CASE("every float and double is written so that it reads back the same") {
    std::mt19937_64 random(5);
    for (int round = 0; round < 200000; ++round) {
        const std::uint64_t bits = random();
        const auto number = std::bit_cast<double>(bits);
        const auto single = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        if (std::isfinite(number) &&
            std::bit_cast<std::uint64_t>(std::strtod(numberText(number).c_str(), nullptr)) != bits)
            FAIL(numberText(number));
        std::string text;
        appendFloat(text, single);
        const double read = std::strtod(text.c_str(), nullptr); // read as double, then rounded
        if (std::isfinite(single) && std::bit_cast<std::uint32_t>(float(read)) != std::uint32_t(bits))
            FAIL(text);
    }
}

TEST_CASE("strings that are not UTF-8 can still be read back") {
    for (const char* bad :
         {"\x80", "a\xC3", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\xFF\xFE"}) {
        Layer layer;
        layer.metadata["name"] = Value(bad);
        const std::string saved = writeJson(layer);
        const Layer back = parseLayer(saved, "");
        CHECK(back.metadata.at("name").as<std::string>()->find("\xEF\xBF\xBD") != std::string::npos);
        CHECK(writeJson(back) == saved);
    }
}

TEST_CASE("saving a loaded scene changes nothing in its file") {
    SceneModel scene = samples::brow();
    scene.joints = samples::jaw().joints;
    const std::string folder = std::string(OSGTSS_BINARY_DIR) + "/roundtrip";
    fs::create_directories(folder);
    saveScene(scene, folder + "/a.tss");
    saveScene(loadScene(folder + "/a.tss"), folder + "/b.tss");
    CHECK(readWholeFile(folder + "/a.tss") == readWholeFile(folder + "/b.tss"));
    fs::remove_all(folder);
}

TEST_CASE("unknown things survive the typed view and new tables") {
    const Layer known = toLayer(samples::jaw());
    Layer layer = known;
    layer.other["theirs"] = Value("kept");
    Prim& pair = *findPrim(layer, "/Scene/Jaw");
    pair.metadata["theirs"] = Value(1.0);
    pair.properties["theirs:x"].typeName = "theirs";
    makePrim(layer, "/Scene/Theirs", "TheirType");
    SceneModel scene = readScene(layer, "");
    scene.pairs[0].proof = std::make_shared<NeverCollides>();
    Layer saved = layerOf(scene);
    CHECK(findPrim(saved, "/Scene/Jaw/Table"));
    removePrim(saved, "/Scene/Jaw/Table");
    findPrim(saved, "/Scene/Jaw")->properties.erase("tss:table");
    CHECK(saved == layer);
}

TEST_CASE("a table replaced stays where it was") {
    SceneModel scene = samples::fromFile(samples::jaw());
    scene.pairs[0].proof = std::make_shared<NeverCollides>();
    scene = readScene(layerOf(scene), "");
    Layer layer = layerOf(scene);
    makePrim(layer, "/Scene/Jaw/Later", "Scope");
    makePrim(layer, "/Scene/Jaw/Table/Note", "Scope");
    scene = readScene(layer, "");
    CHECK(writeJson(layerOf(scene)) == writeJson(layer));
    scene.pairs[0].proof = nullptr;
    Table table;
    table.motion = pairMotion(scene, scene.pairs[0]);
    scene.pairs[0].table = std::make_shared<Table>(table);
    const Layer replaced = layerOf(scene);
    const Prim& owner = *findPrim(replaced, "/Scene/Jaw");
    REQUIRE(owner.children.size() == 2);
    CHECK(owner.children[0].typeName == "TssTable");
    CHECK(owner.children[1].name == "Later");
    CHECK(readScene(replaced, "").pairs[0].table->columns.empty());
}

TEST_CASE("a scene that cannot be saved leaves no file and no half of one") {
    const std::string folder = std::string(OSGTSS_BINARY_DIR) + "/unsaved";
    fs::create_directories(folder + "/taken.tss");
    CHECK_THROWS_AS(saveScene(samples::jaw(), folder + "/nowhere/a.tss"), InputError);
    CHECK_THROWS_AS(saveScene(samples::jaw(), folder + "/taken.tss"), InputError);
    SceneModel wrong = samples::jaw();
    wrong.joints[0].dofs[0].axis = Vec3(1, 1, 0).normalized();
    CHECK_THROWS_WITH(saveScene(wrong, folder + "/a.tss"),
                      Catch::StartsWith(folder + "/a.tss (</Scene/Jaw>): expected rotations about"));
    SceneModel unreadable = samples::jaw();
    unreadable.bodies[0].mesh.vertices[1].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(saveScene(unreadable, folder + "/a.tss"), Catch::Contains("expected a finite number, found nan"));
    CHECK(std::distance(fs::directory_iterator(folder), fs::directory_iterator()) == 1);
    fs::remove_all(folder);
}

TEST_CASE("a file that is not there is refused by name") {
    CHECK_THROWS_WITH(loadScene("/nowhere/jaw.tss"), Catch::StartsWith("/nowhere/jaw.tss: "));
    CHECK(validateScene("/nowhere/jaw.tss").size() == 1);
}
