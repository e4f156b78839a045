#include "tests/extreme/scenes/Builders.h"

namespace extreme {

namespace {

/// The swing of 40 mm in a file whose unit is so many metres.
std::string inUnits(double metersPerUnit) {
    SceneModel scene = swing(0.001 / metersPerUnit);
    scene.metersPerUnit = metersPerUnit;
    return textOf(scene);
}

std::string placedFar() {
    SceneModel scene = swing();
    const tss::Pose far(Eigen::Translation3d(1e7, -1e7, 1e7));
    for (tss::Body& body : scene.bodies) body.placement = far * body.placement;
    return textOf(scene);
}

/// Both meshes and the joint 1e7 units from their own frames' origin, where floats are a unit apart.
std::string modelledFar() {
    const Vec3 far(1e7, -1e7, 1e7);
    Motion motion;
    motion.dofs = {turn(far + Vec3(250, 0, 0), {0, 0, 1}, -40, 90)};
    return textOf(pairScene(roughBall(far, 100, 2), roughBall(far + Vec3(0, 300, 0), 50, 2), motion, 4));
}

std::string sixOrders() {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, -2, 40)};
    // A ball of 1 km, a grain of 1 mm before it, and a grain and a ball that slide towards them.
    const TriangleMesh still = joined(roughBall({1000, 0, 0}, 1000, 3), roughBall({-0.002, 0, 0}, 0.001, 1));
    const TriangleMesh moving = joined(roughBall({-35, 0, 0}, 0.001, 1), roughBall({-60, 20, 0}, 15, 2));
    return textOf(pairScene(still, moving, motion, 0.0005));
}

/// A slide ten million times as long as the spheres are wide and more: no float tells where on it they are.
std::string longSlide(double way = 1e7) {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, -way, way)};
    return textOf(pairScene(roughBall({40000, 0, 0}, 0.5, 1), roughBall({0, 0.3, 0}, 0.5, 1), motion, 0.02));
}

} // namespace

std::vector<ExtremeScene> unitScenes() {
    const std::string lengths = "lengths whose squares are no floats";
    return {
        {"unit_micrometre", "units from 1e-6 to 1e6", "the table of the same pair in metres", Fate::Table, "",
         inUnits(1e-6)},
        {"unit_metre", "units from 1e-6 to 1e6", "the pair that the other units are compared with",
         Fate::Table, "", inUnits(1)},
        {"unit_megametre", "units from 1e-6 to 1e6", "the table of the same pair in metres", Fate::Table, "",
         inUnits(1e6)},
        {"unit_too_small", lengths, "refused", Fate::NotBakeable, "of a mesh between 1e-12 and",
         inUnits(1e17)},
        {"unit_too_large", lengths, "refused", Fate::NotBakeable, "of a mesh between 1e-12 and",
         inUnits(1e-22)},
        {"slide_too_long", lengths, "refused", Fate::NotBakeable, "of a motion between 1e-12 and",
         longSlide(1e20)},
        {"far_placed", "the pair 1e7 units from the origin", "the very table of the pair at the origin",
         Fate::Table, "", placedFar()},
        {"far_modelled", "the pair 1e7 units from the origin",
         "bounds that include the unit between two floats there", Fate::Table, "", modelledFar()},
        {"radii", "radii over six orders of magnitude",
         "the grain of a thousandth stops at the grain before the ball of a thousand", Fate::Table, "",
         sixOrders()},
        {"long_slide", "radii over six orders of magnitude",
         "a scene that needs double gets double by itself", Fate::Table, "", longSlide()},
    };
}

} // namespace extreme
