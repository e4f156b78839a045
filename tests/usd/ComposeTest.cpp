#include "tests/usd/Stages.h"

using namespace tss;

TEST_CASE("lists that several layers and arcs add to hold what each of them adds") {
    const std::string collider =
        "#usda 1.0\nover \"R\" ( prepend apiSchemas = [\"SemanticsAPI\"]\n append apiSchemas = [\"Last\"] "
        "\n delete apiSchemas = [\"GoneAPI\"] ) {}\n";
    const UsdStage stage = stageOf(Files{
        {"root.usda", "#usda 1.0\n( subLayers = [@one.usda@, @two.usda@, @three.usda@] )\n"
                      "def Xform \"R\" ( prepend apiSchemas = [\"FirstAPI\"]\n prepend references = "
                      "</A> ) { rel x\n prepend rel x = </R/p> }\ndef \"A\" {}\ndef \"B\" { double b = 1 }"
                      "\ndef \"C\" { double c = 1 }\n"},
        {"one.usda", collider},
        {"two.usda", "#usda 1.0\nover \"R\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\", \"GoneAPI\"]"
                     "\n prepend references = </B> ) { prepend rel x = </R/q> }\n"},
        {"three.usda", "#usda 1.0\nover \"R\" ( prepend apiSchemas = [\"ThirdAPI\"]\n prepend references = "
                       "</C> ) { prepend rel x = </R/r> }\n"}});
    const Prim& prim = primAt(stage, "/R");
    CHECK(listItems(prim.metadata.at("apiSchemas")) ==
          std::vector<std::string>{"FirstAPI", "SemanticsAPI", "PhysicsCollisionAPI", "ThirdAPI", "Last"});
    CHECK(prim.property("b"));
    CHECK(prim.property("c"));
    CHECK(listItems(*prim.properties.at("x").targetPaths) ==
          std::vector<std::string>{"/R/p", "/R/q", "/R/r"});
}

TEST_CASE("what is stronger wins: local, inherits, variants, references, payloads, specializes") {
    const std::string arm = R"usda(#usda 1.0
(
    defaultPrim = "Arm"
)
def Xform "Arm" (
    variants = { string size = "small" }
    append variantSets = "size"
)
{
    double d = 4
    double ref = 4
    rel there = </Arm/Hand>
    rel outside = </Other>
    variantSet "size" = {
        "small" { double variant = 1 }
        "large" { double variant = 2
            def Xform "Hand" { double variant = 2 } }
    }
    def Xform "Hand" ( references = @hand.usda@</H> ) { double d = 5 }
}
)usda";
    const UsdStage stage = stageOf(
        Files{{"root.usda", R"usda(#usda 1.0
( subLayers = [@sub.usda@] )
class "Common" { double a = 1
    double b = 1
    double c = 1 }
def "Left" (
    inherits = </Common>
    references = @parts/arm.usda@
    payload = @pay.usda@</P>
    specializes = </Base>
    variants = { string size = "large" }
)
{
    double a = 0
    over "Hand" { double mine = 7 }
}
class "Base" { double a = 9
    double payload = 9
    double base = 9 }
)usda"},
              {"sub.usda", "#usda 1.0\nover \"Left\" { double a = 8\n double sub = 8 }\ndef \"Below\" {}"},
              {"parts/arm.usda", arm},
              {"parts/hand.usda", "#usda 1.0\ndef \"H\" { double d = 6\n double hand = 6 }"},
              {"pay.usda", "#usda 1.0\ndef \"P\" { double ref = 5\n double payload = 5 }"}});
    CHECK(numberAt(stage, "/Left", "a") == 0);
    CHECK(numberAt(stage, "/Left", "sub") == 8);
    CHECK(numberAt(stage, "/Left", "b") == 1);
    CHECK(numberAt(stage, "/Left", "d") == 4);
    CHECK(numberAt(stage, "/Left", "variant") == 2); // the selection of the stronger layer
    CHECK(numberAt(stage, "/Left", "ref") == 4);
    CHECK(numberAt(stage, "/Left", "payload") == 5);
    CHECK(numberAt(stage, "/Left", "base") == 9);
    CHECK(numberAt(stage, "/Left/Hand", "mine") == 7);
    CHECK(numberAt(stage, "/Left/Hand", "d") == 5);
    CHECK(numberAt(stage, "/Left/Hand", "hand") == 6);
    CHECK(numberAt(stage, "/Left/Hand", "variant") == 2);
    CHECK(primAt(stage, "/Left").typeName == "Xform");
    CHECK(primAt(stage, "/Left").specifier == "def");
    CHECK(listItems(*primAt(stage, "/Left").property("there")->targetPaths) ==
          std::vector<std::string>{"/Left/Hand"});
    CHECK(listItems(*primAt(stage, "/Left").property("outside")->targetPaths).empty());
    CHECK(hasNote(stage.notes,
                  "targets out of what is referenced of their file, which name nothing, as in USD: "
                  "/Other at /Arm of parts/arm.usda"));
    CHECK(findPrim(stage.layer, "/Below"));
    CHECK_FALSE(primAt(stage, "/Left").metadata.contains("references"));
}

