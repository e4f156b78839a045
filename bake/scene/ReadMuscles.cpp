#include "bake/base/Error.h"
#include "bake/motion/MuscleRing.h"
#include "bake/scene/SceneReading.h"

#include <algorithm>

namespace tss {

namespace {

int readSurface(const SceneReading& reading, const PrimReader& prim) {
    const std::string path = prim.target(schema::surface);
    const int body = reading.body(prim, schema::surface, path);
    if (path.empty())
        prim.problem("expected a relationship tss:surface that names the muscle's mesh");
    else if (body >= 0 && reading.scene.bodies[body].mesh.empty())
        reading.problems.add(prim.placeOf(schema::surface, "targetPaths"),
                             "expected a mesh with faces, found \"" + path + "\"");
    return body;
}

MuscleForm readForm(const PrimReader& prim) {
    const std::string form = prim.choice(schema::form, {"tube", "sheet", "ring"});
    return form == "ring" ? MuscleForm::Ring : form == "sheet" ? MuscleForm::Sheet : MuscleForm::Tube;
}

std::vector<Vec3> readLine(const PrimReader& prim) {
    for (const Attribute& end : {schema::origin, schema::insertion})
        if (!prim.value(end)) prim.problem(std::string("expected the attribute ") + end.name + " (point3f)");
    std::vector<Vec3> fibre{prim.vector(schema::origin, Vec3::Zero())};
    for (const Vec3& point : prim.vectors(schema::fibre)) fibre.push_back(point);
    fibre.push_back(prim.vector(schema::insertion, Vec3::UnitX()));
    if (fibre.front() == fibre.back())
        prim.problem(schema::insertion, "expected another point than tss:origin");
    return fibre;
}

/// A ring's line is closed and has no ends.
std::vector<Vec3> readRing(const PrimReader& prim) {
    for (const Attribute& end : {schema::origin, schema::insertion})
        if (prim.value(end)) prim.problem(end, "expected none: a ring of muscle has no ends");
    std::vector<Vec3> fibre;
    for (const Vec3& point : prim.vectors(schema::fibre)) fibre.push_back(point);
    try {
        MuscleRing{fibre};
    } catch (const InputError& e) {
        prim.problem(schema::fibre, std::string("expected the ring's line, once round: ") + e.what());
        fibre = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX() - Vec3::UnitY()};
    }
    return fibre;
}

/// One bone, or one at either end.
void readBonesOf(const SceneReading& reading, const PrimReader& prim, MuscleModel& model) {
    const std::string one = prim.target(schema::bone), origin = prim.target(schema::originBone),
                      insertion = prim.target(schema::insertionBone);
    if (!one.empty() && !(origin.empty() && insertion.empty()))
        prim.problem("expected either tss:bone or tss:originBone and tss:insertionBone, found both");
    const char* name = one.empty() ? schema::originBone : schema::bone;
    model.bone = reading.body(prim, name, one.empty() ? origin : one);
    model.insertionBone = reading.body(prim, schema::insertionBone, insertion);
    if (model.insertionBone == model.bone) model.insertionBone = -1;
    model.muscle.spans = model.insertionBone >= 0;
}

MuscleModel readMuscle(const SceneReading& reading, const PrimReader& prim) {
    MuscleModel model;
    model.path = prim.place().path;
    model.body = readSurface(reading, prim);
    readBonesOf(reading, prim, model);
    Muscle& muscle = model.muscle;
    if (model.body >= 0) muscle.surface = reading.scene.bodies[model.body].mesh;
    muscle.form = readForm(prim);
    muscle.fibre = muscle.form == MuscleForm::Ring ? readRing(prim) : readLine(prim);
    if (model.body >= 0 && reading.bodyXforms[model.body].stretched)
        for (Vec3& point : muscle.fibre) point = reading.bodyXforms[model.body].stretch * point;
    muscle.anchor = prim.real(schema::anchor, muscle.anchor, {0, 1});
    muscle.maxContraction = prim.real(schema::maxContraction, muscle.maxContraction, {0, 1});
    const auto range = prim.reals(schema::activationRange, 2);
    if (range.size() == 2 && range[0] > range[1])
        prim.problem(schema::activationRange, "expected the lower activation first");
    else if (range.size() == 2) {
        muscle.activationLower = range[0];
        muscle.activationUpper = range[1];
    }
    model.activation = prim.samples(schema::activation);
    return model;
}

/// One number from 0 to 1 a vertex, or none.
std::vector<double> readWeights(const PrimReader& prim, const Attribute& attribute, std::size_t vertices) {
    return prim.reals(attribute, vertices, Range{0, 1});
}

/// The bodies that a skin lies on: any mesh but its own.
void readBones(const SceneReading& reading, const PrimReader& prim, SkinModel& skin) {
    for (const std::string& path : prim.targets(schema::bones)) {
        const int bone = reading.body(prim, schema::bones, path);
        if (bone < 0) continue;
        const bool again = std::find(skin.bones.begin(), skin.bones.end(), bone) != skin.bones.end();
        const char* wanted = bone == skin.body                         ? "another body than the skin"
                             : reading.scene.bodies[bone].mesh.empty() ? "a mesh with faces"
                             : again                                   ? "each bone once"
                                                                       : nullptr;
        if (wanted)
            reading.problems.add(prim.placeOf(schema::bones, "targetPaths"),
                                 std::string("expected ") + wanted + ", found \"" + path + "\"");
        else
            skin.bones.push_back(bone);
    }
}

} // namespace

