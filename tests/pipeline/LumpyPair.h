#pragma once
#include "bake/model/AddPair.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

namespace tss::test {

inline Motion swing() {
    Motion motion;
    motion.dofs = {joints::turn({1.3, 3, 0}, {0, 0, 1}, -0.5, 0.5)};
    return motion;
}

/// Two lumpy balls, one on a hinge that swings it into the other.
inline SceneModel lumpyPair(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    for (const char* name : {"A", "B"}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = lumpyMesh(random, 2, 0.3);
        if (!scene.bodies.empty())
            body.mesh = transformed(body.mesh, Eigen::Affine3d(Eigen::Translation3d(2.6, 0, 0)));
        scene.bodies.push_back(body);
    }
    addPair(scene, 0, 1, swing(), "Swing");
    return scene;
}

} // namespace tss::test
