#include "bake/model/SourceHash.h"

#include "bake/base/Error.h"
#include "bake/base/Sha256.h"
#include "bake/model/Kinematics.h"
#include "bake/model/UnderSkin.h"

#include <algorithm>
#include <bit>

namespace tss {

namespace {

/// Hashes numbers by their bits in little-endian order, so that every machine gives the same.
class PartHash {
public:
    PartHash& add(std::uint64_t number) {
        std::uint8_t bytes[8];
        for (int k = 0; k < 8; ++k) bytes[k] = static_cast<std::uint8_t>(number >> (8 * k));
        hash_.add(bytes);
        return *this;
    }
    PartHash& add(double number) { return add(std::bit_cast<std::uint64_t>(number)); }
    PartHash& add(const std::string& text) {
        add(std::uint64_t(text.size()));
        hash_.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        return *this;
    }
    /// As the float that a file holds; both zeros are one.
    PartHash& addFloat(double number) {
        return add(std::uint64_t(std::bit_cast<std::uint32_t>(float(number) + 0.0f)));
    }
    PartHash& add(const Vec3& vector) {
        return addFloat(vector.x()).addFloat(vector.y()).addFloat(vector.z());
    }
    PartHash& add(const Pose& pose) {
        for (int column = 0; column < 3; ++column) add(Vec3(pose.linear().col(column)));
        return add(Vec3(pose.translation()));
    }
    PartHash& add(const TriangleMesh& mesh) {
        add(std::uint64_t(mesh.vertices.size())).add(std::uint64_t(mesh.triangles.size()));
        for (const Vec3& vertex : mesh.vertices) add(vertex);
        for (const Tri& triangle : mesh.triangles)
            for (int index : triangle) add(std::uint64_t(index));
        return *this;
    }
    PartHash& add(const BakeSettings& settings) {
        for (const auto& [key, text] : settings) add(key).add(text);
        return *this;
    }
    std::string text() { return hash_.hex().substr(0, 32); }

private:
    Sha256 hash_;
};

std::string meshHash(const SceneModel& scene, int body, MeshHashes* known) {
    std::string own;
    if (known) known->resize(scene.bodies.size());
    std::string& text = known ? (*known)[body] : own;
    if (text.empty()) text = PartHash().add(scene.bodies[body].mesh).text();
    return text;
}

std::string framesHash(const Motion& motion) {
    PartHash hash;
    hash.add(motion.base);
    for (const Dof& dof : motion.dofs) {
        hash.add(std::uint64_t(dof.kind)).add(dof.origin).add(dof.axis).add(dof.frame).add(dof.rest);
        for (const PathRow& row : dof.path) {
            hash.add(row.value).add(row.translation);
            for (double part : row.rotation.coeffs()) hash.addFloat(part);
        }
    }
    return hash.text();
}

std::string limitsHash(const Motion& motion) {
    PartHash hash;
    for (const Dof& dof : motion.dofs) hash.add(dof.lower).add(dof.upper);
    for (const LimitPlane& plane : motion.planes) {
        for (double coefficient : plane.coefficients) hash.add(coefficient);
        hash.add(plane.bound);
    }
    return hash.text();
}

/// What carries a muscle in one place, but for bones that the skin names itself.
void addCarrying(const SceneModel& scene, const SkinModel& skin, int bone, PartHash& meshes) {
    const Pose toSkin = scene.bodies[skin.body].placement.inverse();
    for (const int k : movingAsOne(scene, bone))
        if (std::ranges::find(skin.bones, k) == skin.bones.end())
            meshes.add(Pose(toSkin * scene.bodies[k].placement)).add(scene.bodies[k].mesh);
}

/// The joints above the bones of a skin: where these can be. Of a skin without bones of its own nothing is
/// added, so that tables of older files stay as they are.
void addBones(const SceneModel& scene, const SkinModel& skin, PartHash& meshes, PartHash& travel) {
    const Pose toSkin = scene.bodies[skin.body].placement.inverse();
    for (int bone : skin.bones)
        meshes.add(Pose(toSkin * scene.bodies[bone].placement)).add(scene.bodies[bone].mesh);
    std::vector<bool> above(scene.bodies.size(), false), seen(scene.joints.size(), false);
    bool spans = false;
    for (const UnderSkin& under : underSkin(scene, skin)) {
        spans = spans || !under.chain.empty();
        if (under.bone >= 0) above[under.bone] = true;
    }
    if (skin.bones.empty() && skin.weights.joints.empty() && !spans) return;
    for (bool again = true; again;) {
        again = false;
        for (std::size_t j = 0; j < scene.joints.size(); ++j) {
            const Joint& joint = scene.joints[j];
            if (seen[j] || !joint.enabled || joint.body1 < 0 || !above[joint.body1]) continue;
            seen[j] = again = true;
            if (joint.body0 >= 0) above[joint.body0] = true;
        }
    }
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
        if (!seen[j]) continue;
        const Motion motion{scene.joints[j].dofs, scene.joints[j].frame0, scene.joints[j].planes};
        travel.add(framesHash(motion)).add(limitsHash(motion)).add(scene.joints[j].frame1);
    }
    for (std::uint32_t index : skin.weights.indices) travel.add(std::uint64_t(index));
    for (double weight : skin.weights.weights) travel.addFloat(weight);
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : "-") + part;
    return text;
}

