#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneParts.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

#include <random>

using namespace tss;

namespace {

double uniform(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Pose randomPose(std::mt19937_64& random) {
    Pose pose = Pose::Identity();
    const Eigen::Vector4d q(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
                            uniform(random, 0.1, 1));
    pose.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    pose.translation() = Vec3(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2));
    return pose;
}

Dof randomDof(std::mt19937_64& random, int axis, bool turns) {
    Dof dof;
    dof.name = "d" + std::to_string(axis) + (turns ? "r" : "t");
    dof.kind = turns ? DofKind::Rotation : DofKind::Translation;
    dof.axis = Vec3::Unit(axis) * (turns ? 1.0 : uniform(random, 0.5, 2));
    dof.lower = uniform(random, -1, 0);
    dof.upper = uniform(random, 0, 1);
    return dof;
}

/// A path that turns about a place, or travels without turning: its inverse is one as well.
Dof randomPath(std::mt19937_64& random) {
    Dof dof;
    dof.name = "path";
    dof.kind = DofKind::Path;
    dof.frame = randomPose(random);
    const bool turns = random() % 2;
    const Pose still = randomPose(random);
    for (int k = 0; k < 4; ++k) {
        const Pose row = randomPose(random);
        dof.path.push_back({double(k), turns ? still.translation() : row.translation(),
                            Eigen::Quaterniond(turns ? row.linear() : still.linear())});
    }
    dof.lower = 0.5;
    dof.upper = 2.7;
    return dof;
}

Joint randomJoint(std::mt19937_64& random, const std::string& name, int body0, int body1) {
    Joint joint;
    joint.path = "/Scene/" + name;
    joint.body0 = body0;
    joint.body1 = body1;
    joint.frame0 = randomPose(random);
    joint.frame1 = randomPose(random);
    for (int axis = 0; axis < 3; ++axis)
        if (random() % 2) joint.dofs.push_back(randomDof(random, axis, random() % 2));
    if (random() % 3 == 0)
        joint.dofs.insert(joint.dofs.begin() +
                              static_cast<std::ptrdiff_t>(random() % (joint.dofs.size() + 1)),
                          randomPath(random));
    joint.drives.resize(joint.dofs.size());
    LimitPlane plane;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) plane.coefficients.push_back(uniform(random, 0.5, 1));
    plane.bound = 100;
    if (!joint.dofs.empty()) joint.planes = {plane};
    return joint;
}

/// Straight from the definition: T = frame0 * D1...Dd * frame1^-1.
Pose jointMatrix(const Joint& joint, const std::vector<double>& q) {
    Pose pose = joint.frame0;
    for (std::size_t k = 0; k < q.size(); ++k) pose = pose * dofPose(joint.dofs[k], q[k]);
    return pose * joint.frame1.inverse();
}

} // namespace

TEST_CASE("the motion of a chain is its joints multiplied, those crossed backwards inverted") {
    std::mt19937_64 random(7);
    for (int round = 0; round < 100; ++round) {
        INFO("round " << round << " of seed 7");
        SceneModel scene;
        const int length = 1 + static_cast<int>(random() % 4);
        for (int k = 0; k <= length; ++k) samples::addBody(scene, "B" + std::to_string(k));
        std::vector<bool> backwards;
        for (int k = 0; k < length; ++k) {
            backwards.push_back(random() % 2);
            scene.joints.push_back(randomJoint(random, "J" + std::to_string(k), backwards[k] ? k + 1 : k,
                                               backwards[k] ? k : k + 1));
        }
        Pair pair;
        pair.bodyA = 0;
        pair.bodyB = length;
        pair.joints = findChain(scene.joints, 0, length).value();
        REQUIRE(pair.joints.size() == std::size_t(length));
        const Motion motion = pairMotion(scene, pair);

        std::vector<double> q;
        double planesWanted = 0, planesFound = 0;
        Pose wanted = Pose::Identity();
        for (int k = 0; k < length; ++k) {
            const Joint& joint = scene.joints[k];
            std::vector<double> own;
            for (const Dof& dof : joint.dofs) own.push_back(uniform(random, dof.lower, dof.upper));
            const Pose matrix = jointMatrix(joint, own);
            wanted = wanted * (backwards[k] ? Pose(matrix.inverse()) : matrix);
            for (const LimitPlane& plane : joint.planes)
                for (std::size_t d = 0; d < own.size(); ++d) planesWanted += plane.coefficients[d] * own[d];
            if (backwards[k]) std::reverse(own.begin(), own.end());
            q.insert(q.end(), own.begin(), own.end());
        }
        REQUIRE(motion.dofs.size() == q.size());
        CHECK((pose(motion, q).matrix() - wanted.matrix()).norm() < 1e-12);
        for (const LimitPlane& plane : motion.planes)
            for (std::size_t d = 0; d < q.size(); ++d) planesFound += plane.coefficients.at(d) * q[d];
        CHECK(planesFound == Approx(planesWanted).margin(1e-12));
        if (length > 1 && !q.empty()) CHECK(motion.dofs[0].name.find(':') != std::string::npos);
    }
}

