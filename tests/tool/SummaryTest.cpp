// What is said of parts that overlap at rest, whose contact is exempt.
#include "tests/Shapes.h"
#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using Json = nlohmann::json;

namespace {

/// Bakes two boxes that slide along Z against each other, B raised by `height`.
struct Boxes {
    Folder folder;
    std::string info, verify;
    Json infoJson, verifyJson;

    Boxes(const tss::TriangleMesh& a, const tss::TriangleMesh& b, const std::string& more = "") {
        writeObj(a, folder / "a.obj");
        writeObj(b, folder / "b.obj");
        const auto run = [&](const std::string& arguments) {
            const Ran ran = runTss(arguments, folder.path());
            INFO(ran.err);
            REQUIRE(ran.exit == 0);
            return ran.out;
        };
        run("make -o s.tss --a a.obj --b b.obj --dof trans:0,0,1:-0.5:0.5 --quiet");
        run("bake s.tss -o s.tss --quiet" + more);
        info = run("info s.tss");
        verify = run("verify s.tss");
        infoJson = Json::parse(run("info s.tss --json"))["pairs"][0];
        verifyJson = Json::parse(run("verify s.tss --json"));
    }
};

/// The text from a word on, to the end of the line.
std::string lineFrom(const std::string& text, const std::string& word) {
    const auto at = text.find(word);
    return at == text.npos ? "" : text.substr(at, text.find('\n', at) - at);
}

} // namespace

TEST_CASE("where parts overlap at rest what is said first is of how much of each body the bounds are") {
    // A pin, most of it in a block that has no bore.
    const Boxes pin(boxMesh({-1, -1, -2}, {1, 1, 0}), boxMesh({-0.2, -0.2, -1.5}, {0.2, 0.2, 0.3}),
                    " --tolerance 0.02");
    const double a = pin.infoJson["boundedA"], b = pin.infoJson["boundedB"];
    CHECK(a > 0.9);
    CHECK(a < 1);
    CHECK(b > 0.2); // what is outside
    CHECK(b < 0.6);
    CHECK(a == Approx(1 - pin.infoJson["restRegion"]["shareA"].get<double>()));
    CHECK(b == Approx(1 - pin.infoJson["restRegion"]["shareB"].get<double>()));
    CHECK(lineFrom(pin.info, "bounds ").find("bounds       for 9") == 0);
    CHECK(lineFrom(pin.info, "bounds ").find(" % of B: miss 0 m") != std::string::npos);
    CHECK(lineFrom(pin.info, "exempt ").find("which overlap at rest: told where they go deeper") !=
          std::string::npos);

    CHECK(lineFrom(pin.verify, ": ").find(": holds for 9") == 0);
    CHECK(pin.verifyJson["pairs"][0]["boundedA"].get<double>() == Approx(a));
    CHECK(pin.verifyJson["pairs"][0]["boundedB"].get<double>() == Approx(b));
    CHECK(pin.verifyJson["proven"] == true);
}

TEST_CASE("of bodies that are exempt as a whole nothing is said to be proven") {
    const tss::TriangleMesh box = boxMesh({-1, -1, -1}, {1, 1, 1});
    const Boxes same(box, box, " --tolerance 0.1");
    CHECK(same.infoJson["boundedA"] == 0);
    CHECK(same.infoJson["boundedB"] == 0);
    CHECK(same.info.find("bounds       none: all of A and of B is exempt, and nothing is proven") !=
          std::string::npos);
    CHECK(same.info.find("certified for every pose") == std::string::npos);
    CHECK(same.verify.find("nothing is proven: all of A and of B is exempt") != std::string::npos);
    CHECK(same.verify.find("holds") == std::string::npos);
    CHECK(same.verifyJson["holds"] == true);
    CHECK(same.verifyJson["proven"] == false);
}

TEST_CASE("bounds about all of both bodies need no such word, and those of samples are about none") {
    const tss::TriangleMesh a = boxMesh({-1, -1, -2}, {1, 1, 0}),
                            b = boxMesh({-0.5, -0.5, 0.2}, {0.5, 0.5, 1});
    const Boxes apart(a, b, " --tolerance 0.05");
    CHECK(apart.infoJson["boundedA"] == 1);
    CHECK(apart.infoJson["boundedB"] == 1);
    CHECK(lineFrom(apart.info, "bounds ").find("bounds       miss 0 m") == 0);
    CHECK(apart.verify.find("holds at every pose: ") != std::string::npos);

    const Folder folder;
    writeObj(a, folder / "a.obj");
    writeObj(b, folder / "b.obj");
    REQUIRE(runTss("make -o s.tss --a a.obj --b b.obj --dof trans:0,0,1:-0.5:0.5", folder.path()).exit == 0);
    REQUIRE(runTss("bake s.tss -o s.tss --tolerance 0.05 --search sampled --quiet", folder.path()).exit == 0);
    const Json sampled = Json::parse(runTss("info s.tss --json", folder.path()).out)["pairs"][0];
    CHECK(sampled["boundedA"].is_null());
    CHECK(sampled["boundedB"].is_null());
}

TEST_CASE("a bake of all pairs counts what never collides but for its rest, and what is little bounded") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -2}, {1, 1, 0}), folder / "block.obj");
    writeObj(boxMesh({-0.2, -0.2, -1.5}, {0.2, 0.2, 0.3}), folder / "pin.obj");
    writeObj(boxMesh({5, 0, 0}, {6, 1, 1}), folder / "far.obj");
    REQUIRE(runTss("make -o row.tss --body block.obj --body pin.obj --body far.obj --pairs neighbours "
                   "--joint 'in=block,pin:trans:0,0,1:-0.1:0.1' --joint 'out=block,far:trans:0,0,1:-0.1:0.1'",
                   folder.path())
                .exit == 0);
    const Ran ran = runTss("bake row.tss -o baked.tss --all-pairs --tolerance 0.05", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    CHECK(ran.out.find("never collide: 2 pairs; 1 overlap at rest (1 with bounds for less than half of a "
                       "body), 0 may meet") != std::string::npos);
}
