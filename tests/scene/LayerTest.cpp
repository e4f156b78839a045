#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/WriteLayer.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <limits>

using namespace tss;

namespace {

const std::string example = R"({ "format": "osgtss", "formatVersion": "1.0",
  "metadata": {"defaultPrim": "Jaw", "metersPerUnit": 0.001, "upAxis": "Z", "timeCodesPerSecond": 24},
  "primChildren": [
    {"specifier": "def", "typeName": "Xform", "name": "Jaw", "metadata": {"kind": "assembly"}, "primChildren": [
      {"specifier": "def", "typeName": "Mesh", "name": "Mandible",
       "metadata": {"apiSchemas": {"prepend": ["PhysicsRigidBodyAPI", "PhysicsCollisionAPI"]}},
       "properties": {
         "points": {"typeName": "point3f[]", "default": [[0,0,0],[1,0,0],[1,0,-1]]},
         "xformOp:rotateX": {"typeName": "float", "timeSamples": [[0, 0], [24, -30]]},
         "physics:body0": {"targetPaths": ["/Jaw/Skull"]} }}]}]})";

Layer withProperty(const std::string& typeName, const std::string& value) {
    return parseLayer(R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [{"name": "A",
        "properties": {"p": {"typeName": ")" +
                          typeName + R"(", "default": )" + value + "}}}]}",
                      "test.tss");
}

const Value& valueOf(const Layer& layer) {
    return *layer.children.at(0).property("p")->defaultValue;
}

} // namespace

TEST_CASE("a layer holds what the file says, in USD's terms") {
    const Layer layer = parseLayer(example, "jaw.tss");
    const Prim* mandible = findPrim(layer, "/Jaw/Mandible");
    REQUIRE(mandible);
    CHECK(mandible->typeName == "Mesh");
    CHECK(hasApi(*mandible, "PhysicsRigidBodyAPI"));
    CHECK_FALSE(hasApi(*mandible, "PhysicsMassAPI"));
    const Property& rotate = *mandible->property("xformOp:rotateX");
    REQUIRE(rotate.timeSamples.size() == 2);
    CHECK(rotate.timeSamples[1].time == 24);
    CHECK(rotate.timeSamples[1].value == Value(-30.0));
    CHECK(listItems(*mandible->property("physics:body0")->targetPaths) ==
          std::vector<std::string>{"/Jaw/Skull"});
    CHECK(*mandible->property("points")->defaultValue == Value(Numbers{{0, 0, 0, 1, 0, 0, 1, 0, -1}, 3}));
    CHECK(findPrim(layer, "/Jaw/Nothing") == nullptr);
}

TEST_CASE("save, load, save gives the same bytes") {
    const std::string once = writeJson(parseLayer(example, "jaw.tss"));
    CHECK(writeJson(parseLayer(once, "jaw.tss")) == once);
    CHECK(parseLayer(once, "jaw.tss") == parseLayer(example, "jaw.tss"));
}

TEST_CASE("numbers come back with the same bits") {
    for (double number : {0.1, -0.0, 1e300, 5e-324, 9007199254740993.0, 1.0 / 3, 1e21, 123456.0, -1.5e-7}) {
        Layer layer = withProperty("double", "0");
        *layer.children[0].properties["p"].defaultValue = Value(number);
        const Layer back = parseLayer(writeJson(layer), "test.tss");
        CHECK(std::bit_cast<std::uint64_t>(*valueOf(back).as<double>()) ==
              std::bit_cast<std::uint64_t>(number));
    }
}

TEST_CASE("a float slot is rounded to float and written in its shortest form") {
    const Layer layer = withProperty("float", "0.1");
    CHECK(*valueOf(layer).as<double>() == double(0.1f));
    CHECK(writeJson(layer).find(": 0.1}") != std::string::npos);
}

TEST_CASE("not-finite numbers are words, in real slots only") {
    const Layer layer = withProperty("double[]", R"(["inf", 1, "-inf", "nan"])");
    const auto& values = valueOf(layer).as<Numbers>()->values;
    CHECK(values[0] == std::numeric_limits<double>::infinity());
    CHECK(std::isnan(values[3]));
    CHECK(writeJson(parseLayer(writeJson(layer), "")) == writeJson(layer));
    CHECK_THROWS_WITH(withProperty("int", R"("inf")"), Catch::Contains("expected an integer"));
}

TEST_CASE("integers of 64 bits are kept exactly") {
    const Layer layer = withProperty("uint64[]", "[18446744073709551615, 1]");
    CHECK(writeJson(layer).find("[18446744073709551615, 1]") != std::string::npos);
    CHECK(parseLayer(writeJson(layer), "") == layer);
}

TEST_CASE("what osgTSS does not know is kept and written back") {
    const std::string text =
        R"({"format": "osgtss", "formatVersion": "1.7", "mine": [1, "two", {"three": null}],
        "metadata": {"customLayerData": {"a": [[1, 2], [3]]}}, "primChildren": [{"specifier": "over", "name": "A",
        "typeName": "TheirSchema", "theirs": true, "metadata": {"theirs": 1.5}, "properties": {
        "x": {"typeName": "their[]", "default": [[1], "a"], "interpolation": "vertex", "k": -0.0},
        "r": {"targetPaths": {"prepend": ["/A"]}, "custom": true}}}]})";
    const Layer layer = parseLayer(text, "");
    const std::string saved = writeJson(layer);
    CHECK(parseLayer(saved, "") == layer);
    for (const char* kept :
         {"\"mine\"", "\"three\": null", "\"theirs\": true", "\"their[]\"", "-0.0",
          "\"interpolation\": \"vertex\"", "[[1,2], [3]]", "\"custom\": true", "\"1.7\""}) {
        INFO(kept << " in " << saved);
        CHECK(saved.find(kept) != std::string::npos);
    }
}
