#include "bake/base/AtomicFile.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/WriteUsda.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace tss;

TEST_CASE("a layer is written in USD's own text form") {
    const std::string json = R"({"format": "osgtss", "formatVersion": "1.0", "theirs": 3,
    "metadata": {"defaultPrim": "Jaw", "metersPerUnit": 0.001, "upAxis": "Z", "customLayerData": {"a": 1, "b": [1, 2.5]}},
    "primChildren": [{"typeName": "Xform", "name": "Jaw", "metadata": {"kind": "assembly", "active": true,
        "customData": {"osgName": "the \"jaw\"\n\u0001\\u00", "deep": {"x": ["a", "b"]}}, "mine": null},
      "properties": {
        "points": {"typeName": "point3f[]", "default": [[0, 0.1, -0.0], [1, "inf", 2]], "interpolation": "vertex"},
        "empty": {"typeName": "int[]", "default": []},
        "turn": {"typeName": "float", "default": null, "timeSamples": [[0, 1.5], [24, null]]},
        "order": {"typeName": "token[]", "default": ["a", "b"], "variability": "uniform"},
        "m": {"typeName": "matrix2d", "default": [[1, 2], [3, 4]]},
        "file": {"typeName": "asset", "default": "a.obj", "custom": true},
        "flag": {"typeName": "bool", "default": true},
        "undefined": {"typeName": "double"},
        "odd": {"typeName": "their[]", "default": [1, "x"]},
        "physics:body0": {"targetPaths": ["/Jaw"]},
        "many": {"targetPaths": {"prepend": ["/Jaw", "/Jaw/A"]}}},
      "primChildren": [{"specifier": "over", "name": "A"}, {"specifier": "class", "name": "B"}]}]})";
    CHECK(writeUsda(parseLayer(json, "")) == R"usda(#usda 1.0
(
    customLayerData = {
        int "a" = 1
        double[] "b" = [1, 2.5]
        string "osgtss" = "1.0"
        string "osgtssKeys" = "{\"theirs\": 3}"
    }
    defaultPrim = "Jaw"
    metersPerUnit = 0.001
    upAxis = "Z"
)

def Xform "Jaw" (
    active = true
    customData = {
        dictionary "deep" = {
            string[] "x" = ["a", "b"]
        }
        string "osgName" = "the \"jaw\"\n\x01\\u00"
        string "osgtssJson" = "{\"mine\": null}"
    }
    kind = "assembly"
)
{
    int[] empty = []
    custom asset file = @a.obj@
    bool flag = 1
    matrix2d m = ((1, 2), (3, 4))
    prepend rel many = [</Jaw>, </Jaw/A>]
    custom string odd = "{\"default\": [1, \"x\"], \"typeName\": \"their[]\"}"
    uniform token[] order = ["a", "b"]
    rel physics:body0 = </Jaw>
    point3f[] points = [(0, 0.1, -0.0), (1, inf, 2)] (
        interpolation = "vertex"
    )
    float turn = None
    float turn.timeSamples = {
        0: 1.5,
        24: None,
    }
    double undefined

    over "A"
    {
    }

    class "B"
    {
    }
}
)usda");
}

TEST_CASE("what OpenUSD's parser refuses is written in the form that it takes") {
    const std::string json =
        R"({"format": "osgtss", "formatVersion": "1.0", "metadata": {"comment": "of \"all\""},
    "primChildren": [{"typeName": "Xform", "name": "A", "metadata": {"comment": "of A",
        "apiSchemas": {"prepend": [], "append": ["X", "X"]}},
      "properties": {
        "p": {"typeName": "int", "default": 1, "comment": "of p"},
        "none": {"targetPaths": {"prepend": []}},
        "ops": {"targetPaths": {"append": ["/A.p", "/A.p"], "delete": ["/A/B"]}, "displayName": "N",
                "variability": "uniform"},
        "set": {"targetPaths": {"explicit": ["/A"], "prepend": ["/A/B"]}, "hidden": true}}}]})";
    CHECK(writeUsda(parseLayer(json, "")) == R"usda(#usda 1.0
(
    "of \"all\""
    customLayerData = {
        string "osgtss" = "1.0"
    }
    defaultPrim = "A"
    metersPerUnit = 0.01
    upAxis = "Y"
)

def Xform "A" (
    append apiSchemas = ["X"]
    "of A"
)
{
    rel none
    rel ops (
        displayName = "N"
    )
    append rel ops = </A.p>
    delete rel ops = </A/B>
    int p = 1 (
        "of p"
    )
    rel set = [</A>, </A/B>] (
        hidden = true
    )
}
)usda");
}

TEST_CASE("a whole scene is written as the golden file has it") {
    const std::string golden = std::string(OSGTSS_SOURCE_DIR) + "/tests/scene/everything.usda";
    const std::string usda = writeUsda(toLayer(samples::everything()));
    if (!std::filesystem::exists(golden) || usda != readWholeFile(golden)) {
        const std::string now = std::string(OSGTSS_BINARY_DIR) + "/everything.usda";
        writeFileAtomically(now, usda);
        FAIL("differs from " << golden << ": see " << now << ", and copy it there when the change is meant");
    }
}
