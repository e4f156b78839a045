// Skin over a stick for each bone of rigged characters, beside the shares that their artists gave it:
// bench_rigs [--degrees D, 40] [--each] FILE..., any files that assimp reads. Each joint of two bones turns
// by itself, once with all bones named and once with these two alone; printed is how far skin is from where
// the artist's shares take it, in thousandths of its size: mean over all of it, over what should stay, over
// what should go along, and triangles turned over. Sticks go from joint to joint; a bone without one below it
// ends in the middle of the skin that it has most of.
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <numbers>
#include <string>

using namespace tss;

namespace {

struct Bone {
    std::string name;
    int parent = -1;
    Vec3 joint = Vec3::Zero(); ///< its origin in the skin's frame, as modelled
    std::shared_ptr<const MuscleDeformer> stick;
    Vec3 tip = Vec3::Zero();
};

/// The skinned meshes of a file as one, and the bones that move it. Shares: #bones of #vertices.
struct Rig {
    TriangleMesh skin;
    std::vector<Bone> bones;
    std::vector<std::vector<double>> shares;
    double size = 0;
};

void addMesh(const aiMesh& mesh, Rig& rig, std::map<std::string, int>& indices) {
    const std::size_t first = rig.skin.vertices.size();
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        rig.skin.vertices.emplace_back(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices != 3) continue;
        rig.skin.triangles.push_back(Tri(face.mIndices[0], face.mIndices[1], face.mIndices[2]) +
                                     Tri::Constant(static_cast<int>(first)));
    }
    for (std::vector<double>& shares : rig.shares) shares.resize(rig.skin.vertices.size());
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const auto [at, isNew] = indices.try_emplace(bone.mName.C_Str(), static_cast<int>(rig.bones.size()));
        if (isNew) {
            aiMatrix4x4 place = bone.mOffsetMatrix;
            place.Inverse();
            rig.bones.push_back({bone.mName.C_Str(), -1, Vec3(place.a4, place.b4, place.c4), nullptr});
            rig.shares.emplace_back(rig.skin.vertices.size());
        }
        for (unsigned w = 0; w < bone.mNumWeights; ++w)
            rig.shares[at->second][first + bone.mWeights[w].mVertexId] += bone.mWeights[w].mWeight;
    }
}

/// Two pyramids, base to base near the first end, as bones are drawn.
std::shared_ptr<const MuscleDeformer> stick(const Vec3& from, const Vec3& to, double most) {
    const Vec3 along = to - from, across = along.unitOrthogonal();
    const double radius = std::min(0.1 * along.norm(), most);
    Muscle bone;
    bone.activationUpper = 0;
    bone.surface.vertices = {from, to};
    for (int k = 0; k < 4; ++k)
        bone.surface.vertices.push_back(
            from + 0.1 * along +
            radius * (Eigen::AngleAxisd(k * std::numbers::pi / 2, along.normalized()) * across));
    for (int k = 0; k < 4; ++k) {
        const int one = 2 + k, next = 2 + (k + 1) % 4;
        bone.surface.triangles.emplace_back(0, next, one);
        bone.surface.triangles.emplace_back(1, one, next);
    }
    return std::make_shared<const MuscleDeformer>(std::move(bone));
}

void addSticks(Rig& rig) {
    for (std::size_t b = 0; b < rig.bones.size(); ++b) {
        Bone& bone = rig.bones[b];
        Vec3 sum = Vec3::Zero();
        double count = 0;
        for (const Bone& other : rig.bones)
            if (other.parent == static_cast<int>(b)) sum += other.joint, ++count;
        if (count == 0)
            for (std::size_t v = 0; v < rig.skin.vertices.size(); ++v)
                if (rig.shares[b][v] > 0.5) sum += rig.skin.vertices[v], ++count;
        bone.tip = count > 0 ? Vec3(sum / count) : bone.joint;
        if ((bone.tip - bone.joint).norm() > 1e-3 * rig.size)
            bone.stick = stick(bone.joint, bone.tip, 0.01 * rig.size);
    }
}