void readMuscles(SceneReading& reading) {
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        if (reading.index.entries[i].prim->typeName != "TssMuscle") continue;
        MuscleModel model = readMuscle(reading, reading.reader(static_cast<int>(i)));
        if (model.body < 0) continue;
        reading.muscleAt[model.path] = static_cast<int>(reading.scene.muscles.size());
        reading.scene.muscles.push_back(std::move(model));
    }
}

void readSkins(SceneReading& reading) {
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        if (!hasApi(*reading.index.entries[i].prim, "TssSkinAPI")) continue;
        if (!reading.ownPrim(static_cast<int>(i), "TssSkinAPI")) continue;
        const PrimReader prim = reading.reader(static_cast<int>(i));
        SkinModel skin;
        skin.path = prim.place().path;
        if (prim.prim().typeName != "Mesh" || !reading.bodyAt.contains(skin.path)) {
            prim.problem("expected TssSkinAPI on a Mesh, found it on \"" + prim.prim().typeName + "\"");
            continue;
        }
        skin.body = reading.bodyAt.at(skin.path);
        for (const std::string& path : prim.targets(schema::muscles)) {
            const auto found = reading.muscleAt.find(path);
            if (found != reading.muscleAt.end())
                skin.muscles.push_back(found->second);
            else
                reading.problems.add(prim.placeOf(schema::muscles, "targetPaths"),
                                     "expected the path of a TssMuscle, found \"" + path + "\"");
        }
        readBones(reading, prim, skin);
        constexpr Range positive{0};
        skin.thickness = prim.real(schema::thickness, 0, positive);
        skin.travel = prim.real(schema::travel, 0, positive);
        skin.stretchCompliance = prim.real(schema::stretchCompliance, 0, positive);
        skin.bendCompliance = prim.real(schema::bendCompliance, 0, positive);
        skin.selfContact = prim.flag(schema::selfContact, false);
        const std::size_t vertices = reading.scene.bodies[skin.body].mesh.vertices.size();
        skin.tether = readWeights(prim, schema::tether, vertices);
        skin.attach = readWeights(prim, schema::attach, vertices);
        skin.weights = readSkinWeights(reading, prim, vertices);
        skin.settings = readSettings(prim);
        reading.scene.skins.push_back(std::move(skin));
    }
}

} // namespace tss
