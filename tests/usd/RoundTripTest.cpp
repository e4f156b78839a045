// What writeUsda() writes is read as the same scene again.
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"
#include "tests/scene/RandomLayer.h"
#include "tests/scene/Samples.h"
#include "tests/usd/Stages.h"

#include <filesystem>

using namespace tss;

namespace {

void spell(std::vector<Prim>& prims) {
    for (Prim& prim : prims) {
        if (prim.typeName == "Mesh" && prim.specifier != "over") {
            Property& scheme = prim.properties["subdivisionScheme"];
            scheme.typeName = "token";
            scheme.defaultValue = Value("none");
            scheme.other["variability"] = Value("uniform");
        }
        for (auto& [name, property] : prim.properties)
            if (property.isRelationship()) property.other.erase("variability"); // they all are
        spell(prim.children);
    }
}

/// What a .usda says of a layer even where it is what it is when absent.
std::string spelled(Layer layer) {
    layer.metadata.try_emplace("metersPerUnit", 0.01);
    layer.metadata.try_emplace("upAxis", "Y");
    if (!layer.children.empty()) layer.metadata.try_emplace("defaultPrim", layer.children.front().name);
    spell(layer.children);
    return writeJson(layer);
}

Layer again(const Layer& layer) {
    const UsdStage stage = stageOf(Files{{"root.usda", writeUsda(layer)}});
    CHECK(stage.ours);
    CHECK(stage.notes.empty());
    return stage.layer;
}

} // namespace

TEST_CASE("every scene of the repository is the same after a way through .usda") {
    int scenes = 0;
    for (const char* folder : {"/scenes", "/scenes/extreme"})
        for (const auto& entry :
             std::filesystem::directory_iterator(std::string(OSGTSS_SOURCE_DIR) + folder)) {
            if (entry.path().extension() != ".tss") continue;
            INFO(entry.path().string());
            const Layer layer = readLayer(entry.path().string());
            CHECK(spelled(again(layer)) == spelled(layer));
            ++scenes;
        }
    CHECK(scenes > 10);
}

TEST_CASE("a scene with all that there is, and instances, are the same after a way through .usda") {
    const Layer everything = toLayer(samples::everything());
    CHECK(spelled(again(everything)) == spelled(everything));
    const Layer instances = readLayer(OSGTSS_SOURCE_DIR "/tests/usda/instances.tss");
    CHECK(spelled(again(instances)) == spelled(instances));
}

TEST_CASE("keys, metadata and types that USD has no word for come back") {
    const std::string json = R"({"format": "osgtss", "formatVersion": "1.0", "theirs": 3,
    "metadata": {"defaultPrim": "J", "metersPerUnit": 1, "upAxis": "Z", "mine": [1, null], "customLayerData": {"a": 1}},
    "primChildren": [{"typeName": "Xform", "name": "J", "metadata": {"odd": null, "kind": "assembly"}, "theirs": {"x": 1},
      "properties": {"p": {"typeName": "their[]", "default": [1, "x"], "k": 2},
                     "q": {"typeName": "int", "default": 1, "unknown": {"a": []}}}}]})";
    const Layer layer = parseLayer(json, "");
    CHECK(spelled(again(layer)) == spelled(layer));
}

TEST_CASE("random layers are read from what is written of them, or refused") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        INFO("seed " << seed);
        const Layer layer = RandomLayer(seed).layer();
        const std::string text = writeUsda(layer);
        const std::string problem = refusal([&] { stageOf(Files{{"root.usda", text}}); });
        CHECK(problem.empty());
    }
}