TEST_CASE("a chain that goes both ways round is no chain") {
    std::mt19937_64 random(1);
    std::vector<Joint> joints;
    for (auto [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 3), std::pair(3, 4)})
        joints.push_back(randomJoint(random, "J", a, b));
    CHECK(findChain(joints, 4, 0).value() == std::vector<int>{3, 2, 1, 0});
    CHECK(findChain(joints, 0, 7).value().empty());
    joints.push_back(randomJoint(random, "J", 1, 3)); // a loop 1-2-3
    CHECK_FALSE(findChain(joints, 0, 4).has_value());
    CHECK(findChain(joints, 0, 1).value() == std::vector<int>{0});
    joints.back().enabled = false;
    CHECK(findChain(joints, 0, 4).has_value());
}

TEST_CASE("two joints to the world make a chain between their bodies") {
    std::mt19937_64 random(2);
    const std::vector<Joint> joints = {randomJoint(random, "J", -1, 0), randomJoint(random, "K", -1, 1)};
    CHECK(findChain(joints, 0, 1).value() == std::vector<int>{0, 1});
}

TEST_CASE("a pair over a chain is found again in its file") {
    SceneModel scene;
    for (const char* name : {"A", "Between", "B"}) samples::addBody(scene, name);
    std::mt19937_64 random(3);
    for (int k = 0; k < 2; ++k) {
        Joint joint = randomJoint(random, "J" + std::to_string(k), k, k + 1);
        joint.dofs = {randomDof(random, 1, true)};
        joint.planes.clear();
        joint.drives.resize(1);
        scene.joints.push_back(joint);
    }
    Pair pair;
    pair.path = "/Scene/Ends";
    pair.bodyA = 2;
    pair.bodyB = 0;
    pair.joints = {1, 0};
    scene.pairs.push_back(pair);
    const SceneModel back = samples::fromFile(scene);
    REQUIRE(back.pairs.size() == 1);
    CHECK(back.pairs[0].joints == pair.joints);
    CHECK(back.pairs[0].bodyA == 2);
    const std::vector<double> q = {0.1, -0.2};
    const Pose was = pose(pairMotion(scene, pair), q), is = pose(pairMotion(back, back.pairs[0]), q);
    CHECK((was.matrix() - is.matrix()).norm() < 1e-5);
}

TEST_CASE("a path is read with its rows, and one that turns and travels is not crossed backwards") {
    SceneModel scene;
    samples::addBody(scene, "A");
    samples::addBody(scene, "B");
    Joint joint;
    joint.path = "/Scene/Knee";
    joint.body0 = 0;
    joint.body1 = 1;
    Dof dof;
    dof.kind = DofKind::Path;
    dof.name = "bend";
    for (int k = 0; k < 3; ++k)
        dof.path.push_back({double(k), Vec3(k, 0.5 * k * k, 0),
                            Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * k, Vec3::UnitX()))});
    dof.lower = 0.5;
    dof.upper = 2;
    joint.dofs = {dof};
    joint.drives = {{{0, 24}, {0.5, 1.75}}};
    scene.joints = {joint};
    Pair pair;
    pair.path = joint.path;
    pair.bodyA = 0;
    pair.bodyB = 1;
    pair.joints = {0};
    scene.pairs = {pair};
    const SceneModel back = samples::fromFile(scene);
    const Dof& read = back.joints[0].dofs.at(0);
    CHECK(read.lower == 0.5);
    CHECK(read.name == "bend");
    CHECK(back.joints[0].drives[0].at(24) == 1.75);
    for (double q : {0.5, 1.2, 2.0})
        CHECK((dofPose(read, q).matrix() - dofPose(dof, q).matrix()).norm() < 1e-15);
    std::swap(scene.pairs[0].bodyA, scene.pairs[0].bodyB);
    CHECK_THROWS_WITH(pairMotion(scene, scene.pairs[0]), Catch::Contains("physics:body0 to physics:body1"));
}

