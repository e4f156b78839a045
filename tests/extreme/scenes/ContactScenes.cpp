#include "tests/extreme/scenes/Builders.h"

#include "tests/Shapes.h"

namespace extreme {

namespace {

/// A ball that slides through the middle of another one; `radius` of the moving one.
std::string concentric(double radius, const char* atRest) {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, -20, 20)};
    SceneModel scene =
        pairScene(roughBall(Vec3::Zero(), 10, 2), roughBall(Vec3::Zero(), radius, 2), motion, 0.4);
    scene.pairs[0].settings["at-rest"] = atRest;
    return textOf(scene);
}

/// A cube that slides along the face of another one, exactly on it.
std::string faces(const char* atRest) {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, -3, 3)};
    SceneModel scene =
        pairScene(boxMesh({-1, -1, -1}, {1, 1, 1}), boxMesh({-1, 1, -1}, {1, 3, 1}), motion, 0.05);
    scene.pairs[0].settings["at-rest"] = atRest;
    return textOf(scene);
}

/// A ball whose centre passes at exactly the sum of the radii: it touches at one pose.
std::string tangent() {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, 0, 60)};
    return textOf(pairScene(ballMesh({30, 0, 0}, 10, 2), ballMesh({0, 15, 0}, 5, 2), motion, 0.1));
}

/// Corner on corner: two cubes that meet in one point only.
std::string corners() {
    Motion motion;
    motion.dofs = {turn({1, 1, 1}, {1, -1, 0}, -20, 20)};
    SceneModel scene =
        pairScene(boxMesh({-1, -1, -1}, {1, 1, 1}), boxMesh({1, 1, 1}, {3, 3, 3}), motion, 0.05);
    scene.pairs[0].settings["at-rest"] = "collide";
    return textOf(scene);
}

/// A ball that a thin wall stands in the way of.
std::string wall(double start) {
    Motion motion;
    motion.dofs = {slide({1, 0, 0}, -50, 50)};
    motion.dofs[0].rest = start;
    SceneModel scene =
        pairScene(boxMesh({-0.25, -12, -12}, {0.25, 12, 12}), roughBall(Vec3::Zero(), 5, 2), motion, 0.2);
    scene.pairs[0].settings["at-rest"] = "collide";
    scene.joints[0].drives[0] = {{0, 1, 2}, {start, 50, -50}};
    scene.endTimeCode = 2;
    return textOf(scene);
}

} // namespace

std::vector<ExtremeScene> contactScenes() {
    return {
        {"concentric", "concentric spheres",
         "finite gaps and unit normals where two centres coincide; led out, and never in again", Fate::Table,
         "", concentric(4, "collide")},
        {"concentric_equal", "concentric spheres",
         "equal meshes on each other at rest: out of the overlap and never back into it", Fate::Table, "",
         concentric(10, "collide")},
        {"touch_faces", "exact touch",
         "free at rest, and slides on: it goes no deeper than there", Fate::Table, "",
         faces("offset")},
        {"touch_faces_collide", "exact touch", "faces exactly on each other are in contact all the way",
         Fate::Table, "", faces("collide")},
        {"touch_corner", "exact touch", "two corners in one point are in contact", Fate::Table, "",
         corners()},
        {"tangent", "tangency", "contact where the balls touch in one point, none 1 away from it",
         Fate::Table, "", tangent()},
        {"to_and_fro", "1e6 DOF steps to and fro over a contact", "every round is the first one, bit for bit",
         Fate::Table, "", textOf(swing())},
        {"jump", "a jump across the whole obstacle in one step", "stopped before the wall, from either side",
         Fate::Table, "", wall(-50)},
        {"start_deep", "start deep inside", "led out of the wall in some steps, and then never into it again",
         Fate::Table, "", wall(0)},
    };
}

} // namespace extreme
