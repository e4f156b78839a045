#include "bake/scene/ToLayer.h"

#include "bake/scene/SceneWriting.h"
#include "bake/scene/StoreTables.h"

namespace tss {

namespace {

void writeMetadata(Layer& layer, const SceneModel& scene) {
    layer.metadata["defaultPrim"] = scene.defaultPrim;
    layer.metadata["metersPerUnit"] = scene.metersPerUnit;
    layer.metadata["upAxis"] = std::string(1, scene.upAxis);
    if (scene.timeCodesPerSecond != 24) layer.metadata["timeCodesPerSecond"] = scene.timeCodesPerSecond;
    if (scene.startTimeCode == 0 && scene.endTimeCode == 0) return;
    layer.metadata["startTimeCode"] = scene.startTimeCode;
    layer.metadata["endTimeCode"] = scene.endTimeCode;
}

template <class Items>
std::vector<std::string> pathsOf(const Items& items, const std::vector<int>& indices) {
    std::vector<std::string> paths;
    paths.reserve(indices.size());
    for (int index : indices) paths.push_back(items[index].path);
    return paths;
}

void writeWeights(PrimWriter& prim, const SceneModel& scene, const SkinWeights& weights) {
    if (weights.joints.empty()) return;
    prim.set(schema::skelJoints, pathsOf(scene.bodies, weights.joints));
    prim.set(schema::jointIndices, weights.indices);
    prim.set(schema::jointWeights, weights.weights);
    for (const Attribute& attribute : {schema::jointIndices, schema::jointWeights}) {
        prim.setMetadata(attribute, "elementSize", static_cast<double>(weights.influences));
        prim.setMetadata(attribute, "interpolation", "vertex");
    }
}

} // namespace

void writePair(Layer& layer, const SceneModel& scene, const Pair& pair) {
    const bool ofJoint = pair.joints.size() == 1 && scene.joints[pair.joints[0]].path == pair.path;
    PrimWriter prim(makePrim(layer, pair.path, "Scope"));
    addApi(prim.prim(), "TssPairAPI");
    if (!ofJoint) prim.setTargets(schema::bodies, pathsOf(scene.bodies, {pair.bodyA, pair.bodyB}));
    writeSettings(prim.prim(), pair.settings);
}

void writePairs(Layer& layer, const SceneModel& scene) {
    for (const Pair& pair : scene.pairs) writePair(layer, scene, pair);
}

const char* formText(MuscleForm form) {
    return form == MuscleForm::Ring ? "ring" : form == MuscleForm::Sheet ? "sheet" : "tube";
}

/// One bone, or one at either end; by the names that the prim has for them already.
void writeBonesOf(PrimWriter& prim, const SceneModel& scene, const MuscleModel& model) {
    const bool both = model.insertionBone >= 0 || prim.prim().property(schema::originBone) ||
                      prim.prim().property(schema::insertionBone);
    const int insertion = model.insertionBone >= 0                      ? model.insertionBone
                          : prim.prim().property(schema::insertionBone) ? model.bone
                                                                        : -1;
    for (const char* name : {schema::bone, schema::originBone, schema::insertionBone}) prim.remove(name);
    if (model.bone >= 0)
        prim.setTargets(both ? schema::originBone : schema::bone, pathsOf(scene.bodies, {model.bone}));
    if (insertion >= 0) prim.setTargets(schema::insertionBone, pathsOf(scene.bodies, {insertion}));
}

void writeMuscles(Layer& layer, const SceneModel& scene) {
    const Muscle plain;
    for (const MuscleModel& model : scene.muscles) {
        PrimWriter prim(makePrim(layer, model.path, "TssMuscle"));
        const Muscle& muscle = model.muscle;
        prim.setTargets(schema::surface, pathsOf(scene.bodies, {model.body}));
        writeBonesOf(prim, scene, model);
        if (muscle.form == MuscleForm::Ring) {
            prim.set(schema::fibre, muscle.fibre);
        } else {
            prim.set(schema::origin, muscle.fibre.at(0));
            prim.set(schema::insertion, muscle.fibre.back());
            if (muscle.fibre.size() > 2)
                prim.set(schema::fibre, std::vector<Vec3>(muscle.fibre.begin() + 1, muscle.fibre.end() - 1));
        }
        prim.setUnless(schema::form, formText(muscle.form), "tube");
        prim.setUnless(schema::anchor, muscle.anchor, plain.anchor);
        prim.setUnless(schema::maxContraction, muscle.maxContraction, plain.maxContraction);
        if (muscle.activationLower != plain.activationLower ||
            muscle.activationUpper != plain.activationUpper)
            prim.set(schema::activationRange, std::vector{muscle.activationLower, muscle.activationUpper});
        prim.set(schema::activation, model.activation);
    }
}

void writeSkins(Layer& layer, const SceneModel& scene) {
    for (const SkinModel& skin : scene.skins) {
        PrimWriter prim(makePrim(layer, skin.path, "Mesh"));
        addApi(prim.prim(), "TssSkinAPI");
        if (!skin.bones.empty()) prim.setTargets(schema::bones, pathsOf(scene.bodies, skin.bones));
        if (!skin.muscles.empty() || skin.bones.empty())
            prim.setTargets(schema::muscles, pathsOf(scene.muscles, skin.muscles));
        prim.setUnless(schema::thickness, skin.thickness, 0.0);
        prim.setUnless(schema::travel, skin.travel, 0.0);
        prim.setUnless(schema::stretchCompliance, skin.stretchCompliance, 0.0);
        prim.setUnless(schema::bendCompliance, skin.bendCompliance, 0.0);
        prim.setUnless(schema::selfContact, Value(skin.selfContact), Value(false));
        for (const auto& [attribute, weights] :
             {std::pair(schema::tether, &skin.tether), std::pair(schema::attach, &skin.attach)})
            if (!weights->empty()) {
                prim.set(attribute, *weights);
                prim.setMetadata(attribute, "interpolation", "vertex");
            }
        writeWeights(prim, scene, skin.weights);
        writeSettings(prim.prim(), skin.settings);
    }
}

Layer toLayer(const SceneModel& scene) {
    Layer layer;
    writeMetadata(layer, scene);
    makePrim(layer, "/" + scene.defaultPrim, "Xform");
    writeBodies(layer, scene);
    writeJoints(layer, scene);
    writePairs(layer, scene);
    writeMuscles(layer, scene);
    writeSkins(layer, scene);
    storeTables(layer, scene);
    return layer;
}

} // namespace tss
