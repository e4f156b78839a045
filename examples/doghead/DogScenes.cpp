#include "examples/doghead/DogScenes.h"

#include "bake/model/AddPair.h"
#include "examples/doghead/DogMeshes.h"
#include "examples/doghead/anatomy/Anatomy.h"
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

using Knots = std::vector<Profile::Knot>;

/// Samples of a smooth curve through the knots, every `step` time codes, times `unit`.
tss::TimeSamples sampled(const Knots& knots, int step, double unit) {
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

/// Nose, eyes and irises: there to be looked at.
void addNoseAndEyes(tss::SceneModel& scene) {
    addBody(scene, "Nose", nosePadMesh({0.8, 0.15}), black);
    addBody(scene, "Eyes", eyesMesh(), eyeWhite);
    addBody(scene, "Irises", irisesMesh(), amber);
}

/// A joint that both bodies hang on, with its pair.
void addJoint(tss::SceneModel& scene, int a, int b, const tss::Motion& motion, const std::string& name,
              const std::string& tolerance) {
    scene.bodies[a].rigid = scene.bodies[b].rigid = true;
    scene.pairs[addPair(scene, a, b, motion, name)].settings["tolerance"] = tolerance;
}

/// A muscle prim over a body; returns its index.
int addMuscle(tss::SceneModel& scene, const std::string& name, int body, std::vector<Vec3> fibre, int bone) {
    tss::MuscleModel model;
    model.path = "/" + scene.defaultPrim + "/" + name;
    model.body = body;
    model.bone = bone;
    model.muscle.surface = scene.bodies[model.body].mesh;
    model.muscle.fibre = std::move(fibre);
    scene.muscles.push_back(std::move(model));
    return static_cast<int>(scene.muscles.size()) - 1;
}

int addStrap(tss::SceneModel& scene, const Strap& strap, const std::string& side, int bone) {
    const int body = addBody(scene, strap.name + side + "Surface", bodyMesh(strap.field), flesh);
    const int index = addMuscle(scene, strap.name + side, body, strap.fibre, bone);
    scene.muscles[index].muscle.maxContraction = strap.contraction;
    return index;
}

int addFrontalis(tss::SceneModel& scene, int bone) {
    const int body = addBody(scene, "FrontalisSurface", frontalisMesh({0.8, 0.12}), flesh);
    const int index = addMuscle(scene, "Frontalis", body, frontalisFibre(), bone);
    scene.muscles[index].muscle.form = tss::MuscleForm::Sheet;
    scene.muscles[index].muscle.maxContraction = 0.25;
    return index;
}

/// A bone under the skin: a muscle that does not contract and carries the skin firmly.
void addUnder(tss::SceneModel& scene, const std::string& name, int body, int bone) {
    const Eigen::AlignedBox3d box = bounds(scene.bodies[body].mesh);
    const int index = addMuscle(scene, name, body, {box.min(), box.max()}, bone);
    scene.muscles[index].muscle.activationUpper = 0;
}

struct SkullAndJaw {
    int skull = 0, mandible = 0;
};

/// The mouth closed, the teeth just clear of each other, on a hinge that lets them bite.
SkullAndJaw addSkullAndJaw(tss::SceneModel& scene) {
    const int skull = addBody(scene, "Skull", skullMesh(), ivory);
    TriangleMesh apart = mandibleMesh();
    for (Vec3& v : apart.vertices) v = Eigen::AngleAxisd(1.5 * degree, Vec3::UnitY()) * v;
    const int mandible = addBody(scene, "Mandible", std::move(apart), paleBone);
    tss::Dof open;
    open.name = "open";
    open.axis = Vec3::UnitY();
    open.lower = -4 * degree;
    open.upper = 20 * degree;
    tss::Motion motion;
    motion.dofs = {open};
    addJoint(scene, skull, mandible, motion, "Jaw", "0.1mm");
    return {skull, mandible};
}

/// The stiff shell of an ear on its hinge; side: 1 left, -1 right. Returns the body.
int addEar(tss::SceneModel& scene, int skull, int side) {
    TriangleMesh shell = earCartilageMesh();
    tss::Motion motion = earMotion();
    if (side < 0) {
        for (Vec3& v : shell.vertices) v.y() = -v.y();
        for (tss::Tri& t : shell.triangles) std::swap(t[1], t[2]);
        motion.dofs[0].origin.y() *= -1; // a turn about the left-right axis is its own mirror image
    }
    const std::string name = side > 0 ? "EarL" : "EarR";
    const int ear = addBody(scene, name + "Cartilage", std::move(shell), paleBone);
    addJoint(scene, skull, ear, motion, name, "0.4mm");
    return ear;
}

void addSkin(tss::SceneModel& scene, TriangleMesh mesh) {
    tss::SkinModel skin;
    skin.body = addBody(scene, "Skin", std::move(mesh), fur);
    scene.bodies[skin.body].doubleSided = true;
    skin.path = scene.bodies[skin.body].path;
    for (std::size_t m = 0; m < scene.muscles.size(); ++m) skin.muscles.push_back(static_cast<int>(m));
    scene.skins.push_back(std::move(skin));
}

/// Free over and around a body, held to the bone farther away.
void tetherBeyond(tss::SceneModel& scene, const Field& body, double from, double to) {
    for (const Vec3& v : scene.bodies[scene.skins[0].body].mesh.vertices)
        scene.skins[0].tether.push_back(std::round(1000 * smoothStep(from, to, body(v))) / 1000);
}

/// Tightens from `from` to a full activation in the middle, and lets go until `to`.
tss::TimeSamples twitch(double from, double to, double last, double most = 1) {
    const double part = (to - from) / 3;
    Knots knots{{from, 0}, {from + part, most}, {to - part, most}, {to, 0}};
    if (from > 0) knots.insert(knots.begin(), {0, 0});
    if (to < last) knots.push_back({last, 0});
    return sampled(knots, 2, 1);
}

} // namespace

