#include "bake/geometry/RigFile.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <array>

#ifdef OSGTSS_IMPORT

#include "bake/geometry/AssimpFile.h"
#include "bake/geometry/MeshFileParts.h"
#include "bake/geometry/Polygon.h"
#include "bake/geometry/SkinPlaces.h"

#include <assimp/scene.h>
#include <fmt/format.h>
#include <map>

#endif

namespace tss {

bool isRigName(const std::string& file) {
    constexpr std::array names = {".dae", ".fbx",     ".gltf", ".glb",  ".vrm",
                                  ".x",   ".md5mesh", ".b3d",  ".ms3d", ".smd"};
    return std::ranges::find(names, extensionOf(file)) != names.end();
}

#ifdef OSGTSS_IMPORT

namespace {

class Collecting {
public:
    explicit Collecting(const AssimpFile& from) : scene_(*from.scene) {
        addNode(*scene_.mRootNode, -1, from.root);
        for (unsigned a = 0; a < scene_.mNumAnimations; ++a) addAnimation(*scene_.mAnimations[a]);
        rig_.notes = from.notes;
        std::erase_if(rig_.notes.leftOut, [](const std::string& text) { // which are read here
            return text.ends_with(" animation") || text.ends_with(" animations") || text.ends_with(" bone") ||
                   text.ends_with(" bones");
        });
    }

    RigFile take() { return std::move(rig_); }

private:
    int nodeCalled(const aiString& name) const {
        const auto found = nodeOf_.find(name.C_Str());
        return found != nodeOf_.end() ? found->second : -1;
    }

    void addNode(const aiNode& node, int parent, const Eigen::Affine3d& local) {
        const int index = static_cast<int>(rig_.nodes.size());
        rig_.nodes.push_back({node.mName.C_Str(), parent, local});
        nodeOf_.try_emplace(node.mName.C_Str(), index);
        for (unsigned i = 0; i < node.mNumChildren; ++i)
            addNode(*node.mChildren[i], index, placeOf(node.mChildren[i]->mTransformation));
        for (unsigned i = 0; i < node.mNumMeshes; ++i) meshesOf_.emplace_back(index, node.mMeshes[i]);
        if (parent < 0) // when all names are known
            for (const auto& [of, mesh] : meshesOf_) addMesh(*scene_.mMeshes[mesh], of);
    }

    void addMesh(const aiMesh& source, int node) {
        RigFile::Mesh mesh;
        mesh.node = node;
        for (unsigned v = 0; v < source.mNumVertices; ++v)
            mesh.surface.vertices.emplace_back(source.mVertices[v].x, source.mVertices[v].y,
                                               source.mVertices[v].z);
        addFaces(source, mesh.surface);
        if (mesh.surface.triangles.empty()) return;
        if (source.mNumBones > 0) mesh.weights.resize(mesh.surface.vertices.size());
        for (unsigned b = 0; b < source.mNumBones; ++b) {
            const aiBone& bone = *source.mBones[b];
            const int of = nodeCalled(bone.mName);
            if (of < 0) continue;
            mesh.bones.emplace_back(of, placeOf(bone.mOffsetMatrix));
            const int index = static_cast<int>(mesh.bones.size()) - 1;
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                const auto& [v, weight] = bone.mWeights[w];
                if (v < mesh.weights.size() && weight > 0) mesh.weights[v].emplace_back(index, weight);
            }
        }
        rig_.meshes.push_back(std::move(mesh));
    }

    static void addFaces(const aiMesh& source, TriangleMesh& surface) {
        std::vector<Vec3> corners;
        for (unsigned f = 0; f < source.mNumFaces; ++f) {
            const aiFace& face = source.mFaces[f];
            if (face.mNumIndices < 3) continue;
            corners.clear();
            for (unsigned k = 0; k < face.mNumIndices; ++k) {
                if (face.mIndices[k] >= source.mNumVertices)
                    throw InputError(
                        fmt::format("face {} names vertex {}, which is not there", f, face.mIndices[k]));
                corners.push_back(surface.vertices[face.mIndices[k]]);
                if (!corners.back().allFinite())
                    throw InputError(fmt::format("vertex {}: expected a finite point", face.mIndices[k]));
            }
            for (const Tri& t : triangulated(corners))
                surface.triangles.emplace_back(face.mIndices[t[0]], face.mIndices[t[1]], face.mIndices[t[2]]);
        }
    }

    void addAnimation(const aiAnimation& source) {
        const double ticks = source.mTicksPerSecond > 0 ? source.mTicksPerSecond : 25; // as assimp's viewer
        RigFile::Animation animation;
        animation.name = source.mName.C_Str();
        const auto add = [&](const auto* keys, unsigned count, std::vector<double>& times, auto& values,
                             const auto& valueOf) {
            for (unsigned k = 0; k < count; ++k) {
                const double time = keys[k].mTime / ticks;
                if (!times.empty() && !(time > times.back())) continue;
                times.push_back(time);
                values.push_back(valueOf(keys[k].mValue));
            }
        };
        const auto vector = [](const aiVector3D& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
        const auto turn = [](const aiQuaternion& q) { return Eigen::Vector4d(q.x, q.y, q.z, q.w); };
        for (unsigned c = 0; c < source.mNumChannels; ++c) {
            const aiNodeAnim& from = *source.mChannels[c];
            RigFile::Channel channel;
            channel.node = nodeCalled(from.mNodeName);
            if (channel.node < 0) continue;
            add(from.mPositionKeys, from.mNumPositionKeys, channel.placeTimes, channel.places, vector);
            add(from.mRotationKeys, from.mNumRotationKeys, channel.turnTimes, channel.turns, turn);
            add(from.mScalingKeys, from.mNumScalingKeys, channel.scaleTimes, channel.scales, vector);
            animation.channels.push_back(std::move(channel));
        }
        if (!animation.channels.empty()) rig_.animations.push_back(std::move(animation));
    }

    const aiScene& scene_;
    RigFile rig_;
    std::map<std::string, int> nodeOf_; ///< by name; of several the first
    std::vector<std::pair<int, unsigned>> meshesOf_;
};

} // namespace

RigFile readRigFile(const std::string& file) {
    RigFile rig;
    readApart(
        file, [&] { return bytesOf(Collecting(readAssimpFile(file)).take()); },
        [&](const std::string& bytes) { rig = rigFileOf(bytes); });
    return rig;
}

#else

RigFile readRigFile(const std::string& file) {
    throw InputError(Where{file}, "this build reads no mesh files (OSGTSS_IMPORT is off)");
}

#endif

} // namespace tss
