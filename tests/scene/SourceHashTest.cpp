#include "bake/model/SourceHash.h"
#include "bake/base/Error.h"
#include "bake/base/Sha256.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

std::string sha256(const std::string& text, std::size_t piece) {
    Sha256 hash;
    for (std::size_t i = 0; i < text.size(); i += piece) {
        const std::string part = text.substr(i, piece);
        hash.add({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()});
    }
    return hash.hex();
}

SceneModel baked() {
    SceneModel scene = samples::fromFile(samples::jaw());
    scene.pairs[0].proof = std::make_shared<NeverCollides>();
    scene.pairs[0].sourceHash = sourceHash(scene, scene.pairs[0]);
    return scene;
}

} // namespace

TEST_CASE("SHA-256 gives the digests of FIPS 180") {
    CHECK(sha256("", 1) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(sha256("abc", 3) == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    const std::string two = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
    for (std::size_t piece : {1, 7, 56, 64})
        CHECK(sha256(two, piece) == "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    CHECK(sha256(std::string(1000000, 'a'), 1000) ==
          "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a table is fresh after saving and loading") {
    const SceneModel scene = baked();
    CHECK(staleness(scene, scene.pairs[0]).empty());
    const SceneModel again = samples::fromFile(scene);
    CHECK(staleness(again, again.pairs[0]).empty());
    CHECK_NOTHROW(requireFresh(again, "test.tss"));
}

TEST_CASE("a table that says it was made for more than its joints' limits is not believed") {
    SceneModel scene = baked();
    Pair& pair = scene.pairs[0];
    Table table;
    table.motion = pairMotion(scene, pair);
    pair.proof.reset();
    const auto saysLimits = [&](double lower, double upper) {
        table.motion.dofs[0].lower = lower;
        table.motion.dofs[0].upper = upper;
        pair.table = std::make_shared<Table>(table);
        return staleness(scene, pair);
    };
    const auto [lower, upper] = std::pair(table.motion.dofs[0].lower, table.motion.dofs[0].upper);
    CHECK(saysLimits(lower, upper).empty());
    CHECK_THAT(saysLimits(lower, upper + 0.1), Catch::Contains("wider limits"));
    CHECK_THAT(saysLimits(lower - 0.1, upper), Catch::Contains("wider limits"));
    CHECK_THROWS_AS(requireFresh(scene, "test.tss"), InputError);
}

TEST_CASE("a stale table is refused with what changed") {
    SceneModel scene = baked();
    SECTION("a mesh") {
        scene.bodies[1].mesh.vertices[0].x() = -1;
        CHECK(staleness(scene, scene.pairs[0]) == "the mesh of /Scene/B changed since its table was baked");
    }
    SECTION("a joint") {
        scene.joints[0].frame0.translation().x() += 0.001;
        CHECK(staleness(scene, scene.pairs[0]) == "the joint changed since its table was baked");
    }
    SECTION("a limit") {
        scene.joints[0].dofs[0].upper += 0.1;
        CHECK(staleness(scene, scene.pairs[0]) == "the limits changed since its table was baked");
    }
    SECTION("a setting and a coupling") {
        scene.pairs[0].settings["epsilon"] = "0.1";
        scene.joints[0].planes.push_back({{1, 1}, 0.1});
        CHECK(staleness(scene, scene.pairs[0]) ==
              "the limits and the settings changed since its table was baked");
    }
    SECTION("a table without a hash") {
        scene.pairs[0].sourceHash.clear();
        CHECK_THAT(staleness(scene, scene.pairs[0]), Catch::Contains("tss:sourceHash"));
    }
    CHECK_THROWS_WITH(requireFresh(scene, "test.tss"),
                      Catch::StartsWith("test.tss (</Scene/Jaw>)") && Catch::Contains("bake it again"));
}

TEST_CASE("colours, places and desired motion do not make a table stale") {
    SceneModel scene = baked();
    scene.bodies[0].displayColor = {1, 0, 0};
    scene.bodies[1].placement.translation().z() = 5;
    scene.joints[0].drives[0] = {{0, 1}, {0, 0.1}};
    CHECK(staleness(scene, scene.pairs[0]).empty());
}

TEST_CASE("a skin's table is stale when a muscle changed, not when a compliance did") {
    SceneModel scene = samples::fromFile(samples::brow());
    SkinModel& skin = scene.skins[0];
    skin.table = std::make_shared<SkinTable>();
    skin.sourceHash = sourceHash(scene, skin);
    skin.bendCompliance = 2;
    skin.selfContact = !skin.selfContact;
    CHECK(staleness(scene, skin).empty());
    scene.muscles[0].muscle.maxContraction = 0.31;
    CHECK_THAT(staleness(scene, skin), Catch::StartsWith("the muscles' fibres or forms changed"));
}

TEST_CASE("a skin's table is stale when what carries a muscle's end changed, named by the skin or not") {
    SceneModel scene = samples::fromFile(samples::brow());
    const auto add = [&](const char* path) {
        Body body;
        body.path = path;
        body.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        body.mesh.triangles = {{0, 1, 2}};
        scene.bodies.push_back(std::move(body));
        return static_cast<int>(scene.bodies.size()) - 1;
    };
    const int origin = add("/Scene/Origin"), beside = add("/Scene/Beside"),
              insertion = add("/Scene/Insertion"), apart = add("/Scene/Apart");
    for (const auto& [moved, path] :
         {std::pair(insertion, "/Scene/Hinge"), std::pair(apart, "/Scene/Other")}) {
        Joint joint;
        joint.path = path;
        joint.body1 = moved;
        joint.dofs.emplace_back();
        scene.joints.push_back(std::move(joint));
    }
    scene.muscles[0].bone = origin;
    scene.muscles[0].insertionBone = insertion;
    SkinModel& skin = scene.skins[0];
    skin.table = std::make_shared<SkinTable>();
    skin.sourceHash = sourceHash(scene, skin);
    scene.bodies[apart].mesh.vertices[0].x() = 0.1;
    CHECK(staleness(scene, skin).empty());
    for (const int carries : {origin, beside, insertion}) {
        scene.bodies[carries].mesh.vertices[0].x() = 0.1;
        CHECK_THAT(staleness(scene, skin), Catch::StartsWith("the meshes of the muscles or bones changed"));
        scene.bodies[carries].mesh.vertices[0].x() = 0;
    }
}