tss::SceneModel jawScene() {
    tss::SceneModel scene = emptyScene("DogJaw", 96);
    const int skull = addBody(scene, "Skull", skullMesh(), ivory);
    const int mandible = addBody(scene, "Mandible", mandibleMesh(), paleBone);
    // The tolerance leaves the condyles most of their clearance.
    addJoint(scene, skull, mandible, jawMotion(), "Jaw", "0.1mm");

    // Degrees. The bites ask for 3 degrees beyond closed and grind to one side and then to the other.
    const Knots lateral{{0, 0},     {20, 0},  {26, 0},    {32, 3.6},  {38, 2.4}, {46, 0},
                        {56, -1.5}, {62, -2}, {68, -3.8}, {76, -1.5}, {84, 0},   {96, 0}};
    const Knots open{{0, 16}, {12, 30}, {24, -3}, {34, -3}, {46, 26}, {60, -3}, {70, -3}, {82, 22}, {96, 16}};
    scene.joints.front().drives = {sampled(lateral, 2, degree), sampled(open, 2, degree)};
    return scene;
}

tss::SceneModel frontalisScene() {
    tss::SceneModel scene = emptyScene("DogFrontalis", 72);
    const int skull = addBody(scene, "Skull", skullMesh(), ivory);
    const int mandible = addBody(scene, "Mandible", mandibleMesh(), paleBone);
    scene.bodies[mandible].placement.rotate(
        Eigen::AngleAxisd(1.5 * degree, Vec3::UnitY())); // teeth just apart
    const int muscle = addFrontalis(scene, skull);
    scene.muscles[muscle].activation = sampled({{0, 0}, {8, 0}, {32, 1}, {44, 1}, {66, 0}, {72, 0}}, 2, 1);
    addSkin(scene, leftSkinMesh());
    addNoseAndEyes(scene);
    tetherBeyond(scene, frontalis(), 5, 24); // ears, eyes, cheeks and muzzle stay
    return scene;
}

tss::SceneModel faceScene(const Detail& skin) {
    constexpr double each = 20, last = 140;
    tss::SceneModel scene = emptyScene("DogFace", last);
    const int frontalis = addFrontalis(scene, -1);
    scene.muscles[frontalis].activation = twitch(0, each, last);
    double from = each;
    for (const Strap& left : faceStraps()) {
        for (const auto& [strap, side] : {std::pair(left, "L"), std::pair(mirroredStrap(left), "R")})
            scene.muscles[addStrap(scene, strap, side, -1)].activation = twitch(from, from + each, last);
        from += each;
    }
    addSkin(scene, skinMesh(skin));
    addNoseAndEyes(scene);
    return scene;
}

