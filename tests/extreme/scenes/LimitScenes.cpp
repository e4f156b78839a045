#include "tests/extreme/scenes/Builders.h"

#include "tests/Shapes.h"

namespace extreme {

namespace {

/// Nothing to move at all: one pose, in which the bodies overlap.
std::string noMotion() {
    Motion motion;
    motion.dofs = {turn({25, 0, 0}, {0, 0, 1}, 0, 0)};
    SceneModel scene = pairScene(roughBall(Vec3::Zero(), 10, 2), roughBall({0, 14, 0}, 5, 2), motion, 0.4);
    scene.pairs[0].settings["at-rest"] = "collide";
    return textOf(scene);
}

/// A turn of zero width between two others that do move.
std::string zeroWidthAmong() {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, -2, 2), turn({25, 0, 0}, {0, 1, 0}, 0, 0),
                   turn({25, 0, 0}, {0, 0, 1}, -40, 60)};
    return textOf(pairScene(roughBall(Vec3::Zero(), 10, 2), roughBall({0, 30, 0}, 5, 2), motion, 0.4));
}

std::string slideScene() {
    Motion motion;
    motion.dofs = {slide({2, 0, 0}, -10, 10)};
    return textOf(pairScene(boxMesh({-1, -1, -1}, {1, 1, 1}), roughBall({10, 0, 0}, 3, 1), motion, 0.2));
}

} // namespace

std::vector<ExtremeScene> limitScenes() {
    const std::string asked = "limits of zero width, of ±360°, reversed, infinite";
    const std::string hingeText = textOf(hinge()), slideText = slideScene();
    return {
        {"limit_zero_width", asked, "one pose: the table says contact there", Fate::Table, "", noMotion()},
        {"limit_zero_width_apart", asked, "one pose: proven apart", Fate::NeverMeet, "", textOf(hinge(0, 0))},
        {"limit_zero_width_among", asked, "served as the joint without the fixed DOF", Fate::Table, "",
         zeroWidthAmong()},
        {"limit_360", asked, "q and q ± 360° have the same verdict", Fate::Table, "",
         textOf(hinge(-360, 360))},
        {"limit_reversed", asked, "refused", Fate::NotReadable, "expected at least the lower limit",
         edited(edited(hingeText, "\"default\": -40", "\"default\": 95"), "\"default\": 90}",
                "\"default\": -45}")},
        {"limit_infinite", asked, "refused", Fate::NotReadable,
         "expected a lower and an upper limit for each DOF of a pair",
         edited(hingeText, "\"default\": 90}", "\"default\": \"inf\"}")},
        {"axis_zero", "axes of length 0", "refused", Fate::NotReadable, "tss:dofScale",
         edited(slideText, "\"default\": [2]", "\"default\": [0]")},
        {"axis_quaternion_zero", "axes of length 0", "refused", Fate::NotReadable, "localRot",
         edited(hingeText, "\"physics:localPos0\"",
                "\"physics:localRot0\": {\"typeName\": \"quatf\", \"default\": [0,0,0,0]}, "
                "\"physics:localPos0\"")},
    };
}

} // namespace extreme
