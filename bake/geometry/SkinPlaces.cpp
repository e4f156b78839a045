#ifdef OSGTSS_IMPORT

#include "bake/geometry/SkinPlaces.h"

#include <algorithm>

namespace tss {

namespace {

Vec3 point(const aiMesh& mesh, unsigned v) {
    return {mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z};
}

/// Those that carry something, in the order of their names: vertices at one place then get the same sums in
/// each mesh of a skin.
std::vector<const aiBone*> carryingBones(const aiMesh& mesh) {
    std::vector<const aiBone*> bones;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const auto carries = [](const aiVertexWeight& weight) { return weight.mWeight > 0; };
        if (std::any_of(bone.mWeights, bone.mWeights + bone.mNumWeights, carries)) bones.push_back(&bone);
    }
    std::ranges::sort(bones, {}, [](const aiBone* bone) { return std::string(bone->mName.C_Str()); });
    return bones;
}

/// Over the vertices, between where `places` take them and where `other` does.
double farthestApart(const aiMesh& mesh, const std::vector<Eigen::Affine3d>& places,
                     const Eigen::Affine3d& other) {
    double most = 0;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        most = std::max(most, (places[v] * point(mesh, v) - other * point(mesh, v)).norm());
    return most;
}

} // namespace

std::vector<Eigen::Affine3d> skinPlaces(const aiMesh& mesh, const NodePlaces& nodes,
                                        const Eigen::Affine3d& ofNode) {
    std::vector<Eigen::Matrix4d> sums(mesh.mNumVertices, Eigen::Matrix4d::Zero());
    std::vector<double> shares(mesh.mNumVertices);
    for (const aiBone* bone : carryingBones(mesh)) {
        const auto node = nodes.find(bone->mName.C_Str());
        if (node == nodes.end()) return {};
        const Eigen::Affine3d place = node->second * placeOf(bone->mOffsetMatrix);
        for (unsigned w = 0; w < bone->mNumWeights; ++w) {
            const auto& [v, share] = bone->mWeights[w];
            if (v >= mesh.mNumVertices || !(share > 0)) continue;
            sums[v] += share * place.matrix();
            shares[v] += share;
        }
    }
    std::vector<Eigen::Affine3d> places(mesh.mNumVertices, ofNode);
    Eigen::AlignedBox3d box;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        if (shares[v] > 0) places[v] = Eigen::Affine3d(sums[v] / shares[v]);
        box.extend(places[v] * point(mesh, v));
    }
    // Matrices are floats. One place for all keeps together what lies at one place.
    const double rounding = box.isEmpty() ? 0 : 1e-4 * box.diagonal().norm();
    if (farthestApart(mesh, places, ofNode) <= rounding) return {};
    const Eigen::Affine3d first = places[0];
    if (farthestApart(mesh, places, first) <= rounding) places.assign(mesh.mNumVertices, first);
    return places;
}

namespace {

void applyBlendShapes(aiMesh& mesh) {
    const std::vector<aiVector3D> plain(mesh.mVertices, mesh.mVertices + mesh.mNumVertices);
    for (unsigned s = 0; s < mesh.mNumAnimMeshes; ++s) {
        const aiAnimMesh& shape = *mesh.mAnimMeshes[s];
        if (shape.mWeight == 0 || !shape.HasPositions() || shape.mNumVertices != mesh.mNumVertices) continue;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            mesh.mVertices[v] += shape.mWeight * (shape.mVertices[v] - plain[v]);
    }
}

} // namespace

void applyBlendShapes(aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) applyBlendShapes(*scene.mMeshes[m]);
}

} // namespace tss

#endif
