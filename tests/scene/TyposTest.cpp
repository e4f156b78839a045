#include "bake/scene/ReadLayer.h"
#include "bake/scene/Schema.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

std::vector<InputError> remarksOn(const std::string& property, const std::string& type = "float",
                                  const std::string& value = "1") {
    Problems problems("");
    const Layer layer =
        parseLayer(R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [{"name": "A",
        "typeName": "Mesh", "properties": {")" +
                       property + R"(": {"typeName": ")" + type + R"(", "default": )" + value + "}}}]}",
                   "");
    remarkTypos(layer, problems);
    return problems.warnings;
}

} // namespace

TEST_CASE("a misspelt property of ours or of UsdPhysics is remarked upon with the name that was meant") {
    for (const auto& [written, meant] : std::vector<std::pair<std::string, std::string>>{
             {"tss:thicknes", "tss:thickness"},
             {"tss:maxcontraction", "tss:maxContraction"},
             {"physics:lowerlimit", "physics:lowerLimit"},
             {"physics:localPso0", "physics:localPos0"},
             {"limit:rotX:physics:hihg", "limit:rotX:physics:high"},
             {"drive:angular:physics:targetPositon", "drive:angular:physics:targetPosition"},
             {"primvars:tss:tehter", "primvars:tss:tether"}}) {
        const auto remarks = remarksOn(written);
        INFO(written);
        REQUIRE(remarks.size() == 1);
        CHECK(remarks[0].message == "no property of this name is read; perhaps " + meant + " was meant");
        CHECK(remarks[0].where.path == "/A." + written);
        CHECK(remarksOn(meant).empty());
    }
    CHECK(remarksOn("tss:somethingElseAltogether").size() == 1);
}

TEST_CASE("faces that are holes are told to be surface") {
    const auto remarks = remarksOn("holeIndices", "int[]", "[1]");
    REQUIRE(remarks.size() == 1);
    CHECK(remarks[0].where.path == "/A.holeIndices");
    CHECK_THAT(remarks[0].message, Catch::Contains("faces that are holes are surface too"));
    CHECK(remarksOn("holeIndices", "int[]", "[]").empty());
}

TEST_CASE("properties of others are no misspelt ones of ours") {
    for (const char* name :
         {"physics:newton:maxForce", "theirs:thickness", "primvars:st", "tss:bake:tolerance",
          "tss:drive:path0", "physics:mass", "drive:linear:physics:stiffness"})
        CHECK(remarksOn(name).empty());
}
