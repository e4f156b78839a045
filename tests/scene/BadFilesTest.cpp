#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/ValidateScene.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/BrokenFiles.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>

using namespace tss;
using Json = nlohmann::json;

namespace {

const Json& goodFile() {
    static const Json file = Json::parse(writeJson(layerOf(samples::everything())));
    return file;
}

/// JSON pointer of a prim; "" for the layer.
std::string pointerOf(const std::string& path) {
    std::string pointer;
    const Json* level = &goodFile();
    std::size_t at = 0;
    while (at < path.size()) {
        const auto end = std::min(path.find('/', at + 1), path.size());
        const std::string name = path.substr(at + 1, end - at - 1);
        const Json& children = (*level)["primChildren"];
        std::size_t i = 0;
        while (children.at(i)["name"] != name) ++i;
        pointer += "/primChildren/" + std::to_string(i);
        level = &children[i];
        at = end;
    }
    return pointer;
}

Json breakFile(const Broken& broken) {
    Json file = goodFile();
    const Json::json_pointer at(pointerOf(broken.prim) + broken.at);
    if (*broken.value)
        file[at] = Json::parse(broken.value);
    else
        file[at.parent_pointer()].erase(at.back());
    return file;
}

} // namespace

TEST_CASE("the scene that the bad ones are made from is good") {
    const SceneModel scene = readScene(parseLayer(goodFile().dump(), "good.tss"), "good.tss");
    CHECK(scene.pairs.size() == 2);
    CHECK(scene.skins.size() == 1);
    CHECK(writeJson(layerOf(scene)) == writeJson(parseLayer(goodFile().dump(), "")));
}

TEST_CASE("each broken file is refused with file, pointer and expectation") {
    for (const Broken& broken : brokenFiles()) {
        INFO(broken.prim << broken.at << " = " << broken.value);
        try {
            readScene(parseLayer(breakFile(broken).dump(), "bad.tss"), "bad.tss");
            FAIL_CHECK("was accepted");
        } catch (const InputError& error) {
            CHECK(error.where.file == "bad.tss");
            CHECK_THAT(error.message, Catch::Contains(broken.says));
            CHECK_THAT(error.message, Catch::Contains("expected"));
            if (broken.found)
                CHECK(error.where.pointer ==
                      pointerOf(broken.prim) + (std::string(broken.found) == "=" ? broken.at : broken.found));
        }
    }
}

TEST_CASE("a message names the property by its path too") {
    Json file = goodFile();
    file[Json::json_pointer(pointerOf(prims::hinge) + "/properties/physics:upperLimit/default")] = "abc";
    CHECK_THROWS_WITH(parseLayer(file.dump(), "jaw.tss"),
                      "jaw.tss: " + pointerOf(prims::hinge) +
                          "/properties/physics:upperLimit/default (</Scene/Hinge.physics:upperLimit>): "
                          "expected a number, found \"abc\"");
}

