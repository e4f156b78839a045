#include "bake/scene/SceneParts.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr Attribute muscles = declared("rel tss:muscles", "the muscles that push it");
constexpr Attribute tether = declared("float[] primvars:tss:tether",
                                      "how firmly each vertex is held to its rest place", between(0, 1));
constexpr Attribute attach =
    declared("float[] primvars:tss:attach",
             "how firmly each vertex is carried by the muscle below; absent: by its distance", between(0, 1));

constexpr Attribute jointIndices =
    declared("int[] primvars:skel:jointIndices", "of each vertex, which of `skel:joints` it follows");
constexpr Attribute jointWeights =
    declared("float[] primvars:skel:jointWeights", "and how much: of each vertex a sum of 1", atLeast(0));

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

/// Weights of floats, and of hand-written digits, sum to 1 within this.
constexpr double sumSlack = 1e-3;

struct Shape {
    std::size_t influences = 1;
    bool constant = false; ///< the same for all vertices
};

/// What elementSize and interpolation of a primvar say, as USD reads them when they are absent.
Shape shapeOf(const PrimReader& prim, const Attribute& attribute) {
    Shape shape;
    const Property& property = *prim.prim().property(attribute.name);
    if (const auto found = property.other.find("elementSize"); found != property.other.end()) {
        const double* size = found->second.as<double>();
        if (size && *size >= 1 && *size <= 1e6 && *size == std::floor(*size))
            shape.influences = static_cast<std::size_t>(*size);
        else
            prim.problem(attribute,
                         "expected an elementSize, the number of influences a vertex, that is a whole number "
                         "of at least 1, found ",
                         describe(found->second));
    }
    if (const auto found = property.other.find("interpolation"); found != property.other.end()) {
        const auto* text = found->second.as<std::string>();
        shape.constant = text && *text == "constant";
        if (!shape.constant && (!text || *text != "vertex"))
            prim.problem(attribute, "expected the interpolation \"vertex\" or \"constant\", found ",
                         describe(found->second));
    }
    return shape;
}

bool checkCount(const PrimReader& prim, const Attribute& attribute, std::size_t count, std::size_t vertices,
                const Shape& shape) {
    const std::size_t wanted = shape.influences * (shape.constant ? 1 : vertices);
    if (count == wanted) return true;
    prim.problem(attribute, "expected ", wanted, " numbers, ", shape.influences, " (the elementSize) ",
                 shape.constant ? "for all vertices" : joined("a vertex of ", vertices), ", found ", count);
    return false;
}

bool checkSums(const SceneReading& reading, const PrimReader& prim, const SkinWeights& read) {
    for (std::size_t at = 0; at < read.weights.size(); at += read.influences) {
        double sum = 0;
        for (std::size_t k = 0; k < read.influences; ++k) sum += read.weights[at + k];
        if (std::abs(sum - 1) <= sumSlack) continue;
        reading.problems.add(prim.placeOf(jointWeights, "default") / at,
                             "expected weights that sum to 1, found a sum of ", sum, " at vertex ",
                             at / read.influences);
        return false;
    }
    return true;
}

std::vector<int> readSkelJoints(const SceneReading& reading, const PrimReader& prim) {
    std::vector<int> joints;
    const auto paths = prim.texts(schema::skelJoints);
    for (std::size_t k = 0; k < paths.size(); ++k) {
        const auto found = reading.bodyAt.find(paths[k]);
        if (found != reading.bodyAt.end() && found->second != reading.bodyAt.at(prim.place().path))
            joints.push_back(found->second);
        else
            reading.problems.add(prim.placeOf(schema::skelJoints, "default") / k,
                                 "expected the path of a Mesh or an Xform other than the skin, found \"",
                                 paths[k], "\"");
    }
    return joints.size() == paths.size() ? joints : std::vector<int>();
}

/// The weights that a skin of so many vertices brings along.
SkinWeights readSkinWeights(const SceneReading& reading, const PrimReader& prim, std::size_t vertices) {
    SkinWeights read;
    const bool indexed = prim.value(jointIndices), weighed = prim.value(jointWeights);
    if (!indexed && !weighed) return read;
    for (const Attribute& attribute : {schema::skelJoints, jointIndices, jointWeights})
        if (!prim.value(attribute)) {
            prim.problem("expected the attribute ", attribute.name, " (", attribute.typeName,
                         ") too: weights of a skin are skel:joints, primvars:skel:jointIndices and "
                         "primvars:skel:jointWeights together");
            return {};
        }
    read.joints = readSkelJoints(reading, prim);
    const Shape shape = shapeOf(prim, jointIndices), other = shapeOf(prim, jointWeights);
    if (shape.influences != other.influences || shape.constant != other.constant) {
        prim.problem(jointWeights,
                     "expected the elementSize and interpolation of primvars:skel:jointIndices");
        return {};
    }
    read.influences = shape.influences;
    read.indices = prim.indices(jointIndices);
    read.weights = prim.reals(jointWeights);
    // What is not a list of good numbers has been told already.
    if (read.joints.empty() || (read.indices.empty() && vertices > 0) ||
        (read.weights.empty() && vertices > 0) ||
        !checkCount(prim, jointIndices, read.indices.size(), vertices, shape) ||
        !checkCount(prim, jointWeights, read.weights.size(), vertices, shape) ||
        !checkSums(reading, prim, read))
        return {};
    for (std::size_t i = 0; i < read.indices.size(); ++i)
        if (read.indices[i] >= read.joints.size()) {
            reading.problems.add(prim.placeOf(jointIndices, "default") / i, "expected indices below ",
                                 read.joints.size(), ", the number of skel:joints, found ", read.indices[i]);
            return {};
        }
    if (shape.constant) {
        const auto indices = read.indices;
        const auto weights = read.weights;
        for (std::size_t v = 1; v < vertices; ++v) {
            read.indices.insert(read.indices.end(), indices.begin(), indices.end());
            read.weights.insert(read.weights.end(), weights.begin(), weights.end());
        }
    }
    return read;
}

void writeSkinWeights(PrimWriter& prim, const SceneModel& scene, const SkinWeights& weights) {
    if (weights.joints.empty()) return;
    prim.set(schema::skelJoints, pathsOf(scene.bodies, weights.joints));
    prim.set(jointIndices, weights.indices);
    prim.set(jointWeights, weights.weights);
    for (const Attribute& attribute : {jointIndices, jointWeights}) {
        prim.setMetadata(attribute, "elementSize", static_cast<double>(weights.influences));
        prim.setMetadata(attribute, "interpolation", "vertex");
    }
}

} // namespace

std::vector<SchemaType> skinSchemas() {
    return {skinFields().schema("TssSkinAPI"),
            {"TssSkinAPI", {schema::skelJoints, jointIndices, jointWeights}}};
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
