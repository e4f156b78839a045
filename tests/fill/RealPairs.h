#pragma once
#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "tests/SharedMeshes.h"
#include "tests/fill/Verdicts.h"

/// The real pairs with the joints of pairs.json, fixed body first, DOFs from it to the moving one.
namespace zone {

using joints::slide;

inline Scene realPair(const std::string& set) {
    using tss::Vec3;
    const auto meshes = [](const char* a, const char* b) {
        return Scene{tss::importMesh(sharedMesh(a)), tss::importMesh(sharedMesh(b)), {}};
    };
    Scene scene;
    if (set == "dog_jaw") {
        const Vec3 c(0.30549, 0, 0.68499);
        scene = meshes("dog_jaw/skull.obj", "dog_jaw/mandible.obj");
        scene.motion.dofs = {turn(c, Vec3::UnitZ(), -4 * degree, 4 * degree),
                             turn(c, Vec3::UnitY(), -24 * degree, 18 * degree)};
        scene.motion.base.translation() = Vec3(-0.001, 0, -0.002);
    } else if (set == "human_jaw_ict") {
        scene = meshes("human_jaw_ict/upper_teeth.obj", "human_jaw_ict/lower_teeth.obj");
        scene.motion.dofs = {slide({0, -0.17, 0.888}, 0, 1),
                             turn({0, 0, -10.3}, Vec3::UnitY(), -1.89 * degree, 1.89 * degree),
                             turn({0, -0.547, 1.819}, Vec3::UnitX(), 0, 25.3 * degree)};
    } else if (set == "dog_hip") {
        const Vec3 c(-0.32629, 0.047237, 0.46357);
        scene = meshes("dog_limbs/pelvis.obj", "dog_limbs/femur_L.obj");
        scene.motion.dofs = {turn(c, Vec3::UnitZ(), -20 * degree, 20 * degree),
                             turn(c, Vec3::UnitX(), -30 * degree, 90 * degree),
                             turn(c, Vec3::UnitY(), -130 * degree, 60 * degree)};
    } else if (set == "human_finger") {
        scene = meshes("human_finger/proximal_phalanx.obj", "human_finger/middle_phalanx.obj");
        scene.motion.dofs = {turn({0.018, 0, -0.022}, Vec3::UnitY(), 0, 80 * degree)};
    } else if (set == "franka_fer") {
        scene = meshes("franka_fer/link3.obj", "franka_fer/link4_in_link3.obj");
        scene.motion.dofs = {turn({0.0825, 0, 0}, -Vec3::UnitY(), -3.0718, -0.0698)};
    } else {
        throw tss::InputError("no real pair of this name: " + set);
    }
    return scene;
}

} // namespace zone
