#pragma once
// A model as MuJoCo reads it.
#include "tests/robots/Compared.h"

#include <cstring>
#include <memory>
#include <mujoco/mujoco.h>

namespace mujoco {

using namespace tss;

constexpr double rounded = 1e-6; ///< metres and radians that count as the same

inline Vec3 vectorOf(const mjtNum* n) {
    return {n[0], n[1], n[2]};
}

inline Pose poseOf(const mjtNum* place, const mjtNum* turn) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]).normalized().toRotationMatrix();
    pose.translation() = vectorOf(place);
    return pose;
}

struct DeleteModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
    void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;

inline bool isUrdf(const std::string& text) {
    return text.find("<robot") != text.npos;
}

/// Limits are taken from ranges as MuJoCo does since 3.0, where the file does not say otherwise. Of a URDF
/// all links are to be bodies, whatever they weigh.
inline std::string settled(std::string text) {
    const auto root = text.find(isUrdf(text) ? "<robot" : "<mujoco"), end = text.find('>', root);
    if (root == text.npos || end == text.npos || text[end - 1] == '/') return text;
    if (isUrdf(text))
        return text.insert(
            end + 1, "<mujoco><compiler autolimits='true' fusestatic='false' discardvisual='false' "
                     "strippath='true' balanceinertia='true' boundmass='1' boundinertia='1'/></mujoco>");
    if (text.find("autolimits") != text.npos) return text;
    return text.insert(end + 1, "<compiler autolimits='true'/>");
}

inline Model load(const std::string& file, std::string& refusal) {
    auto disk = std::make_unique<mjVFS>();
    mj_defaultVFS(disk.get());
    const std::string text = settled(readWholeFile(file));
    const std::string name = file.substr(file.find_last_of('/') + 1);
    mj_makeEmptyFileVFS(disk.get(), name.c_str(), static_cast<int>(text.size()));
    std::memcpy(disk->filedata[0], text.data(), text.size());
    char error[1000] = "";
    Model model(mj_loadXML(file.c_str(), disk.get(), error, sizeof error));
    mj_deleteVFS(disk.get());
    if (!model) refusal = error;
    return model;
}

inline Solid solidOf(const mjModel& m, int geom) {
    static const std::map<int, RobotShape::Kind> kinds = {
        {mjGEOM_SPHERE, RobotShape::Kind::Sphere},     {mjGEOM_CAPSULE, RobotShape::Kind::Capsule},
        {mjGEOM_CYLINDER, RobotShape::Kind::Cylinder}, {mjGEOM_ELLIPSOID, RobotShape::Kind::Ellipsoid},
        {mjGEOM_BOX, RobotShape::Kind::Box},           {mjGEOM_MESH, RobotShape::Kind::Mesh}};
    Solid solid;
    solid.kind = kinds.at(m.geom_type[geom]);
    solid.size = vectorOf(m.geom_size + 3 * geom);
    solid.place = poseOf(m.geom_pos + 3 * geom, m.geom_quat + 4 * geom);
    if (solid.kind != RobotShape::Kind::Mesh) return solid;
    // They are of single numbers, about their middles.
    solid.rounding = 4 * rounded * (1 + solid.place.translation().norm() + m.geom_rbound[geom]);
    const int mesh = m.geom_dataid[geom];
    for (int f = 0; f < 3 * m.mesh_facenum[mesh]; ++f) {
        const float* v = m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + m.mesh_face[3 * m.mesh_faceadr[mesh] + f]);
        solid.corners.emplace_back(v[0], v[1], v[2]);
    }
    return solid;
}

} // namespace mujoco
