#include "examples/doghead/DogScenes.h"

#include "bake/scene/AddPair.h"
#include "examples/doghead/DogMeshes.h"
#include "examples/doghead/anatomy/Frontalis.h"
#include "examples/doghead/implicit/Curve.h"

#include <algorithm>
#include <cmath>

namespace doghead {
namespace {

constexpr double degree = M_PI / 180;

// Linear RGB.
const Vec3 ivory(0.80, 0.72, 0.55), paleBone(0.74, 0.64, 0.46), flesh(0.42, 0.045, 0.035),
    fur(0.36, 0.20, 0.09), black(0.02, 0.018, 0.018), eyeWhite(0.80, 0.76, 0.70), amber(0.16, 0.06, 0.015);

tss::SceneModel emptyScene(const std::string& name, double lastCode) {
    tss::SceneModel scene;
    scene.defaultPrim = name;
    scene.metersPerUnit = 0.001;
    scene.endTimeCode = lastCode;
    return scene;
}

int addBody(tss::SceneModel& scene, const std::string& name, TriangleMesh mesh, const Vec3& colour) {
    tss::Body body;
    body.path = "/" + scene.defaultPrim + "/" + name;
    body.mesh = std::move(mesh);
    body.displayColor = colour;
    scene.bodies.push_back(std::move(body));
    return static_cast<int>(scene.bodies.size()) - 1;
}

/// Samples of a smooth curve through the knots, every `step` time codes, times `unit`.
tss::TimeSamples sampled(const std::vector<Profile::Knot>& knots, int step, double unit) {
    const Profile profile(knots);
    tss::TimeSamples samples;
    for (int t = int(knots.front().at); t <= int(knots.back().at); t += step) {
        samples.times.push_back(t);
        samples.values.push_back(profile(t) * unit);
    }
    return samples;
}

double smoothStep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0., 1.);
    return t * t * (3 - 2 * t);
}

} // namespace

tss::SceneModel jawScene() {
    tss::SceneModel scene = emptyScene("DogJaw", 96);
    const int skull = addBody(scene, "Skull", skullMesh(), ivory);
    const int mandible = addBody(scene, "Mandible", mandibleMesh(), paleBone);
    scene.bodies[skull].rigid = scene.bodies[mandible].rigid = true;
    const int jaw = addPair(scene, skull, mandible, jawMotion(), "Jaw");
    scene.pairs[jaw].settings["tolerance"] = "0.1mm"; // leaves the condyles most of their clearance

    // Degrees. The bites ask for 3 degrees beyond closed and grind to one side and then to the other.
    const tss::TimeSamples lateral = sampled({{0, 0},
                                              {20, 0},
                                              {26, 0},
                                              {32, 3.6},
                                              {38, 2.4},
                                              {46, 0},
                                              {56, -1.5},
                                              {62, -2},
                                              {68, -3.8},
                                              {76, -1.5},
                                              {84, 0},
                                              {96, 0}},
                                             2, degree);
    const tss::TimeSamples open = sampled(
        {{0, 16}, {12, 30}, {24, -3}, {34, -3}, {46, 26}, {60, -3}, {70, -3}, {82, 22}, {96, 16}}, 2, degree);
    scene.joints.front().drives = {lateral, open};
    return scene;
}

tss::SceneModel frontalisScene() {
    tss::SceneModel scene = emptyScene("DogFrontalis", 72);
    const int skull = addBody(scene, "Skull", skullMesh(), ivory);
    const int mandible = addBody(scene, "Mandible", mandibleMesh(), paleBone);
    scene.bodies[mandible].placement.rotate(
        Eigen::AngleAxisd(1.5 * degree, Vec3::UnitY())); // teeth just apart
    const int muscle = addBody(scene, "FrontalisSurface", frontalisMesh({0.8, 0.12}), flesh);
    const int skin = addBody(scene, "Skin", leftSkinMesh(), fur);
    scene.bodies[skin].doubleSided = true;
    addBody(scene, "Nose", nosePadMesh({0.8, 0.15}), black);
    addBody(scene, "Eyes", eyesMesh(), eyeWhite);
    addBody(scene, "Irises", irisesMesh(), amber);

    tss::MuscleModel frontalisModel;
    frontalisModel.path = "/DogFrontalis/Frontalis";
    frontalisModel.body = muscle;
    frontalisModel.bone = skull;
    frontalisModel.muscle.surface = scene.bodies[muscle].mesh;
    frontalisModel.muscle.fibre = frontalisFibre();
    frontalisModel.muscle.form = tss::MuscleForm::Sheet;
    frontalisModel.muscle.maxContraction = 0.25;
    frontalisModel.activation = sampled({{0, 0}, {8, 0}, {32, 1}, {44, 1}, {66, 0}, {72, 0}}, 2, 1);
    scene.muscles.push_back(frontalisModel);

    tss::SkinModel skinModel;
    skinModel.path = scene.bodies[skin].path;
    skinModel.body = skin;
    skinModel.muscles = {0};
    // Free over and around the muscle, held to the bone towards ears, eyes, cheeks and muzzle.
    const Field field = frontalis();
    for (const Vec3& v : scene.bodies[skin].mesh.vertices)
        skinModel.tether.push_back(std::round(1000 * smoothStep(5, 24, field(v))) / 1000);
    scene.skins.push_back(skinModel);
    return scene;
}

} // namespace doghead
