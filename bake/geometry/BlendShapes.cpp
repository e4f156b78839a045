#ifdef OSGTSS_IMPORT

#include "bake/geometry/BlendShapes.h"

#include <assimp/scene.h>
#include <vector>

namespace tss {

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
