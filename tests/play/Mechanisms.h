#pragma once
#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"
#include "tests/table/RandomTable.h"

#include <memory>

/// Scenes of bodies on joints with tables of random spheres, without meshes.
namespace mechanisms {

using random_table::between;
using random_table::Random;

inline tss::Pose anyPose(Random& random, double size) {
    tss::Pose pose = tss::Pose::Identity();
    pose.linear() =
        Eigen::AngleAxisd(between(random, 0, 3), random_table::direction(random)).toRotationMatrix();
    pose.translation() = random_table::inBall(random, size);
    return pose;
}

inline tss::Joint anyJoint(Random& random, int body0, int body1, int dofs) {
    tss::Joint joint;
    joint.path = "/Scene/Joint" + std::to_string(body1);
    joint.body0 = body0;
    joint.body1 = body1;
    joint.frame0 = anyPose(random, 0.5);
    joint.frame1 = anyPose(random, 0.5);
    for (int k = 0; k < dofs; ++k) {
        tss::Dof dof;
        dof.name = "dof" + std::to_string(k);
        dof.axis = tss::Vec3::Unit(int(random() % 3));
        dof.kind = random() % 4 ? tss::DofKind::Rotation : tss::DofKind::Translation;
        dof.lower = -between(random, 0.1, 1);
        dof.upper = between(random, 0.1, 1);
        joint.dofs.push_back(dof);
    }
    joint.drives.resize(joint.dofs.size());
    if (dofs > 1 && random() % 2)
        joint.planes = {{std::vector<double>(joint.dofs.size(), 1.0), between(random, 0.3, 2)}};
    return joint;
}

/// So many that the tests are asked in clusters.
inline bool many(const tss::Motion& motion) {
    return motion.dofCount() > 3;
}

/// Bodies on one another as a tree whose joints are crossed either way, and a table or a proof for all that
/// move against each other over up to seven values. chain: each on the one before.
inline tss::SceneModel anyMechanism(Random& random, int bodies, bool chain) {
    tss::SceneModel scene;
    scene.bodies.resize(std::size_t(bodies));
    for (int k = 0; k < bodies; ++k) scene.bodies[k].path = "/Scene/Body" + std::to_string(k);
    if (random() % 2) scene.joints.push_back(anyJoint(random, -1, 0, 1)); // on rails in the world
    for (int k = 1; k < bodies; ++k) {
        const int parent = chain ? k - 1 : int(random() % std::uint64_t(k));
        const bool backwards = random() % 3 == 0;
        tss::Joint joint = anyJoint(random, parent, k, int(random() % 8 ? 1 + random() % 2 : 0));
        if (backwards) std::swap(joint.body0, joint.body1);
        scene.joints.push_back(joint);
    }
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b) {
            tss::Pair pair;
            pair.path = "/Scene/Pair" + std::to_string(a) + "_" + std::to_string(b);
            pair.bodyA = a;
            pair.bodyB = b;
            pair.joints = tss::findChain(scene.joints, a, b).value();
            const tss::Motion motion = tss::pairMotion(scene, pair);
            if (motion.dofCount() == 0 || motion.dofCount() > 7) continue;
            if (random() % 6 == 0) {
                pair.proof = std::make_shared<tss::NeverCollides>();
            } else {
                tss::Table table = random_table::table(random, motion, 10, many(motion) ? 30 : 8, 1);
                for (tss::SphereSet* set : {&table.a, &table.b})
                    for (tss::Sphere& s : *set) s.radius *= 0.35;
                pair.table = std::make_shared<tss::Table>(std::move(table));
            }
            scene.pairs.push_back(pair);
        }
    return scene;
}

inline std::vector<double> anyValues(Random& random, const tss::SceneModel& scene) {
    std::vector<double> values;
    for (const tss::Joint& joint : scene.joints)
        for (const tss::Dof& dof : joint.dofs) values.push_back(between(random, dof.lower, dof.upper));
    return values;
}

inline std::vector<double> ownValues(const tss::SceneModel& scene, const tss::Pair& pair,
                                     const std::vector<double>& values) {
    std::vector<double> own;
    for (const tss::JointDof& dof : tss::pairDofs(scene, pair)) {
        std::size_t at = dof.dof;
        for (int joint = 0; joint < dof.joint; ++joint) at += scene.joints[joint].dofs.size();
        own.push_back(values[at]);
    }
    return own;
}

} // namespace mechanisms