/// Shares that sum to one; a vertex that has none is the first bone's.
void completeShares(Rig& rig) {
    for (std::size_t v = 0; v < rig.skin.vertices.size(); ++v) {
        double sum = 0;
        for (const std::vector<double>& shares : rig.shares) sum += shares[v];
        if (sum == 0) rig.shares[0][v] = sum = 1;
        for (std::vector<double>& shares : rig.shares) shares[v] /= sum;
    }
}

Rig readRig(const std::string& file) {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene* scene = importer.ReadFile(file, aiProcess_Triangulate);
    Rig rig;
    if (!scene) {
        std::fprintf(stderr, "%s: %s\n", file.c_str(), importer.GetErrorString());
        return rig;
    }
    std::map<std::string, int> indices;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
        if (scene->mMeshes[m]->HasBones()) addMesh(*scene->mMeshes[m], rig, indices);
    const std::function<void(const aiNode&, int)> visit = [&](const aiNode& node, int above) {
        if (const auto at = indices.find(node.mName.C_Str()); at != indices.end()) {
            rig.bones[at->second].parent = above;
            above = at->second;
        }
        for (unsigned k = 0; k < node.mNumChildren; ++k) visit(*node.mChildren[k], above);
    };
    visit(*scene->mRootNode, -1);
    Eigen::AlignedBox3d box;
    for (const Vec3& v : rig.skin.vertices) box.extend(v);
    rig.size = rig.skin.empty() ? 0 : box.diagonal().norm();
    if (!rig.bones.empty()) completeShares(rig);
    addSticks(rig);
    return rig;
}

bool isBelow(const Rig& rig, int bone, int top) {
    while (bone >= 0 && bone != top) bone = rig.bones[bone].parent;
    return bone == top;
}

struct Errors {
    double all = 0, stays = 0, goes = 0; ///< means, thousandths of the size
    std::size_t turnedOver = 0;

    void add(const Errors& other, double weight) {
        all += weight * other.all;
        stays += weight * other.stays;
        goes += weight * other.goes;
        turnedOver += other.turnedOver;
    }
};

/// The skin with the bones that are named, one joint turned, beside what the artist's shares make of it.
Errors errors(const Rig& rig, SkinResponse& response, const std::vector<Pose>& poses, const Pose& turned,
              int top) {
    response.update(std::vector<double>(poses.size(), 0), poses);
    std::vector<Vec3> now = rig.skin.vertices, artist = now;
    for (std::size_t k = 0; k < response.vertices().size(); ++k)
        now[response.vertices()[k]] = response.positions()[k];
    Errors result;
    std::size_t still = 0, along = 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
        double share = 0;
        for (std::size_t b = 0; b < rig.bones.size(); ++b)
            if (isBelow(rig, static_cast<int>(b), top)) share += rig.shares[b][v];
        artist[v] += share * (turned * artist[v] - artist[v]);
        const double off = 1000 / rig.size * (now[v] - artist[v]).norm();
        result.all += off;
        if (share < 0.001) result.stays += off, ++still;
        if (share > 0.999) result.goes += off, ++along;
    }
    result.all /= static_cast<double>(now.size());
    result.stays /= std::max<double>(1, static_cast<double>(still));
    result.goes /= std::max<double>(1, static_cast<double>(along));
    const auto normal = [](const std::vector<Vec3>& at, const Tri& t) -> Vec3 {
        return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
    };
    for (const Tri& t : rig.skin.triangles) result.turnedOver += normal(now, t).dot(normal(artist, t)) < 0;
    return result;
}

/// Poses of the named bones where what hangs on `top` is turned.
std::vector<Pose> posesOf(const Rig& rig, const std::vector<int>& named, int top, const Pose& turned) {
    std::vector<Pose> poses;
    for (const int bone : named) poses.push_back(isBelow(rig, bone, top) ? turned : Pose::Identity());
    return poses;
}

class Measure {
public:
    Measure(const Rig& rig, double angle) : rig_(rig), angle_(angle) {
        for (std::size_t b = 0; b < rig.bones.size(); ++b) {
            if (!rig.bones[b].stick) continue;
            all_.push_back(static_cast<int>(b));
            const int parent = rig.bones[b].parent;
            if (parent >= 0 && rig.bones[parent].stick) tops_.push_back(static_cast<int>(b));
        }
    }

