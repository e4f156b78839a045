#include "bake/base/Error.h"
#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneParts.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomJoints.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace samples;

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