TEST_CASE("a variant set without a selection is said, and a variant that is not there") {
    const char* set = "variantSet \"v\" = { \"a\" { def \"X\" {} } } }";
    const UsdStage stage = stageOf(std::string("def \"A\" {") + set);
    CHECK(hasNote(stage.notes, "the variant set v of /A has no selection"));
    CHECK_FALSE(findPrim(stage.layer, "/A/X"));
    CHECK(hasNote(stageOf(std::string("def \"A\" ( variants = { string v = \"b\" } ) {") + set).notes,
                  "left out: root.usda: line 2 (</A>): the variant set v has no variant \"b\""));
}

TEST_CASE("an instance has what it references, and nothing of its own below it") {
    const UsdStage stage = stageOf(
        Files{{"root.usda",
               "#usda 1.0\ndef \"I\" ( instanceable = true\n references = @a.usda@</A> ) { def \"Own\" {} }"},
              {"a.usda", "#usda 1.0\ndef \"A\" { def \"X\" {} }"}});
    CHECK(findPrim(stage.layer, "/I/X"));
    CHECK_FALSE(findPrim(stage.layer, "/I/Own"));
}

TEST_CASE("what arcs name and is not there is left out by name, and the rest composed") {
    const std::string head = "#usda 1.0\n", rest = "def \"A\" ( references = [@c.usda@</C>, ";
    const auto leftOut = [&](const std::string& arc, const std::string& layer, const std::string& words) {
        const UsdStage stage = stageOf(Files{{"root.usda", head + rest + arc + "] ) {}"},
                                             {"b.usda", layer},
                                             {"c.usda", head + "def \"C\" { double x = 3 }"}});
        CHECK(numberAt(stage, "/A", "x") == 3);
        CHECK(hasNote(stage.notes, "left out: root.usda: line 2 (</A>): " + words));
    };
    leftOut("@gone.usda@", "", "@gone.usda@: no such file");
    leftOut("@b.usda@", head, "@b.usda@: expected a path too, as b.usda has no defaultPrim");
    leftOut("@b.usda@</B>", head, "@b.usda@</B>: there is no prim /B in b.usda");
    leftOut("@b.usda@</B>", "PXR-USDC", "@b.usda@: is a binary layer of USD");
    CHECK(hasNote(stageOf(Files{{"root.usda", head + "( subLayers = [@gone.usda@] )\ndef \"A\" {}"}}).notes,
                  "left out: root.usda: @gone.usda@: no such file"));
}

