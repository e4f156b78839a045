#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
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

/// One thing broken in the good file.
struct Broken {
    const char* prim;  ///< prim path, "" for the layer
    const char* at;    ///< pointer below it that gets another value
    const char* value; ///< JSON; empty: taken away
    const char* found; ///< pointer below the prim that the message names; "=": the same
    const char* says;  ///< part of the message
};

constexpr const char* jaw = "/Scene/Jaw";
constexpr const char* hinge = "/Scene/Hinge";
constexpr const char* ends = "/Scene/Ends";
constexpr const char* mesh = "/Scene/A";
constexpr const char* table = "/Scene/Jaw/Table";
constexpr const char* spheres = "/Scene/Jaw/Table/Spheres0";
constexpr const char* proof = "/Scene/Ends/Table";
constexpr const char* muscle = "/Scene/Frontalis";
constexpr const char* skin = "/Scene/Skin";
constexpr const char* skinTable = "/Scene/Skin/Table";
constexpr const char* layer = "";

const std::vector<Broken> brokenFiles = {
    // the layer
    {layer, "/format", "\"usda\"", "=", "not a scene file of osgTSS"},
    {layer, "/format", "", "=", "expected \"osgtss\""},
    {layer, "/format", "3", "=", "expected a string, found number 3"},
    {layer, "/formatVersion", "", "=", "expected a version"},
    {layer, "/formatVersion", "1.0", "=", "expected a string, found number 1"},
    {layer, "/formatVersion", "\"2.0\"", "=", "expected version 1.x, found 2.0"},
    {layer, "/formatVersion", "\"0.9\"", "=", "expected version 1.x"},
    {layer, "/formatVersion", "\"1\"", "=", "major.minor"},
    {layer, "/formatVersion", "\"1.\"", "=", "major.minor"},
    {layer, "/formatVersion", "\"1.0b\"", "=", "major.minor"},
    {layer, "/formatVersion", "\"1.99999999999999\"", "=", "major.minor"},
    {layer, "/metadata", "[]", "=", "expected an object, found an array of 0 elements"},
    {layer, "/metadata/metersPerUnit", "\"mm\"", "=", "expected a number above 0, found \"mm\""},
    {layer, "/metadata/metersPerUnit", "0", "=", "expected a number above 0"},
    {layer, "/metadata/metersPerUnit", "-1", "=", "found number -1"},
    {layer, "/metadata/upAxis", "\"X\"", "=", "expected \"Y\" or \"Z\""},
    {layer, "/metadata/upAxis", "2", "=", "expected a string"},
    {layer, "/metadata/defaultPrim", "\"Nobody\"", "=", "expected the name of a root prim"},
    {layer, "/metadata/timeCodesPerSecond", "0", "=", "expected a number above 0"},
    {layer, "/metadata/endTimeCode", "-5", "=", "not before startTimeCode"},
    {layer, "/metadata/startTimeCode", "null", "=", "expected a number, found null"},
    {layer, "/primChildren", "{}", "=", "expected an array of prims, found an object"},
    {layer, "/primChildren/0", "\"Scene\"", "=", "expected an object, found \"Scene\""},
    // prims
    {mesh, "/name", "\"\"", "=", "expected a prim name"},
    {mesh, "/name", "", "=", "expected a prim name"},
    {mesh, "/name", "\"a b\"", "=", "found \"a b\""},
    {mesh, "/name", "\"1a\"", "=", "expected a prim name"},
    {mesh, "/name", "7", "=", "expected a string, found number 7"},
    {mesh, "/name", "\"B\"", nullptr, "expected a name that no sibling has"},
    {mesh, "/specifier", "\"define\"", "=", "expected \"def\", \"over\" or \"class\""},
    {mesh, "/typeName", "true", "=", "expected a string, found true"},
    {mesh, "/typeName", "\"Not a type\"", "=", "expected a schema name"},
    {mesh, "/metadata", "3", "=", "expected an object"},
    {mesh, "/metadata/apiSchemas", "\"PhysicsRigidBodyAPI\"", "=",
     "expected an array of names of API schemas"},
    {mesh, "/metadata/apiSchemas/append", "5", "=", "expected an array of names of API schemas"},
    {mesh, "/metadata/apiSchemas/insert", "[]", "=", "expected prepend, append, delete or explicit"},
    {mesh, "/metadata/apiSchemas/prepend", "[\"A\", 1]", "/metadata/apiSchemas/prepend/1",
     "expected a string"},
    {mesh, "/properties", "[1]", "=", "expected an object, found an array of 1 element"},
    {mesh, "/properties/a b", "{}", "=", "expected a property name"},
    {mesh, "/properties/a::b", "{}", "=", "expected a property name"},
    {mesh, "/properties/a", "3", "=", "expected an object, found number 3"},
    {mesh, "/properties/a", "{}", "=", "expected \"typeName\""},
    {mesh, "/properties/a", "{\"typeName\": 3}", "/properties/a/typeName", "expected \"typeName\""},
    {mesh, "/properties/a", "{\"typeName\": \"int\", \"targetPaths\": []}", "=", "found both"},
    {mesh, "/properties/a", "{\"targetPaths\": \"/Scene\"}", "/properties/a/targetPaths",
     "an array of paths"},
    {mesh, "/properties/a", "{\"targetPaths\": [\"Scene\"]}", "/properties/a/targetPaths/0",
     "an absolute path"},
    {mesh, "/properties/a", "{\"targetPaths\": {\"append\": [3]}}", "/properties/a/targetPaths/append/0",
     "a string"},
    {mesh, "/properties/a:0", "{\"typeName\": \"int\"}", "=", "expected a property name"},
    {mesh, "/properties/a", "{\"targetPaths\": [\"/Scene/\"]}", "/properties/a/targetPaths/0",
     "an absolute path"},
    {mesh, "/properties/a", "{\"targetPaths\": [\"/Scene/A>\"]}", "/properties/a/targetPaths/0",
     "an absolute path"},
    {mesh, "/properties/a", "{\"targetPaths\": [\"/Scene.\"]}", "/properties/a/targetPaths/0",
     "an absolute path"},
    // values and their types
    {mesh, "/properties/a", "{\"typeName\": \"uint64\", \"default\": 18446744073709551616}",
     "/properties/a/default", "expected an integer from 0"},
    {mesh, "/properties/a", "{\"typeName\": \"int64\", \"default\": 9223372036854775808.0}",
     "/properties/a/default", "expected an integer"},
    {mesh, "/properties/a", "{\"typeName\": \"asset[]\", \"default\": [\"a\", \"b@c\"]}",
     "/properties/a/default/1", "without @"},
    {mesh, "/properties/a", "{\"typeName\": \"int\", \"default\": 1.7}", "/properties/a/default",
     "expected an integer"},
    {mesh, "/properties/a", "{\"typeName\": \"int\", \"default\": 2147483648}", "/properties/a/default",
     "an integer from -2147483648 to 2147483647"},
    {mesh, "/properties/a", "{\"typeName\": \"uint\", \"default\": -1}", "/properties/a/default",
     "an integer from 0"},
    {mesh, "/properties/a", "{\"typeName\": \"uchar\", \"default\": 256}", "/properties/a/default", "to 255"},
    {mesh, "/properties/a", "{\"typeName\": \"int64\", \"default\": 18446744073709551615}",
     "/properties/a/default", "expected an integer"},
    {mesh, "/properties/a", "{\"typeName\": \"bool\", \"default\": 1}", "/properties/a/default",
     "expected true or false, found number 1"},
    {mesh, "/properties/a", "{\"typeName\": \"bool[]\", \"default\": [true, 0]}", "/properties/a/default/1",
     "expected true or false"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"default\": 1e39}", "/properties/a/default",
     "expected a number of at most"},
    {mesh, "/properties/a", "{\"typeName\": \"half\", \"default\": 70000}", "/properties/a/default",
     "at most 65504"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"default\": \"1\"}", "/properties/a/default",
     "expected a number, found \"1\""},
    {mesh, "/properties/a", "{\"typeName\": \"double\", \"default\": \"infinity\"}", "/properties/a/default",
     "expected a number, found \"infinity\""},
    {mesh, "/properties/a", "{\"typeName\": \"int\", \"default\": \"inf\"}", "/properties/a/default",
     "expected an integer"},
    {mesh, "/properties/a", "{\"typeName\": \"token\", \"default\": 3}", "/properties/a/default",
     "expected a string, found number 3"},
    {mesh, "/properties/a", "{\"typeName\": \"token[]\", \"default\": \"x\"}", "/properties/a/default",
     "expected an array (token[])"},
    {mesh, "/properties/a", "{\"typeName\": \"token[]\", \"default\": [\"x\", null]}",
     "/properties/a/default/1", "expected a string, found null"},
    {mesh, "/properties/a", "{\"typeName\": \"double[]\", \"default\": 3}", "/properties/a/default",
     "expected an array (double[])"},
    {mesh, "/properties/a", "{\"typeName\": \"double[]\", \"default\": [1, [2]]}", "/properties/a/default/1",
     "expected a number"},
    {mesh, "/properties/a", "{\"typeName\": \"double[]\", \"default\": [[1], [2]]}",
     "/properties/a/default/0", "expected a number"},
    {mesh, "/properties/a", "{\"typeName\": \"quatf\", \"default\": [1, 0, 0]}", "/properties/a/default",
     "expected an array of 4 numbers (quatf)"},
    {mesh, "/properties/a", "{\"typeName\": \"float3\", \"default\": [1, 0, \"x\"]}",
     "/properties/a/default/2", "expected a number"},
    {mesh, "/properties/a", "{\"typeName\": \"float3\", \"default\": [1, 0, 1e60]}",
     "/properties/a/default/2", "at most"},
    {mesh, "/properties/a", "{\"typeName\": \"matrix4d\", \"default\": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}",
     "/properties/a/default", "expected 4 rows"},
    {mesh, "/properties/a", "{\"typeName\": \"matrix4d[]\", \"default\": [[[1,0],[0,1]]]}",
     "/properties/a/default/0/0", "array of 4 numbers"},
    {mesh, "/properties/a", "{\"typeName\": \"int[]\", \"default\": [1, 2.5]}", "/properties/a/default/1",
     "expected an integer"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"timeSamples\": 3}", "/properties/a/timeSamples",
     "expected an array of [time, value] pairs"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"timeSamples\": [[0]]}",
     "/properties/a/timeSamples/0", "expected a [time, value] pair"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"timeSamples\": [[\"0\", 1]]}",
     "/properties/a/timeSamples/0", "expected a [time, value] pair"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"timeSamples\": [[1, 1], [1, 2]]}",
     "/properties/a/timeSamples/1/0", "expected a time after 1"},
    {mesh, "/properties/a", "{\"typeName\": \"float\", \"timeSamples\": [[1, 1], [2, \"x\"]]}",
     "/properties/a/timeSamples/1/1", "expected a number"},
    // meshes
    {mesh, "/properties/points/typeName", "\"point3d[]\"", "=",
     "expected type point3f[], found \"point3d[]\""},
    {mesh, "/properties/points/default/2", "[1, 2]", "=", "expected an array of 3 numbers (point3f[])"},
    {mesh, "/properties/points/default/2/1", "\"nan\"", "=", "expected a finite number, found nan"},
    {mesh, "/properties/points/default/2/1", "1e39", "=", "at most"},
    {mesh, "/properties/points", "{\"targetPaths\": []}", "=", "found a relationship"},
    {mesh, "/properties/faceVertexCounts/default/1", "2", "=", "expected a number from 3"},
    {mesh, "/properties/faceVertexCounts/default/1", "4", "/properties/faceVertexIndices/default",
     "expected 13 indices"},
    {mesh, "/properties/faceVertexIndices/default/5", "4", "/properties/faceVertexIndices/default",
     "expected indices below 4"},
    {mesh, "/properties/faceVertexIndices/default/5", "-1", "=", "expected a number from 0"},
    {mesh, "/properties/faceVertexIndices", "", "", "expected 12 indices"},
    {mesh, "/properties/orientation", "{\"typeName\": \"token\", \"default\": \"left\"}",
     "/properties/orientation/default", "expected one of rightHanded, leftHanded"},
    {mesh, "/properties/xformOpOrder", "{\"typeName\": \"token[]\", \"default\": [\"xformOp:translate\"]}",
     "/properties/xformOpOrder/default", "expected the operation \"xformOp:translate\""},
    {mesh, "/properties/xformOpOrder", "{\"typeName\": \"token[]\", \"default\": [\"extent\"]}",
     "/properties/xformOpOrder/default", "expected translate, orient, rotate..., scale or transform"},
    {mesh, "/primChildren",
     "[{\"name\": \"In\", \"typeName\": \"Mesh\", \"metadata\": {\"apiSchemas\": {\"prepend\": "
     "[\"PhysicsRigidBodyAPI\"]}}}]",
     "/primChildren/0", "expected rigid bodies side by side"},
    // joints
    {jaw, "/properties/physics:body0", "{\"targetPaths\": [\"/Scene/Nobody\"]}",
     "/properties/physics:body0/targetPaths", "expected the path of a prim"},
    {jaw, "/properties/physics:body0", "{\"targetPaths\": [\"/Scene/Frontalis\"]}",
     "/properties/physics:body0/targetPaths", "expected the path of a Mesh or an Xform"},
    {jaw, "/properties/physics:body0", "{\"targetPaths\": [\"/Scene/B\"]}",
     "/properties/physics:body1/targetPaths", "expected another body than physics:body0"},
    {jaw, "/properties/physics:body0", "{\"targetPaths\": [\"/Scene/A\", \"/Scene/B\"]}",
     "/properties/physics:body0/targetPaths", "expected one path, found 2"},
    {jaw, "/properties/physics:body0", "{\"typeName\": \"string\", \"default\": \"/Scene/A\"}", "=",
     "expected a relationship"},
    {jaw, "/properties/physics:body0", "", "", "a pair needs both"},
    {jaw, "/properties/physics:localRot0", "{\"typeName\": \"quatf\", \"default\": [2, 0, 0, 0]}",
     "/properties/physics:localRot0/default",
     "expected a quaternion [w, x, y, z] of length 1, found one of length 2"},
    {jaw, "/properties/limit:rotY:physics:low", "{\"typeName\": \"float\", \"default\": \"abc\"}",
     "/properties/limit:rotY:physics:low/default", "expected a number, found \"abc\""},
    {jaw, "/properties/limit:rotY:physics:low/default", "\"nan\"", "=", "expected a number, found nan"},
    {jaw, "/properties/limit:rotY:physics:low", "", "",
     "expected a lower and an upper limit for each DOF of a pair, found none for open"},
    {jaw, "/properties/limit:rotY:physics:low/default", "90", "/properties/tss:dofOrder/default",
     "\"rotY\", which is locked"},
    {jaw, "/properties/tss:dofOrder/default", "[\"rotY\", \"transQ\"]", "=", "found \"transQ\""},
    {jaw, "/properties/tss:dofOrder/default", "[\"rotY\", \"rotY\"]", "=", "expected each DOF once"},
    {jaw, "/properties/tss:dofOrder/default", "[\"rotY\", \"rotX\"]", "=", "\"rotX\", which is locked"},
    {jaw, "/properties/tss:dofOrder/default", "[\"rotY\"]", "=", "\"transY\" is missing"},
    {jaw, "/properties/tss:dofOrder/default", "[\"rotY\", \"transY\", \"path0\"]", nullptr, "expected"},
    {jaw, "/properties/tss:dofScale/default", "[1]", "=", "expected 2 numbers, found 1"},
    {jaw, "/properties/tss:dofScale/default", "[1, 0]", "=", "expected scales that are not 0"},
    {jaw, "/properties/tss:dofScale/default", "[2, 1]", "=", "expected a scale of 1 for \"rotY\""},
    {jaw, "/properties/tss:dofScale/default/1", "\"inf\"", "=", "expected a finite number"},
    {jaw, "/properties/tss:dofNames/default", "[\"open\"]", nullptr, "expected 2 names"},
    {jaw, "/properties/tss:rest", "{\"typeName\": \"double[]\", \"default\": [1, 2, 3]}",
     "/properties/tss:rest/default", "expected 2 numbers, found 3"},
    {jaw, "/properties/tss:limitPlanes", "{\"typeName\": \"double[]\", \"default\": [1, 2]}",
     "/properties/tss:limitPlanes/default", "expected rows of 3 numbers"},
    {hinge, "/properties/physics:upperLimit/default", "-1", "=",
     "expected at least the lower limit 0, found -1"},
    {hinge, "/properties/physics:axis", "{\"typeName\": \"token\", \"default\": \"W\"}",
     "/properties/physics:axis/default", "expected one of X, Y, Z"},
    {hinge, "/properties/physics:jointEnabled", "{\"typeName\": \"bool\", \"default\": \"no\"}",
     "/properties/physics:jointEnabled/default", "expected true or false"},
    {hinge, "/properties/drive:angular:physics:targetPosition/timeSamples/1/1", "null", "=",
     "expected a finite number, found null"},
    {hinge, "/properties/drive:angular:physics:targetPosition/timeSamples/1/0", "0", "=",
     "expected a time after 0"},
    // pairs
    {ends, "/properties/tss:bodies", "", "", "names two bodies"},
    {ends, "/properties/tss:bodies/targetPaths", "[\"/Scene/A\"]", "", "names two bodies"},
    {ends, "/properties/tss:bodies/targetPaths", "[\"/Scene/A\", \"/Scene/A\"]", "", "names two bodies"},
    {ends, "/properties/tss:bodies/targetPaths", "[\"/Scene/A\", \"/Scene/Skin\"]", "=", "found none"},
    {ends, "/properties/tss:bodies/targetPaths", "[\"/Scene/A\", \"/Scene/Nobody\"]", "=",
     "expected the path of a prim"},
    {ends, "/properties/tss:bake:epsilon", "{\"typeName\": \"double\", \"default\": 1}",
     "/properties/tss:bake:epsilon/typeName", "expected type string"},
    {jaw, "/properties/tss:table/targetPaths", "[\"/Scene/A\"]", "=",
     "expected the path of a TssTable or a TssNeverCollides"},
    {jaw, "/properties/tss:table/targetPaths", "[\"/Scene/Gone\"]", "=", "expected the path of a prim"},
    // tables
    {table, "/properties/tss:rowOffsets/default", "[0, 1]", "=", "expected 3 offsets"},
    {table, "/properties/tss:rowOffsets/default", "[1, 1, 2]", "=", "expected 0 first"},
    {table, "/properties/tss:rowOffsets/default", "[0, 2, 1]", "=",
     "expected offsets that never fall, found 1 after 2 at index 2"},
    {table, "/properties/tss:rowOffsets/default", "[0, 1, 3]", "=", "expected 2 last"},
    {table, "/properties/tss:rowOffsets/default", "[0, -1, 2]", "/properties/tss:rowOffsets/default/1",
     "expected a number from 0"},
    {table, "/properties/tss:rowOffsets", "", "", "tss:rowOffsets: expected 3 offsets"},
    {table, "/properties/tss:columns/default", "[0, 1]", "=", "expected indices below 1"},
    {table, "/properties/tss:columns/default", "[0, 0.5]", "/properties/tss:columns/default/1",
     "expected an integer"},
    {table, "/properties/tss:restGaps/default", "[0]", "=", "expected 2 numbers, found 1"},
    {table, "/properties/tss:restCuts0/default", "[2]", "=", "expected 2 numbers, one a part"},
    {table, "/properties/tss:restCuts0/default", "[2, 0]", "=", "expected 1 or more, found 0 at index 1"},
    {table, "/properties/tss:restTriangles0/default", "[0, 4]", "=", "expected indices below 4"},
    {table, "/properties/tss:restTriangles0/default", "[2, 0]", "=", "expected parts in rising order"},
    {table, "/properties/tss:restTriangles0/default", "[2, 2]", "=", "expected parts in rising order"},
    {table, "/properties/tss:restTriangles0", "", "/properties/tss:restCuts0/default",
     "expected 0 numbers, one a part"},
    {table, "/properties/tss:dofs/default", "[\"open\"]", "=", "the table is stale"},
    {table, "/properties/tss:lower/default", "[1]", "=", "expected 2 numbers"},
    {table, "/properties/tss:lower", "", "", "expected tss:lower and tss:upper"},
    {table, "/properties/tss:lower/default/0", "100", "/properties/tss:upper/default",
     "not below the lower ones"},
    {table, "/properties/tss:epsilon", "{\"typeName\": \"double\", \"default\": -1}",
     "/properties/tss:epsilon/default", "at least 0"},
    {table, "/properties/tss:boundMiss", "{\"typeName\": \"double\", \"default\": \"nan\"}",
     "/properties/tss:boundMiss/default", "expected a finite number"},
    {table, "/properties/tss:certified", "{\"typeName\": \"int\", \"default\": 1}",
     "/properties/tss:certified/typeName", "expected type bool"},
    {table, "/properties/tss:spheres0/targetPaths", "[\"/Scene/A\"]", "=", "expected the path of Points"},
    {table, "/properties/tss:spheres0", "", "", "expected the relationship tss:spheres0"},
    {table, "/properties/tss:generatedSpheres/default", "[1]", "=", "expected 2 numbers"},
    {spheres, "/properties/widths/default", "[1]", "=", "expected 2 numbers, found 1"},
    {spheres, "/properties/widths/default", "[1, -1]", "/properties/widths/default/1", "at least 0"},
    {spheres, "/properties/widths", "", "", "expected the attribute widths"},
    {proof, "/properties/tss:clearance", "{\"typeName\": \"double\", \"default\": -1}",
     "/properties/tss:clearance/default", "at least 0"},
    // muscles and skins
    {muscle, "/properties/tss:surface", "", "", "expected a relationship tss:surface"},
    {muscle, "/properties/tss:surface/targetPaths", "[\"/Scene/Ends\"]", "=", "expected the path of a Mesh"},
    {muscle, "/properties/tss:origin", "", "", "expected the attribute tss:origin"},
    {muscle, "/properties/tss:insertion/default", "[0, 0, 0]", "=", "expected another point than tss:origin"},
    {muscle, "/properties/tss:form/default", "\"ball\"", "=", "expected one of tube, sheet"},
    {muscle, "/properties/tss:anchor", "{\"typeName\": \"double\", \"default\": 1.5}",
     "/properties/tss:anchor/default", "from 0 to 1"},
    {muscle, "/properties/tss:maxContraction/default", "-0.1", "=", "from 0 to 1"},
    {muscle, "/properties/tss:activationRange", "{\"typeName\": \"double2\", \"default\": [1, 0]}",
     "/properties/tss:activationRange/default", "expected the lower activation first"},
    {muscle, "/properties/tss:activation/timeSamples/0/1", "\"inf\"", "=", "expected a finite number"},
    {muscle, "/properties/tss:bone/targetPaths", "[\"/Scene/Gone\"]", "=", "expected the path of a prim"},
    {skin, "/typeName", "\"Xform\"", "", "expected TssSkinAPI on a Mesh"},
    {skin, "/properties/tss:muscles/targetPaths", "[\"/Scene/A\"]", "=", "expected the path of a TssMuscle"},
    {skin, "/properties/tss:thickness/default", "-1", "=", "at least 0"},
    {skin, "/properties/tss:bendCompliance", "{\"typeName\": \"double\", \"default\": \"inf\"}",
     "/properties/tss:bendCompliance/default", "at least 0"},
    {skin, "/properties/primvars:tss:tether/default", "[0, 1]", "=", "expected 4 numbers, found 2"},
    {skin, "/properties/primvars:tss:tether/default/2", "2", "=", "from 0 to 1"},
    {skin, "/properties/tss:table/targetPaths", "[\"/Scene/Ends/Table\"]", "=",
     "expected the path of a TssTable"},
    {skinTable, "/properties/tss:skinVertices/default", "[0, 4]", "=", "expected indices below 4, found 4"},
    {skinTable, "/properties/tss:skinVertices/default", "[0]", "=", "expected 2 indices, one a sphere"},
    {skinTable, "/properties/tss:muscleOf/default", "[1]", "=", "expected indices below 1, found 1"},
};

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
    for (const Broken& broken : brokenFiles) {
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
    file[Json::json_pointer(pointerOf(hinge) + "/properties/physics:upperLimit/default")] = "abc";
    CHECK_THROWS_WITH(parseLayer(file.dump(), "jaw.tss"),
                      "jaw.tss: " + pointerOf(hinge) +
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
    set(layer, "/metadata/upAxis", "X");
    set(mesh, "/properties/points/default/2/1", "a");
    set(jaw, "/properties/limit:rotY:physics:low/default", "b");
    set(skin, "/properties/tss:thickness/default", -1);
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