    void print(const char* file, bool each) {
        Errors all, two;
        const double weight = 1 / static_cast<double>(std::max<std::size_t>(1, tops_.size()));
        SkinResponse whole(rigOf(all_, tops_));
        for (const int top : tops_) {
            const std::vector<int> both{rig_.bones[top].parent, top};
            SkinResponse pair(rigOf(both, {top}));
            const Errors one = errorsAt(whole, all_, top), other = errorsAt(pair, both, top);
            all.add(one, weight);
            two.add(other, weight);
            if (each) line(("  " + rig_.bones[top].name).c_str(), one, other);
        }
        std::printf("%zu vertices, %zu joints\n", rig_.skin.vertices.size(), tops_.size());
        line(file, all, two);
    }

private:
    static void line(const char* name, const Errors& all, const Errors& two) {
        std::printf("%-40s all bones %7.2f %7.2f %7.2f %4zu   two %7.2f %7.2f %7.2f %4zu\n", name, all.all,
                    all.stays, all.goes, all.turnedOver, two.all, two.stays, two.goes, two.turnedOver);
    }

    /// About the joint, across both bones.
    Pose turnedBy(int top, double angle) const {
        const Bone &bone = rig_.bones[top], &parent = rig_.bones[bone.parent];
        const Vec3 along = (bone.tip - bone.joint).normalized(),
                   before = (bone.joint - parent.joint).normalized();
        const Vec3 axis = along.cross(before).norm() > 0.05 ? Vec3(along.cross(before).normalized())
                                                            : Vec3(along.unitOrthogonal());
        return Pose(Eigen::Translation3d(bone.joint) * Eigen::AngleAxisd(angle, axis) *
                    Eigen::Translation3d(-bone.joint));
    }

    std::shared_ptr<const SkinRig> rigOf(const std::vector<int>& named, const std::vector<int>& tops) const {
        SkinParameters parameters;
        constexpr int stations = 8;
        for (const int top : tops)
            for (const int way : {-1, 1}) {
                BoneSwing swing;
                for (int s = 1; s <= stations; ++s)
                    swing.push_back(posesOf(rig_, named, top, turnedBy(top, way * angle_ * s / stations)));
                parameters.swings.push_back(swing);
            }
        std::vector<std::shared_ptr<const MuscleDeformer>> sticks;
        for (const int bone : named) sticks.push_back(rig_.bones[bone].stick);
        SkinTable nothingMet;
        nothingMet.table.rowOffsets = {0};
        return makeSkinRig(rig_.skin, sticks, nothingMet, parameters);
    }

    Errors errorsAt(SkinResponse& response, const std::vector<int>& named, int top) const {
        const Pose turned = turnedBy(top, angle_);
        return errors(rig_, response, posesOf(rig_, named, top, turned), turned, top);
    }

    const Rig& rig_;
    double angle_;
    std::vector<int> all_, tops_; ///< bones that have a stick; those that have a joint with another
};

} // namespace

int main(int count, char** arguments) {
    double degrees = 40;
    bool each = false;
    std::vector<std::string> files;
    for (int k = 1; k < count; ++k) {
        if (!std::strcmp(arguments[k], "--each"))
            each = true;
        else if (!std::strcmp(arguments[k], "--degrees") && k + 1 < count)
            degrees = std::atof(arguments[++k]);
        else
            files.push_back(arguments[k]);
    }
    if (files.empty()) {
        std::fprintf(stderr, "usage: bench_rigs [--degrees D] [--each] FILE...\n");
        return 2;
    }
    std::puts("off the artist's shares, thousandths of the size: mean of all, of what stays, of what goes; "
              "turned over");
    for (const std::string& file : files) {
        const Rig rig = readRig(file);
        if (rig.bones.empty())
            std::printf("%s: no bones\n", file.c_str());
        else
            Measure(rig, degrees * std::numbers::pi / 180)
                .print(file.substr(file.rfind('/') + 1).c_str(), each);
        std::fflush(stdout);
    }
}