TEST_CASE("references into the same layer lead where other references lead, or are left out by name") {
    const std::string lib = "def \"Lib\" { def \"Part\" { double x = 3 } }\n";
    const UsdStage missing = stageOf(lib + "def \"A\" ( references = [</Lib/part>, </Lib/Part>] ) {}");
    CHECK(numberAt(missing, "/A", "x") == 3);
    CHECK(hasNote(missing.notes, "(</A>): /Lib/part: there is no prim /Lib/part in"));
    const UsdStage through =
        stageOf(lib + "def \"B\" ( references = </Lib> ) {}\ndef \"A\" ( references = </B/Part> ) {}");
    CHECK(numberAt(through, "/A", "x") == 3);
    CHECK(hasNote(stageOf("def \"A\" ( references = </A> ) { double x = 1 }").notes, "leads back to itself"));
}

TEST_CASE("an arc that leads back to itself is left out by name, sublayers that do are refused") {
    const auto refused = [](const Files& files) { return refusal([&] { stageOf(files); }); };
    const std::string head = "#usda 1.0\n";
    const auto leftOut = [](const UsdStage& stage) { return hasNote(stage.notes, "leads back to itself"); };
    CHECK(leftOut(stageOf(Files{{"root.usda", head + "def \"A\" ( references = @b.usda@</B> ) {}"},
                                {"b.usda", head + "def \"B\" ( references = @root.usda@</A> ) {}"}})));
    CHECK(leftOut(stageOf("def \"A\" ( inherits = </A> ) {}")));
    CHECK(leftOut(stageOf("def \"A\" { def \"B\" ( inherits = </A> ) {} }")));
    CHECK(refused({{"root.usda", head + "( subLayers = [@b.usda@] )"},
                   {"b.usda", head + "( subLayers = [@b.usda@] )"}})
              .find("leads back to itself") != std::string::npos);
    for (const std::string of : {"", "def \"A\" "})
        CHECK(refused({{"root.usda", head + of + "( relocates = { <a>: <b> } )"}})
                  .find("relocates are not read; expected a stage without them, as usdcat --flatten") !=
              std::string::npos);
}

TEST_CASE("instances as usdcat --flatten writes them have the shapes of their prototype") {
    const std::string body = "( add apiSchemas = [\"PhysicsRigidBodyAPI\"] ) {\n def Xform \"collisions\" ( "
                             "instanceable = true\n add references = [</Flattened_Prototype_1>] ) {} }\n";
    const SceneModel scene =
        robotScene(
            "over \"Flattened_Prototype_1\" { def Cube \"c\" ( add apiSchemas = [\"PhysicsCollisionAPI\"] "
            ") {} }\ndef Xform \"R\" {\n def Xform \"a\" " +
            body + " def Xform \"b\" " + body + "}")
            .scene;
    REQUIRE(scene.bodies.size() == 2);
    for (const Body& one : scene.bodies) CHECK(one.mesh.triangles.size() == 12);
}

TEST_CASE("references that make more of each other than fits are refused") {
    std::string text = "class \"C0\" { double x = 1 }\n";
    for (int k = 1; k < 40; ++k) {
        const std::string below = std::to_string(k - 1);
        text += "class \"C" + std::to_string(k) + "\" { def \"a\" ( inherits = </C" + below +
                "> ) {} def \"b\" ( inherits = </C" + below + "> ) {} }\n";
    }
    CHECK(refusalOf(text + "def \"A\" ( inherits = </C39> ) {}").find("at most 65536 prims") !=
          std::string::npos);
}

TEST_CASE("arcs that lead to more places than fit are refused") {
    std::string text =
        "def \"A\" ( inherits = </C39> ) {}\nclass \"C0\" { double x = 1 }\nclass \"D0\" { double x = 1 }\n";
    for (int k = 1; k < 40; ++k) {
        const std::string at = std::to_string(k), below = std::to_string(k - 1);
        for (const char* name : {"C", "D"})
            text += std::string("class \"") + name + at + "\" ( references = [</C" + below + ">, </D" +
                    below + ">] ) {}\n";
    }
    CHECK(refusalOf(text).find("at most 200000 places") != std::string::npos);
}

