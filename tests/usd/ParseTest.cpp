#include "tests/usd/Stages.h"

using namespace tss;

TEST_CASE("values of a .usda are those of the scene file") {
    const UsdStage stage = stageOf(R"usda((
    "all of it"
    defaultPrim = "A"
    doc = """two
lines"""
    customLayerData = { int a = 1; string[] b = ["x", 'y']; dictionary c = { bool d = true } }
)
# a comment
def Xform "A" (
    prepend apiSchemas = ["PhysicsRigidBodyAPI"]
    kind = "component"
    active = true
)
{
    // another
    bool on = 1 /* and one more */
    double3 t = (1, -2.5, 3e-2)
    point3f[] points = [(0, 0.1, -0), (1, inf, -inf),]
    matrix4d m = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (4, 5, 6, 1) )
    token[] empty = []
    custom uniform token name = "x\n\x41\"" ( displayName = "N" )
    float turn.timeSamples = { 24: None, 0: 1.5, }
    uint64 large = 18446744073709551615
    asset file = @a b.png@
    asset[] icons = [@@@a@2x.png@@@, @@@at@@@@, 'b@2x.png']
    rel one = <B>
    prepend rel many = [</A/B>, <../C.p>]
    rel none = None
    float in.connect = <B.out>
    string héé = "é"
    reorder nameChildren = ["B"]

    def "B" { float out }
}
over "C" {}
)usda");
    const Prim& a = primAt(stage, "/A");
    CHECK(*stage.layer.metadata.at("comment").as<std::string>() == "all of it");
    CHECK(*stage.layer.metadata.at("documentation").as<std::string>() == "two\nlines");
    CHECK(hasApi(a, "PhysicsRigidBodyAPI"));
    CHECK(*a.property("on")->defaultValue == Value(true));
    CHECK(*a.property("t")->defaultValue == Value(Numbers{{1, -2.5, 0.03}, 0}));
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(*a.property("points")->defaultValue ==
          Value(Numbers{{0, double(0.1f), -0.0, 1, infinity, -infinity}, 3}));
    CHECK(a.property("m")->defaultValue->as<Numbers>()->width == 4);
    CHECK(*a.property("empty")->defaultValue == Value(Value::Array()));
    CHECK(*a.property("name")->defaultValue == Value("x\nA\""));
    CHECK(*a.property("icons")->defaultValue ==
          Value(Value::Array{Value("a@2x.png"), Value("at@"), Value("b@2x.png")}));
    CHECK(a.property("name")->other.at("variability") == Value("uniform"));
    CHECK(a.property("name")->other.at("custom") == Value(true));
    REQUIRE(a.property("turn")->timeSamples.size() == 2);
    CHECK(a.property("turn")->timeSamples[0].value == Value(1.5));
    CHECK(a.property("turn")->timeSamples[1].value.isNull());
    CHECK(*a.property("large")->defaultValue == Value(std::uint64_t(18446744073709551615u)));
    CHECK(listItems(*a.property("one")->targetPaths) == std::vector<std::string>{"/A/B"});
    CHECK(listItems(*a.property("many")->targetPaths) == std::vector<std::string>{"/A/B", "/C.p"});
    CHECK(listItems(*a.property("none")->targetPaths).empty());
    CHECK(a.child("B")->property("out")->typeName == "float");
    CHECK(primAt(stage, "/C").specifier == "over");
    CHECK_FALSE(stage.ours);
}

TEST_CASE("what is wrong with a .usda is said with its line and prim") {
    CHECK(refusalOf("def Xform \"A\"\n{\n    float x = \"a\"\n}\n") ==
          "root.usda: line 4 (</A.x>): expected a number, found \"a\"");
    CHECK(refusalOf("def Xform \"A\" {").find("line 2 (</A>): expected") != std::string::npos);
    CHECK(refusalOf("def Xform \"A\" {} def \"A\" {}").find("no sibling has") != std::string::npos);
    CHECK(refusalOf("def \"A b\" {}").find("expected the name of a prim") != std::string::npos);
    CHECK(refusalOf("def \"A\" { float x = 1\n int x = 1 }").find("of one type") != std::string::npos);
    CHECK(refusalOf("def \"A\" { string x = \"a\n\" }").find("end of the text") != std::string::npos);
    CHECK(refusalOf("def \"A\" { rel x = <../../b> }").find("within the layer") != std::string::npos);
    CHECK(refusalOf("def \"A\" { rel x = </A{v=a}b> }").find("into variants") != std::string::npos);
    CHECK(refusalOf("def \"A\" { int x.timeSamples = {1: 0, 1: 1} }").find("each time once") !=
          std::string::npos);
    CHECK(refusalOf("/* def").find("end of the comment") != std::string::npos);
    CHECK(refusalOf("def \"A\" { string x = \"\xff\" }").find("UTF-8") != std::string::npos);
    const auto whole = [](const std::string& text) {
        return refusal([&] { stageOf(Files{{"root.usda", text}}); });
    };
    CHECK(whole("PXR-USDC...").find("usdcat --flatten -o scene.usda root.usda") != std::string::npos);
    CHECK(hasNote(
        stageOf(Files{{"root.usda", "#usda 1.0\ndef \"A\" ( references = @b.usd@ ) {}"},
                      {"b.usd", "PXR-USDC..."}})
            .notes,
        "@b.usd@: is a binary layer of USD; expected text: usdcat --flatten -o scene.usda root.usda"));
    CHECK(whole("{}").find("begins with #usda 1.0") != std::string::npos);
}

TEST_CASE("bombs of a .usda are refused") {
    const auto many = [](const char* text) {
        std::string all;
        for (int k = 0; k < 100000; ++k) all += text;
        return all;
    };
    CHECK(refusalOf(many("def \"A\" { ")).find("64 levels") != std::string::npos);
    CHECK(refusalOf("def \"A\" { float3[] x = " + many("[")).find("64 levels") != std::string::npos);
    CHECK(refusalOf("def \"A\" { float3 x = " + many("(")).find("64 levels") != std::string::npos);
    CHECK(refusalOf("( customLayerData = {" + many("dictionary a = {")).find("64 levels") !=
          std::string::npos);
    CHECK(refusalOf("def \"A\" {" + many("variantSet \"v\" = { \"a\" {")).find("64 levels") !=
          std::string::npos);
    std::string wide;
    for (int k = 0; k < 700000; ++k) wide += "def \"p" + std::to_string(k) + "\" {}\n";
    CHECK(refusalOf(wide).find("too much memory") != std::string::npos);
}
