// Which joint moves which body, and pairs of which nothing could be proven.
#include "bake/model/Kinematics.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneParts.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomJoints.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace tss;
using namespace samples;

namespace {

/// Three bodies in a row on hinges, and joints on top, each between two of them; -1 is the world.
SceneModel linkage(const std::vector<std::pair<int, int>>& more) {
    std::mt19937_64 random(5);
    SceneModel scene;
    for (const char* name : {"A", "B", "C"}) samples::addBody(scene, name);
    const auto add = [&](int body0, int body1) {
        Joint joint = randomJoint(random, "J" + std::to_string(scene.joints.size()), body0, body1);
        joint.dofs = {randomDof(random, 1, true)};
        joint.planes.clear();
        joint.drives.resize(1);
        scene.joints.push_back(joint);
    };
    add(0, 1), add(1, 2);
    for (const auto& [body0, body1] : more) add(body0, body1);
    return scene;
}

void onlyPair(SceneModel& scene, const std::string& path, int bodyA, int bodyB, std::vector<int> joints) {
    Pair pair;
    pair.path = path;
    pair.bodyA = bodyA;
    pair.bodyB = bodyB;
    pair.joints = std::move(joints);
    scene.pairs = {pair};
}

void pairOn(SceneModel& scene, int joint) {
    const Joint& on = scene.joints[joint];
    onlyPair(scene, on.path, on.body0, on.body1, {joint});
}

} // namespace

TEST_CASE("a pair on a joint of a closed loop is refused, as one over a chain of it is") {
    // Closed forwards, and by a body that two joints move.
    for (const auto& closing : {std::pair(2, 0), std::pair(0, 2)})
        for (int joint = 0; joint < 3; ++joint) {
            SceneModel scene = linkage({closing});
            CHECK_NOTHROW(samples::fromFile(scene)); // without a pair nothing is said of it
            pairOn(scene, joint);
            CHECK_THROWS_WITH(samples::fromFile(scene),
                              Catch::StartsWith("test.tss: /primChildren/0/primChildren/") &&
                                  Catch::Contains("(</Scene/J" + std::to_string(joint) + ">)") &&
                                  Catch::Contains("expected one chain of joints from /Scene/") &&
                                  Catch::Contains("closed loop"));
            scene.joints.back().enabled = false;
            if (joint < 2)
                CHECK_NOTHROW(samples::fromFile(scene));
            else
                CHECK_THROWS_WITH(samples::fromFile(scene),
                                  Catch::Contains("expected a joint that is enabled"));
        }
    // One that the pair's bodies have no part in is none of its business.
    SceneModel elsewhere = linkage({{-1, 0}, {-1, 0}});
    pairOn(elsewhere, 1);
    CHECK_NOTHROW(samples::fromFile(elsewhere));
}

TEST_CASE("a pair over a joint that does not move its body1 is refused") {
    SceneModel scene = linkage({});
    samples::addBody(scene, "D");
    std::mt19937_64 random(6);
    scene.joints.push_back(scene.joints[1]);
    scene.joints[2].path = "/Scene/J2";
    scene.joints[2].body0 = 3; // C hangs on B and on D
    pairOn(scene, 1);
    CHECK_NOTHROW(samples::fromFile(scene));
    pairOn(scene, 2);
    const auto refused = Catch::Contains("(</Scene/J2>): expected that /Scene/J2 moves its physics:body1, "
                                         "found that /Scene/C moves by /Scene/J1");
    CHECK_THROWS_WITH(samples::fromFile(scene), refused);
    onlyPair(scene, "/Scene/Ends", 0, 3, {0, 1, 2});
    CHECK_THROWS_WITH(samples::fromFile(scene), Catch::Contains("/Scene/C moves by /Scene/J1"));
    scene.joints[2].body0 = 0, scene.joints[2].body1 = -1; // the world hangs on A
    scene.joints.push_back(scene.joints[0]);
    scene.joints[3].path = "/Scene/J3";
    scene.joints[3].body0 = -1, scene.joints[3].body1 = 3;
    onlyPair(scene, "/Scene/Ends", 0, 3, {2, 3});
    CHECK_THROWS_WITH(samples::fromFile(scene),
                      Catch::Contains("/Scene/J2 moves its physics:body1, found that "
                                      "this is the world"));
}