tss::SceneModel earsScene() {
    tss::SceneModel scene = emptyScene("DogEars", 72);
    const int skull = addBody(scene, "Skull", skullMesh({1, 0.3}), ivory);
    const int ear = addBody(scene, "EarCartilage", earCartilageMesh(), paleBone);
    addJoint(scene, skull, ear, earMotion(), "Ear", "0.4mm");
    scene.joints.front().drives = {sampled(
        {{0, 0}, {10, 0}, {28, 80}, {36, 80}, {52, 0}, {56, 0}, {60, 18}, {64, 0}, {72, 0}}, 2, degree)};
    addUnder(scene, "EarShell", ear, ear);
    addUnder(scene, "SkullUnder", skull, -1);
    addSkin(scene, leftSkinMesh({1.4, 0.35}));
    addNoseAndEyes(scene);
    tetherBeyond(scene, earCartilage(), 12, 50);
    return scene;
}

tss::SceneModel lipsScene() {
    tss::SceneModel scene = emptyScene("DogLips", 64);
    const SkullAndJaw bones = addSkullAndJaw(scene);
    scene.joints.front().drives = {
        sampled({{0, 0}, {6, 0}, {22, 16}, {32, 16}, {44, -3}, {52, -3}, {58, 0}, {64, 0}}, 2, degree)};
    addSkin(scene, leftSkinMouthCutMesh());
    scene.skins[0].bones = {bones.skull, bones.mandible};
    scene.skins[0].selfContact = true; // lip against lip
    addNoseAndEyes(scene);
    return scene;
}

tss::SceneModel headScene() {
    // Calm, alert from 12, a growl from 36, a bite from 72, the ears laid back from 108, calm again.
    constexpr double last = 144;
    tss::SceneModel scene = emptyScene("DogHead", last);
    const SkullAndJaw bones = addSkullAndJaw(scene);
    const int left = addEar(scene, bones.skull, 1), right = addEar(scene, bones.skull, -1);
    const auto drive = [&](std::size_t joint, const Knots& knots) {
        scene.joints[joint].drives = {sampled(knots, 2, degree)};
    };
    drive(0,
          {{0, 0}, {36, 0}, {46, 4}, {68, 4}, {78, 17}, {86, 17}, {92, -3}, {100, -3}, {108, 0}, {last, 0}});
    const Knots back{{0, 0},    {12, 0},   {36, 0},   {48, 35},  {70, 40}, {84, 55},
                     {102, 55}, {112, 30}, {122, 70}, {132, 70}, {last, 0}};
    drive(1, back);
    drive(2, back);

    const Knots brow{{0, 0},   {12, 0},    {20, 1},    {34, 0.9}, {42, 0.1},
                     {108, 0}, {116, 0.6}, {130, 0.5}, {last, 0}};
    const Knots snarl{{0, 0}, {36, 0}, {46, 1}, {68, 0.9}, {78, 0.5}, {100, 0.6}, {110, 0}, {last, 0}};
    const Knots bite{{0, 0}, {36, 0}, {46, 0.3}, {78, 0.1}, {92, 1}, {100, 1}, {110, 0}, {last, 0}};
    const Knots squint{{0, 0}, {40, 0}, {50, 0.6}, {100, 0.6}, {114, 0.8}, {130, 0.8}, {last, 0}};
    scene.muscles[addFrontalis(scene, bones.skull)].activation = sampled(brow, 2, 1);
    for (const Strap& strap : faceStraps()) {
        const bool chews = strap.name == "Masseter" || strap.name == "Temporalis";
        const Knots& knots = chews ? bite : strap.name == "RetractorAnguliOculi" ? squint : snarl;
        for (const auto& [own, side] : {std::pair(strap, "L"), std::pair(mirroredStrap(strap), "R")}) {
            tss::MuscleModel& muscle = scene.muscles[addStrap(scene, own, side, bones.skull)];
            muscle.activation = sampled(knots, 2, 1);
            if (chews) muscle.insertionBone = bones.mandible;
            muscle.muscle.spans = chews;
        }
    }
    addSkin(scene, skinMouthCutMesh({1, 0.4}));
    scene.skins[0].bones = {bones.skull, bones.mandible, left, right};
    scene.skins[0].selfContact = true; // lip against lip
    addNoseAndEyes(scene);
    return scene;
}

} // namespace doghead