TEST_CASE("a layer of other units is said, and not converted") {
    const UsdStage stage = stageOf(
        Files{{"root.usda", "#usda 1.0\n( metersPerUnit = 1 )\ndef \"A\" ( references = @b.usda@</B> ) {}"},
              {"b.usda", "#usda 1.0\n( metersPerUnit = 0.01 )\ndef \"B\" {}"}});
    CHECK(hasNote(stage.notes, "b.usda has metersPerUnit number 0.01"));
}

TEST_CASE("a prim that only the arcs of one above it make can be referenced") {
    const UsdStage stage =
        stageOf("class \"C\" { def \"Child\" { double x = 3 } }\ndef \"A\" ( inherits = </C> ) {}\n"
                "def \"B\" ( references = </A/Child> ) {}");
    CHECK(numberAt(stage, "/B", "x") == 3);
}

TEST_CASE("what a prim specializes may be there by a reference above alone") {
    const UsdStage looks =
        stageOf("def \"Asset\" { def \"Looks\" { def \"Base\" { double y = 5 } } }\n"
                "def \"Shot\" ( references = </Asset> ) { over \"Looks\" { def \"Own\" ( specializes = "
                "</Shot/Looks/Base> ) { double x = 3 } } }");
    CHECK(numberAt(looks, "/Shot/Looks/Own", "x") == 3);
    CHECK(numberAt(looks, "/Shot/Looks/Own", "y") == 5);
    CHECK(findPrim(looks.layer, "/Shot/Looks/Base"));
}

// As OpenUSD 24.08 has it, and each of them otherwise than by merging what arcs of a prim bring below the
// prim.
TEST_CASE("an arc of one kind is stronger than one of the next, whether a prim has it or one above") {
    const std::string parts =
        "def \"R\" { def \"k\" { double x = 1 } }\ndef \"P\" { double x = 2\ndouble y = 2 }\n";
    const UsdStage payload =
        stageOf(parts + "def \"A\" ( references = </R> ) { over \"k\" ( payload = </P> ) {} }");
    CHECK(numberAt(payload, "/A/k", "x") == 1);
    CHECK(numberAt(payload, "/A/k", "y") == 2);
    const UsdStage variant =
        stageOf(parts + "def \"A\" ( variants = { string v = \"a\" } variantSets = \"v\" ) {\n"
                        "over \"k\" ( references = </P> ) {}\n"
                        "variantSet \"v\" = { \"a\" { over \"k\" { double x = 3 } } } }");
    CHECK(numberAt(variant, "/A/k", "x") == 3);
    CHECK(numberAt(variant, "/A/k", "y") == 2);
}

TEST_CASE("what is referenced of a prim below another has what the arcs of that one bring it") {
    const UsdStage stage = stageOf("def \"Lib\" { def \"k\" { double x = 1 } }\n"
                                   "def \"A\" ( references = </Lib> ) { over \"k\" { double y = 2 } }\n"
                                   "def \"B\" ( inherits = </A/k> ) {}");
    CHECK(numberAt(stage, "/B", "x") == 1);
    CHECK(numberAt(stage, "/B", "y") == 2);
}

TEST_CASE("a class is overridden where what inherits it is referenced") {
    const UsdStage stage = stageOf(Files{
        {"root.usda", "#usda 1.0\ndef \"A\" ( references = @a.usda@</M> ) {}\nclass \"C\" { double x = 5 }"},
        {"a.usda", "#usda 1.0\ndef \"M\" { def \"b\" ( inherits = </C> ) {} }\n"
                   "class \"C\" { double x = 1\ndouble q = 1 }"}});
    CHECK(numberAt(stage, "/A/b", "x") == 5);
    CHECK(numberAt(stage, "/A/b", "q") == 1);
}

TEST_CASE("time samples of what is stronger say nothing of the default of what is weaker") {
    const UsdStage stage = stageOf("def \"P\" { double x = 2 }\n"
                                   "def \"A\" ( inherits = </P> ) { double x.timeSamples = { 0: 1, 1: 3 } }");
    CHECK(numberAt(stage, "/A", "x") == 2);
    CHECK(primAt(stage, "/A").property("x")->timeSamples.size() == 2);
}