TEST_CASE("bodies stand where the joints that move them say, however these are ordered") {
    std::mt19937_64 random(8);
    for (int round = 0; round < 50; ++round) {
        SceneModel scene = linkage({{2, 0}, {-1, 2}}); // a loop, and C on the world as well
        std::shuffle(scene.joints.begin(), scene.joints.end(), random);
        std::vector<double> values;
        for (const Joint& joint : scene.joints)
            values.push_back(uniform(random, joint.dofs[0].lower, joint.dofs[0].upper));
        const std::vector<int> mover = movers(scene);
        const std::vector<Pose> stands = posedBodies(scene, values);
        int standing = 0;
        for (int body = 0; body < 3; ++body) {
            if (mover[body] < 0) {
                ++standing;
                CHECK(stands[body].matrix() == scene.bodies[body].placement.matrix());
                continue;
            }
            const Joint& joint = scene.joints[mover[body]];
            CHECK(joint.body1 == body);
            const Pose parent = joint.body0 < 0 ? Pose::Identity() : stands[joint.body0];
            const Pose expected = parent * jointMatrix(joint, {values[mover[body]]});
            CHECK((stands[body].matrix() - expected.matrix()).cwiseAbs().maxCoeff() < 1e-12);
        }
        CHECK(standing <= 1);
    }
}

TEST_CASE("a pair of a moved body with another mesh inside, which would stay behind, is refused") {
    SceneModel scene = samples::jaw();
    const int tooth = samples::addBody(scene, "B/Tooth");
    CHECK_THROWS_WITH(samples::fromFile(scene),
                      Catch::Contains("(</Scene/Jaw>)") && Catch::Contains("all of /Scene/B in one mesh") &&
                          Catch::Contains("/Scene/B/Tooth inside of it, which no joint moves"));
    scene.bodies[tooth].path = "/Scene/A/Tooth"; // of what stands
    CHECK_NOTHROW(samples::fromFile(scene));
    scene.bodies[tooth].path = "/Scene/B/Tooth";
    Joint joint;
    joint.path = "/Scene/Root";
    joint.body0 = 1;
    joint.body1 = tooth;
    scene.joints.push_back(joint);
    CHECK_NOTHROW(samples::fromFile(scene));
    scene.joints.pop_back();
    scene.pairs.clear();
    CHECK_NOTHROW(samples::fromFile(scene));
}

TEST_CASE("a pair whose meshes or joints change in time is refused, for it is proven of what they are once") {
    const SceneModel scene = samples::jaw();
    const auto with = [&](const std::string& path, const std::string& name, const std::string& type,
                          const Value& value, bool pairs = true) {
        SceneModel of = scene;
        if (!pairs) of.pairs.clear();
        Layer layer = toLayer(of);
        Property& property = findPrim(layer, path)->properties[name];
        property.typeName = type;
        if (!property.defaultValue) property.defaultValue = value;
        property.timeSamples = {{0, value}, {24, value}};
        return layer;
    };
    const Value point(Numbers{{0, 0, 0}, 3}), scale(Numbers{{1, 1, 1}, 3});
    const auto refuses = [](const Layer& layer, const std::string& name) {
        CHECK_THROWS_WITH(readScene(layer, "test.tss"),
                          Catch::Contains(name + "/timeSamples") && Catch::Contains("changes in time"));
    };
    refuses(with("/Scene/B", "points", "point3f[]", point), "points");
    refuses(with("/Scene", "xformOp:scale", "float3", scale), "xformOp:scale");
    refuses(with("/Scene/Jaw", "physics:localPos1", "point3f", point), "physics:localPos1");
    refuses(with("/Scene/Jaw", "limit:rotY:physics:high", "float", Value(1.0)), "limit:rotY:physics:high");
    refuses(with("/Scene/Jaw", "tss:rest", "double[]", Value(Numbers{{0, 0}, 1})), "tss:rest");
    CHECK_NOTHROW(readScene(with("/Scene/B", "points", "point3f[]", point, false), "test.tss"));
    CHECK_NOTHROW(
        readScene(with("/Scene/Jaw", "drive:rotY:physics:targetPosition", "float", Value(1.0)), "test.tss"));
    CHECK_NOTHROW(readScene(with("/Scene/B", "xformOp:translate", "double3", point), "test.tss"));
}