TEST_CASE(
    "The DOFs of a pair's motion are those of its joints that pairDofs() says, however they are crossed") {
    std::mt19937_64 random(4);
    int reversed = 0;
    for (int round = 0; round < 200; ++round) {
        // Two arms on a hub, or one behind the other, each joint either way round.
        SceneModel scene;
        scene.bodies.resize(3);
        const bool first = random() % 2, second = random() % 2;
        scene.joints = {randomJoint(random, "J0", first ? 0 : 1, first ? 1 : 0),
                        randomJoint(random, "J1", second ? 0 : 2, second ? 2 : 0)};
        Pair pair;
        pair.bodyA = 1;
        pair.bodyB = 2;
        pair.joints = {0, 1};
        std::vector<std::vector<double>> values(2);
        for (std::size_t j = 0; j < 2; ++j)
            for (const Dof& dof : scene.joints[j].dofs)
                values[j].push_back(uniform(random, dof.lower, dof.upper));
        std::vector<double> q;
        for (const JointDof& dof : pairDofs(scene, pair)) {
            q.push_back(values[static_cast<std::size_t>(dof.joint)][dof.dof]);
            reversed += q.size() > 1 && dof.dof == 0 &&
                        scene.joints[static_cast<std::size_t>(dof.joint)].dofs.size() > 1;
        }
        const Pose one = jointMatrix(scene.joints[0], values[0]),
                   other = jointMatrix(scene.joints[1], values[1]);
        const Pose expected = (first ? one.inverse() : one) * (second ? other : other.inverse());
        CHECK((pose(pairMotion(scene, pair), q).matrix() - expected.matrix()).cwiseAbs().maxCoeff() < 1e-12);
    }
    CHECK(reversed > 20);
}

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

TEST_CASE("the box of a cone of limits holds it in whatever order the turns are taken") {
    const double degree = std::acos(-1) / 180;
    std::mt19937_64 random(9);
    std::vector<int> order = {0, 1, 2};
    do {
        for (int axis = 0; axis < 3; ++axis) {
            SceneModel scene = linkage({});
            Layer layer = toLayer(scene);
            Prim& prim = *findPrim(layer, "/Scene/J0");
            prim.typeName = "PhysicsSphericalJoint";
            prim.properties.clear();
            PrimWriter writer(prim);
            writer.setTargets(schema::body0, {"/Scene/A"});
            writer.setTargets(schema::body1, {"/Scene/B"});
            writer.set(schema::axis, std::string(1, "XYZ"[axis]));
            writer.set(schema::coneAngle0, 20.0);
            writer.set(schema::coneAngle1, 30.0);
            std::vector<std::string> tokens;
            for (int k : order) tokens.push_back(std::string("rot") + "XYZ"[k]);
            writer.set(Attribute{"tss:dofOrder", "token[]", true}, tokens);
            const std::vector<Dof> dofs = readScene(layer, "test.tss").joints.at(0).dofs;
            const int i = order[0], j = order[1], k = order[2];
            const double sign = (j - i + 3) % 3 == 1 ? 1 : -1; // cyclic or not
            CAPTURE(axis, i, j, k);
            for (int round = 0; round < 300; ++round) {
                const Vec3 across = Vec3::Unit((axis + 1) % 3);
                const auto about = [&](double most, const Vec3& by) {
                    return Eigen::AngleAxisd(uniform(random, -most, most) * degree, by).toRotationMatrix();
                };
                const Eigen::Matrix3d turn =
                    about(180, Vec3::Unit(axis)) * about(30, across) * about(180, Vec3::Unit(axis));
                double q[] = {std::atan2(-sign * turn(j, k), turn(k, k)), std::asin(sign * turn(i, k)),
                              std::atan2(-sign * turn(i, j), turn(i, i))};
                const auto within = [&] {
                    for (int d = 0; d < 3; ++d) {
                        const double value = std::remainder(q[d], 360 * degree);
                        if (value < dofs[d].lower - 1e-6 || value > dofs[d].upper + 1e-6) return false;
                    }
                    return true;
                };
                bool held = within();
                q[0] += 180 * degree, q[1] = 180 * degree - q[1], q[2] += 180 * degree;
                held = held || within();
                CHECK(held);
            }
        }
    } while (std::next_permutation(order.begin(), order.end()));
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
