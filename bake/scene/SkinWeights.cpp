#include "bake/scene/SceneParts.h"

#include <cmath>

namespace tss {

namespace {

constexpr Attribute jointIndices =
    declared("int[] primvars:skel:jointIndices", "of each vertex, which of `skel:joints` it follows");
constexpr Attribute jointWeights =
    declared("float[] primvars:skel:jointWeights", "and how much: of each vertex a sum of 1", atLeast(0));

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

} // namespace

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

SchemaType skinWeightsSchema() {
    return {"TssSkinAPI", {schema::skelJoints, jointIndices, jointWeights}};
}

} // namespace tss
