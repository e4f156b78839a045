#pragma once
#include "bake/model/AddPair.h"
#include "bake/model/SceneModel.h"
#include "bake/scene/SceneLayer.h"

/// Small scenes that several tests of the scene folder start from.
namespace samples {

inline tss::TriangleMesh tetrahedron() {
    tss::TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

inline int addBody(tss::SceneModel& scene, const std::string& name) {
    tss::Body body;
    body.path = "/Scene/" + name;
    body.mesh = tetrahedron();
    scene.bodies.push_back(body);
    return static_cast<int>(scene.bodies.size()) - 1;
}

/// Opens about an axis off the origin and slides along it, in units of 2 mm.
inline tss::Motion jawMotion() {
    tss::Motion motion;
    tss::Dof open, lateral;
    open.name = "open";
    open.origin = {0.3, 0, 0.7};
    open.axis = tss::Vec3::UnitY();
    open.lower = -0.3;
    open.upper = 0.4;
    lateral.name = "lateral";
    lateral.kind = tss::DofKind::Translation;
    lateral.axis = {0, 0.002, 0};
    lateral.lower = -1;
    lateral.upper = 1;
    motion.dofs = {open, lateral};
    return motion;
}

inline tss::SceneModel jaw() {
    tss::SceneModel scene;
    addBody(scene, "A");
    addBody(scene, "B");
    addPair(scene, 0, 1, jawMotion(), "Jaw");
    return scene;
}

/// A skin over one muscle that rides on a bone.
inline tss::SceneModel brow() {
    tss::SceneModel scene;
    addBody(scene, "Skin");
    addBody(scene, "Surface");
    addBody(scene, "Bone");
    tss::MuscleModel muscle;
    muscle.path = "/Scene/Frontalis";
    muscle.body = 1;
    muscle.bone = 2;
    muscle.muscle.surface = tetrahedron();
    muscle.muscle.fibre = {{0, 0, 0}, {0.5, 0.25, 0}, {1, 0, 0}};
    muscle.muscle.form = tss::MuscleForm::Sheet;
    muscle.muscle.maxContraction = 0.3;
    muscle.activation = {{0, 24}, {0, 1}};
    scene.muscles.push_back(muscle);
    tss::SkinModel skin;
    skin.path = "/Scene/Skin";
    skin.body = 0;
    skin.muscles = {0};
    skin.thickness = 0.5;
    skin.tether = {0, 0.25, 0.5, 1};
    skin.settings["tolerance"] = "0.2mm";
    skin.selfContact = true;
    scene.skins.push_back(skin);
    return scene;
}

/// As it is when it comes from a file, rounded to float where files hold floats.
inline tss::SceneModel fromFile(const tss::SceneModel& scene) {
    return readScene(toLayer(scene), "test.tss");
}

inline tss::Table smallTable(const tss::Motion& motion) {
    tss::Table table;
    table.a = {{tss::Vec3(0.5, 0.25, 0), 0.125}, {tss::Vec3(1, 0, 0), 1}};
    table.b = {{tss::Vec3(0.5, 0, 0), 0.5}};
    table.rowOffsets = {0, 1, 2};
    table.columns = {0, 0};
    table.restGaps = {0, -0.1};
    table.restRegion = {{{0, 2}, {2, 1}}, {{1, 5}}, 0.1};
    table.motion = motion;
    table.record.spheresA = table.record.spheresB = 9;
    return table;
}

/// A good scene with one of everything: a jaw of two DOFs with a table, a hinge, a pair over both, a brow
/// with a table.
inline tss::SceneModel everything() {
    tss::SceneModel scene = jaw();
    const tss::SceneModel other = brow();
    for (const tss::Body& body : other.bodies) scene.bodies.push_back(body);
    scene.muscles = other.muscles;
    scene.muscles[0].body += 2;
    scene.muscles[0].bone += 2;
    scene.skins = other.skins;
    scene.skins[0].body += 2;
    tss::Motion hinge;
    hinge.dofs.resize(1);
    hinge.dofs[0].upper = 1;
    scene.pairs.resize(addPair(scene, 1, 4, hinge, "Hinge")); // the joint without its pair
    scene.joints[1].drives[0] = {{0, 24}, {0, 0.5}};
    scene.endTimeCode = 24;
    tss::Pair ends;
    ends.path = "/Scene/Ends";
    ends.bodyA = 0;
    ends.bodyB = 4;
    ends.joints = {0, 1};
    scene.pairs.push_back(ends);
    scene = fromFile(scene);
    scene.pairs[0].table = std::make_shared<tss::Table>(smallTable(pairMotion(scene, scene.pairs[0])));
    scene.pairs[1].proof = std::make_shared<tss::NeverCollides>();
    tss::SkinTable skin;
    skin.table = smallTable({});
    skin.table.restRegion = {};
    skin.skinVertices = {0, 3};
    skin.muscleOf = {0};
    scene.skins[0].table = std::make_shared<tss::SkinTable>(skin);
    return scene;
}

} // namespace samples
