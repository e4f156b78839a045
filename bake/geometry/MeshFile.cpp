
#ifdef OSGTSS_IMPORT

#include "bake/base/Error.h"
#include "bake/geometry/AssimpFile.h"
#include "bake/geometry/MeshFileParts.h"
#include "bake/geometry/Polygon.h"
#include "bake/geometry/SkinPlaces.h"

#include <algorithm>
#include <assimp/scene.h>
#include <cstdint>
#include <fmt/format.h>

namespace tss {

namespace {

/// Without the vertices of points and lines alone, which are no surface and would count in its size. places:
/// where its vertices are taken; empty: all to `placeOfAll`. Throws InputError for a face that names a vertex
/// which is not there.
void append(const aiMesh& source, const std::vector<Eigen::Affine3d>& places,
            const Eigen::Affine3d& placeOfAll, TriangleMesh& mesh) {
    const auto taken = [&](unsigned v) -> const Eigen::Affine3d& {
        return places.empty() ? placeOfAll : places[v];
    };
    enum Use { Loose, OfLine, OfFace };
    std::vector<Use> uses(source.mNumVertices, Loose);
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            if (face.mIndices[k] >= source.mNumVertices)
                throw InputError(fmt::format("face {} names vertex {}; expected one of 0 to {}", f,
                                             face.mIndices[k],
                                             static_cast<std::int64_t>(source.mNumVertices) - 1));
            Use& use = uses[face.mIndices[k]];
            use = std::max(use, face.mNumIndices > 2 ? OfFace : OfLine);
        }
    }
    std::vector<int> place(source.mNumVertices);
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
        if (uses[v] == OfLine) continue;
        const aiVector3D& p = source.mVertices[v];
        place[v] = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(taken(v) * Vec3(p.x, p.y, p.z));
    }
    std::vector<Vec3> corners;
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        if (face.mNumIndices < 3) continue;
        corners.clear();
        for (unsigned k = 0; k < face.mNumIndices; ++k)
            corners.push_back(mesh.vertices[place[face.mIndices[k]]]);
        const bool mirrored = taken(face.mIndices[0]).linear().determinant() < 0;
        for (Tri t : triangulated(corners)) {
            if (mirrored) std::swap(t[1], t[2]); // keeps the outside outside
            mesh.triangles.emplace_back(place[face.mIndices[t[0]]], place[face.mIndices[t[1]]],
                                        place[face.mIndices[t[2]]]);
        }
    }
}

void placeNodes(const aiNode& node, const Eigen::Affine3d& place, NodePlaces& places) {
    places.try_emplace(node.mName.C_Str(), place);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        placeNodes(*node.mChildren[i], place * placeOf(node.mChildren[i]->mTransformation), places);
}

/// The meshes of a node in its own frame, or all in the file's where bones take one of them elsewhere.
ImportedNode partOf(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& place,
                    const NodePlaces& places) {
    std::vector<std::vector<Eigen::Affine3d>> skins;
    bool elsewhere = false;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        skins.push_back(skinPlaces(*scene.mMeshes[node.mMeshes[i]], places, place));
        elsewhere = elsewhere || !skins.back().empty();
    }
    const Eigen::Affine3d none = Eigen::Affine3d::Identity();
    ImportedNode part{node.mName.C_Str(), elsewhere ? none : place, {}};
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
        append(*scene.mMeshes[node.mMeshes[i]], skins[i], elsewhere ? place : none, part.mesh);
    return part;
}

void collect(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& place, const NodePlaces& places,
             std::vector<ImportedNode>& nodes) {
    ImportedNode part = partOf(scene, node, place, places);
    if (!part.mesh.empty()) nodes.push_back(std::move(part));
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        collect(scene, *node.mChildren[i], place * placeOf(node.mChildren[i]->mTransformation), places,
                nodes);
}

MeshFile readHere(const std::string& file) {
    AssimpFile from = readAssimpFile(file);
    MeshFile read;
    NodePlaces places;
    placeNodes(*from.scene->mRootNode, from.root, places);
    collect(*from.scene, *from.scene->mRootNode, from.root, places, read.nodes);
    read.notes = std::move(from.notes);
    return read;
}

} // namespace

MeshFile readMeshFile(const std::string& file) {
    MeshFile read;
    readApart(
        file, [&] { return bytesOf(readHere(file)); },
        [&](const std::string& bytes) { read = meshFileOf(bytes); });
    return read;
}

} // namespace tss

#endif