/// What has changed, from two hashes of the same form and the names of their parts.
std::string difference(const std::string& stored, const std::string& now,
                       const std::vector<std::string>& names) {
    if (stored == now) return "";
    if (stored.empty()) return "its table does not say what it was baked from (tss:sourceHash)";
    if (stored.size() != now.size()) return "its table was baked from something else";
    std::string changed;
    const std::size_t step = now.size() / names.size() + 1;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (stored.compare(k * step, step - 1, now, k * step, step - 1) != 0)
            changed += (changed.empty() ? "" : " and ") + names[k];
    return changed + " changed since its table was baked";
}

/// Some limit of a table's motion lies beyond those that it can have been proven for.
bool isWider(const Motion& made, const Motion& limits) {
    for (std::size_t k = 0; k < std::min(made.dofCount(), limits.dofCount()); ++k)
        if (made.dofs[k].lower < limits.dofs[k].lower || made.dofs[k].upper > limits.dofs[k].upper)
            return true;
    return false;
}

void refuse(const std::string& why, const std::string& path, const std::string& fileName) {
    if (!why.empty()) throw InputError({fileName, "", path}, why + ": expected a fresh table, bake it again");
}

} // namespace

std::string sourceHash(const SceneModel& scene, const Pair& pair, MeshHashes* meshes) {
    const Motion motion = pairMotion(scene, pair);
    return joined({meshHash(scene, pair.bodyA, meshes), meshHash(scene, pair.bodyB, meshes),
                   framesHash(motion), limitsHash(motion), PartHash().add(pair.settings).text()});
}

std::string sourceHash(const SceneModel& scene, const SkinModel& skin) {
    PartHash meshes, forms, travel;
    const Body& body = scene.bodies[skin.body];
    for (int index : skin.muscles) {
        const MuscleModel& model = scene.muscles[index];
        const Muscle& muscle = model.muscle;
        meshes.add(Pose(body.placement.inverse() * scene.bodies[model.body].placement)).add(muscle.surface);
        for (const Vec3& point : muscle.fibre) forms.add(point);
        forms.add(std::uint64_t(muscle.form)).add(muscle.anchor).add(muscle.maxContraction);
        travel.add(muscle.activationLower).add(muscle.activationUpper);
        std::vector<int> bones = muscleChain(scene, model);
        if (!bones.empty()) bones.insert(bones.begin(), model.bone);
        for (const int bone : bones) {
            travel.add(bone < 0 ? Pose::Identity()
                                : Pose(body.placement.inverse() * scene.bodies[bone].placement));
            if (bone >= 0) addCarrying(scene, skin, bone, meshes);
        }
    }
    travel.add(skin.thickness).add(skin.travel);
    addBones(scene, skin, meshes, travel);
    return joined({PartHash().add(body.mesh).text(), meshes.text(), forms.text(), travel.text(),
                   PartHash().add(skin.settings).text()});
}

std::string staleness(const SceneModel& scene, const Pair& pair, MeshHashes* meshes) {
    if (!pair.table && !pair.proof) return "";
    std::string changed = difference(pair.sourceHash, sourceHash(scene, pair, meshes),
                                     {"the mesh of " + scene.bodies[pair.bodyA].path,
                                      "the mesh of " + scene.bodies[pair.bodyB].path, "the joint",
                                      "the limits", "the settings"});
    if (changed.empty() && pair.table && isWider(pair.table->motion, pairMotion(scene, pair)))
        return "its table says that it was made for wider limits than its joints have";
    return changed;
}

std::string staleness(const SceneModel& scene, const SkinModel& skin) {
    if (!skin.table) return "";
    return difference(skin.sourceHash, sourceHash(scene, skin),
                      {"the skin's mesh", "the meshes of the muscles or bones",
                       "the muscles' fibres or forms",
                       skin.bones.empty() && skin.weights.joints.empty()
                           ? "the activations, thickness or travel"
                           : "the activations, thickness, travel, joints or weights",
                       "the settings"});
}

void requireFresh(const SceneModel& scene, const Pair& pair, const std::string& fileName) {
    refuse(staleness(scene, pair), pair.path, fileName);
}

void requireFresh(const SceneModel& scene, const std::string& fileName) {
    MeshHashes meshes;
    for (const Pair& pair : scene.pairs) refuse(staleness(scene, pair, &meshes), pair.path, fileName);
    for (const SkinModel& skin : scene.skins) refuse(staleness(scene, skin), skin.path, fileName);
}

} // namespace tss