TEST_CASE("text that is not strictly JSON is refused") {
    const auto nested = [](int levels) { return std::string(levels, '[') + std::string(levels, ']'); };
    const std::pair<std::string, std::string> texts[] = {
        {"", "expected JSON"},
        {"{", "expected JSON: a key in double quotes, found the end of the file at line 1, column 2"},
        {"{}{}", "expected JSON"},
        {"{} x", "expected JSON"},
        {"{\"a\": 1,}", "line 1, column"},
        {"{\"a\": 1 // one\n}", "expected JSON"},
        {"/* a */ {}", "expected JSON"},
        {"{\"a\": NaN}", "expected JSON"},
        {"{\"a\": 1e999}", "1e999"},
        {"{\"a\": 01}", "expected JSON"},
        {"{\"a\": \"\xff\"}", "expected JSON"},
        {"{\"a\": \"\\ud800\"}", "expected JSON"},
        {"{'a': 1}", "expected JSON"},
        {"{a: 1}", "expected JSON"},
        {"{\"a\" 1}", ": after a key"},
        {"{\"a\": }", "expected JSON: a value, found '}'"},
        {"{\"a\": tru}", "expected JSON"},
        {"{\"a\": +1}", "expected JSON"},
        {"{\"a\": -}", "expected JSON: a digit"},
        {"{\"a\": 1.}", "expected JSON: a digit"},
        {"{\"a\": .5}", "expected JSON"},
        {"{\"a\": 1e+}", "expected JSON: a digit"},
        {"{\"a\": 0x10}", "expected JSON"},
        {"{\"a\": [1,]}", "expected JSON: a value, found ']'"},
        {"{\"a\": [1 2]}", ", or ] after an element"},
        {"{\"a\": \"\t\"}", "expected JSON"},
        {"{\"a\": \"\\x41\"}", "after \\"},
        {"{\"a\": \"\\u12g4\"}", "four hexadecimal digits"},
        {"{\"a\": \"\\udc00\"}", "surrogate pair"},
        {"{\"a\": \"\\ud800\\u0041\"}", "second half of a surrogate pair"},
        {"{\"a\": \"b", "the end of the file"},
        {"\xEF\xBB\xBF{}", "byte order mark"},
        {std::string("{}\0{}", 5), "found a NUL byte at line 1, column 3"},
        {"{\"a\": 1, \"a\": 2}", "expected each key once in an object, found \"a\" again"},
        {"{\"b\": {\"a\": 1, \"a\": 2}}", "/b/a"},
        {nested(65), "at most 64 levels"},
        {nested(100000), "at most 64 levels"},
        {"[]", "expected an object"},
        {"3", "expected an object"},
    };
    for (const auto& [text, says] : texts) {
        INFO(text.substr(0, 80));
        CHECK_THROWS_WITH(parseLayer(text, "bad.tss"),
                          Catch::StartsWith("bad.tss: ") && Catch::Contains(says));
    }
    CHECK_THROWS_WITH(parseLayer(nested(64), ""),
                      Catch::Contains("expected an object")); // deep enough to be read
}

TEST_CASE("validation finds everything that is wrong, not only the first thing") {
    Json file = goodFile();
    const auto set = [&](const char* prim, const std::string& at, const Json& value) {
        file[Json::json_pointer(pointerOf(prim) + at)] = value;
    };
    set(prims::layer, "/metadata/upAxis", "X");
    set(prims::mesh, "/properties/points/default/2/1", "a");
    set(prims::jaw, "/properties/limit:rotY:physics:low/default", "b");
    set(prims::skin, "/properties/tss:thickness/default", -1);
    const std::string name = std::string(OSGTSS_BINARY_DIR) + "/wrong.tss";
    writeFileAtomically(name, file.dump());
    const auto errors = validateScene(name);
    std::filesystem::remove(name);
    CHECK(errors.size() == 4);
    for (const InputError& error : errors) CHECK(error.where.file == name);
}

TEST_CASE("composition that is not done is remarked upon") {
    Json file = Json::parse(writeJson(toLayer(samples::jaw())));
    file["metadata"]["subLayers"] = Json::array({"a.usda"});
    file["primChildren"][0]["metadata"]["specializes"] = Json::array({"/Scene/A"});
    const std::string name = std::string(OSGTSS_BINARY_DIR) + "/composed.tss";
    writeFileAtomically(name, file.dump());
    std::vector<LocatedError> warnings;
    CHECK(validateScene(name, &warnings).empty());
    std::filesystem::remove(name);
    REQUIRE(warnings.size() == 2);
    CHECK_THAT(warnings[0].message, Catch::StartsWith("subLayers is kept"));
    CHECK(warnings[1].where.pointer == "/primChildren/0/metadata/specializes");
}

TEST_CASE("a newer minor version is read with a warning, and kept") {
    Json file = Json::parse(writeJson(toLayer(samples::jaw())));
    file["formatVersion"] = "1.9";
    const std::string name = std::string(OSGTSS_BINARY_DIR) + "/newer.tss";
    writeFileAtomically(name, file.dump());
    std::vector<LocatedError> warnings;
    CHECK(validateScene(name, &warnings).empty());
    std::filesystem::remove(name);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0].message, Catch::Contains("1.9"));
    CHECK(parseLayer(file.dump(), "").formatVersion == "1.9");
}
