#pragma once
#include "bake/model/AddPair.h"
#include "bake/report/Report.h"
#include "tests/Shapes.h"

#include <filesystem>
#include <unistd.h>

namespace tss::reporting {

/// A ball on an arm that turns down to a ball on a base, and slides a little.
inline SceneModel armScene(double lowest) {
    SceneModel scene;
    scene.defaultPrim = "Arm";
    scene.metersPerUnit = 0.01;
    const auto body = [&](const std::string& name, const TriangleMesh& mesh) {
        Body part;
        part.path = "/Arm/" + name;
        part.mesh = mesh;
        part.rigid = true;
        scene.bodies.push_back(part);
    };
    body("Base", ballMesh({3, 0, -1}, 0.8, 3));
    body("Lever", ballMesh({3, 0, 0.9}, 0.7, 3));
    Motion motion;
    Dof turn;
    turn.name = "turn";
    turn.axis = Vec3::UnitY();
    turn.lower = -0.2;
    turn.upper = lowest;
    Dof slide;
    slide.name = "slide";
    slide.kind = DofKind::Translation;
    slide.axis = Vec3::UnitY();
    slide.lower = -0.5;
    slide.upper = 0.5;
    motion.dofs = {slide, turn};
    addPair(scene, 0, 1, motion, "Hinge");
    scene.pairs[0].settings["tolerance"] = "0.1";
    return scene;
}

/// Removed with the object.
struct OutFolder {
    std::string path =
        (std::filesystem::temp_directory_path() / ("tss-report-" + std::to_string(getpid()))).string();
    ~OutFolder() { std::filesystem::remove_all(path); }
};

inline ReportOptions quickOptions() {
    ReportOptions options;
    options.quick = true;
    options.methods = {"tss", "fcl-obbrss", "tree-all", "gap-grid", "angular-region"};
    return options;
}

} // namespace tss::reporting
