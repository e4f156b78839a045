#include "bake/scene/SceneParts.h"

#include <algorithm>

namespace tss {

namespace {

constexpr Attribute muscles = declared("rel tss:muscles", "the muscles that push it");
constexpr Attribute tether = declared("float[] primvars:tss:tether",
                                      "how firmly each vertex is held to its rest place", between(0, 1));
constexpr Attribute attach =
    declared("float[] primvars:tss:attach",
             "how firmly each vertex is carried by the muscle below; absent: by its distance", between(0, 1));

const Fields<SkinModel>& skinFields() {
    static const Fields<SkinModel> fields{
        schema::bones,
        muscles,
        field("uniform double tss:thickness", &SkinModel::thickness, 0, atLeast(0),
              "radius of its spheres; 0 (absent): from the mesh"),
        field("uniform double tss:travel", &SkinModel::travel, 0, atLeast(0),
              "how far a vertex may stray from rest; 0 (absent): from the motion below"),
        field("uniform double tss:stretchCompliance", &SkinModel::stretchCompliance, 0, atLeast(0),
              "how far it gives when it is stretched (0)"),
        field("uniform double tss:bendCompliance", &SkinModel::bendCompliance, 0, atLeast(0),
              "and when it is bent (0)"),
        field("uniform bool tss:selfContact", &SkinModel::selfContact, false, anyNumber,
              "it also keeps out of itself (false)"),
        tether,
        attach};
    return fields;
}

/// The bodies that a skin lies on: any mesh but its own.
void readBones(const SceneReading& reading, const PrimReader& prim, SkinModel& skin) {
    for (const std::string& path : prim.targets(schema::bones)) {
        const int bone = reading.body(prim, schema::bones, path);
        if (bone < 0) continue;
        const bool again = std::ranges::find(skin.bones, bone) != skin.bones.end();
        const char* wanted = bone == skin.body                         ? "another body than the skin"
                             : reading.scene.bodies[bone].mesh.empty() ? "a mesh with faces"
                             : again                                   ? "each bone once"
                                                                       : nullptr;
        if (wanted)
            prim.targetProblem(schema::bones, "expected ", wanted, ", found \"", path, "\"");
        else
            skin.bones.push_back(bone);
    }
}

} // namespace

std::vector<SchemaType> skinSchemas() {
    return {skinFields().schema("TssSkinAPI"), skinWeightsSchema()};
}

void readSkins(SceneReading& reading) {
    const auto isSkin = [](const Prim& prim) { return hasApi(prim, "TssSkinAPI"); };
    reading.forPrims(isSkin, [&](const PrimReader& prim, int entry) {
        if (!reading.ownPrim(entry, "TssSkinAPI")) return;
        SkinModel skin;
        skin.path = prim.place().path;
        if (prim.prim().typeName != "Mesh" || !reading.bodyAt.contains(skin.path))
            return prim.problem("expected TssSkinAPI on a Mesh, found it on \"", prim.prim().typeName, "\"");
        skin.body = reading.bodyAt.at(skin.path);
        for (const std::string& path : prim.targets(muscles))
            if (const auto found = reading.muscleAt.find(path); found != reading.muscleAt.end())
                skin.muscles.push_back(found->second);
            else
                prim.targetProblem(muscles, "expected the path of a TssMuscle, found \"", path, "\"");
        readBones(reading, prim, skin);
        skinFields().read(prim, skin);
        const std::size_t vertices = reading.scene.bodies[skin.body].mesh.vertices.size();
        skin.tether = prim.reals(tether, vertices);
        skin.attach = prim.reals(attach, vertices);
        skin.weights = readSkinWeights(reading, prim, vertices);
        skin.settings = readSettings(prim);
        reading.scene.skins.push_back(std::move(skin));
    });
}

void writeSkins(Layer& layer, const SceneModel& scene) {
    for (const SkinModel& skin : scene.skins) {
        PrimWriter prim(makePrim(layer, skin.path, "Mesh"));
        addApi(prim.prim(), "TssSkinAPI");
        if (!skin.bones.empty()) prim.setTargets(schema::bones, pathsOf(scene.bodies, skin.bones));
        if (!skin.muscles.empty() || skin.bones.empty())
            prim.setTargets(muscles, pathsOf(scene.muscles, skin.muscles));
        skinFields().write(prim, skin);
        for (const auto& [attribute, numbers] : {std::pair(tether, &skin.tether), {attach, &skin.attach}}) {
            prim.setIfAny(attribute, *numbers);
            if (!numbers->empty()) prim.setMetadata(attribute, "interpolation", "vertex");
        }
        writeSkinWeights(prim, scene, skin.weights);
        writeSettings(prim.prim(), skin.settings);
    }
}

} // namespace tss
