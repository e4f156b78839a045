#include "bake/base/Degrees.h"
#include "bake/base/Error.h"
#include "bake/scene/DofToken.h"
#include "bake/scene/SceneWriting.h"

#include <algorithm>
#include <set>

namespace tss {

namespace {

/// Along which axis of the joint's frame the DOF lies; throws when along none.
int axisOf(const Dof& dof, const std::string& path) {
    for (int k = 0; k < 3; ++k) {
        const double along = dof.axis[k];
        const bool only = along != 0 && dof.axis == Vec3::Unit(k) * along;
        const bool centred = dof.origin == Vec3::Unit(k) * dof.origin[k];
        if (dof.kind == DofKind::Translation ? only : only && along == 1 && centred) return k;
    }
    throw InputError({"", "", path},
                     "expected rotations about and translations along X, Y or Z of the joint's frame");
}

/// Token and scale (distance per unit of the value) of each DOF.
struct DofSpelling {
    std::string token;
    double scale = 1;
};

std::vector<DofSpelling> spell(const Joint& joint) {
    std::vector<DofSpelling> spellings;
    std::set<std::string> seen;
    int paths = 0;
    for (const Dof& dof : joint.dofs) {
        DofSpelling spelling;
        if (dof.kind == DofKind::Path) {
            if (!dof.frame.matrix().isIdentity(0))
                throw InputError({"", "", joint.path}, "expected a path in the joint's own frame");
            spelling.token = "path" + std::to_string(paths++);
        } else {
            const int axis = axisOf(dof, joint.path);
            spelling.token = dofTokens[axis + (dof.kind == DofKind::Rotation ? 3 : 0)];
            if (dof.kind == DofKind::Translation) spelling.scale = dof.axis[axis];
        }
        if (!seen.insert(spelling.token).second)
            throw InputError({"", "", joint.path}, "expected each DOF of a joint once, found " +
                                                       spelling.token + " again: use two joints");
        spellings.push_back(std::move(spelling));
    }
    return spellings;
}

std::string typeOf(const Joint& joint) {
    if (joint.dofs.empty()) return "PhysicsFixedJoint";
    if (joint.dofs.size() > 1 || joint.dofs[0].kind == DofKind::Path) return "PhysicsJoint";
    return joint.dofs[0].kind == DofKind::Rotation ? "PhysicsRevoluteJoint" : "PhysicsPrismaticJoint";
}

/// In the unit of USD: degrees and distance.
double inFileUnit(const Dof& dof, double value, double scale) {
    return dof.kind == DofKind::Rotation ? toDegrees(value) : value * scale;
}

void writeLimits(PrimWriter& prim, const Dof& dof, const DofSpelling& spelling, bool alone) {
    double low = inFileUnit(dof, dof.lower, spelling.scale),
           high = inFileUnit(dof, dof.upper, spelling.scale);
    if (low > high) std::swap(low, high);
    const std::string base = "limit:" + spelling.token + ":physics:";
    const std::string lowName = alone ? schema::lowerLimit.name : base + "low";
    const std::string highName = alone ? schema::upperLimit.name : base + "high";
    if (std::isfinite(low)) prim.set(Attribute{lowName.c_str(), "float"}, Value(low));
    if (std::isfinite(high)) prim.set(Attribute{highName.c_str(), "float"}, Value(high));
    if (!alone) addApi(prim.prim(), "PhysicsLimitAPI:" + spelling.token);
}

void lockTheRest(PrimWriter& prim, const std::vector<DofSpelling>& spellings) {
    for (const char* token : dofTokens) {
        if (std::any_of(spellings.begin(), spellings.end(), [&](const auto& s) { return s.token == token; }))
            continue;
        addApi(prim.prim(), std::string("PhysicsLimitAPI:") + token);
        const std::string base = std::string("limit:") + token + ":physics:";
        prim.set(Attribute{(base + "low").c_str(), "float"}, Value(1.0));
        prim.set(Attribute{(base + "high").c_str(), "float"}, Value(-1.0));
    }
}

void writeDrive(PrimWriter& prim, const Dof& dof, const DofSpelling& spelling, TimeSamples drive,
                bool alone) {
    if (drive.empty()) return;
    if (dof.kind == DofKind::Path)
        return prim.set(Attribute{("tss:drive:" + spelling.token).c_str(), "double"}, drive);
    for (double& value : drive.values) value = inFileUnit(dof, value, spelling.scale);
    const std::string instance = !alone                          ? spelling.token
                                 : dof.kind == DofKind::Rotation ? "angular"
                                                                 : "linear";
    addApi(prim.prim(), "PhysicsDriveAPI:" + instance);
    prim.set(Attribute{("drive:" + instance + ":physics:targetPosition").c_str(), "float"}, drive);
}

void writePaths(PrimWriter& prim, const Joint& joint) {
    std::vector<double> rows, counts, limits;
    bool limited = false;
    for (const Dof& dof : joint.dofs) {
        if (dof.kind != DofKind::Path) continue;
        counts.push_back(static_cast<double>(dof.path.size()));
        for (const PathRow& row : dof.path)
            rows.insert(rows.end(), {row.value, row.translation.x(), row.translation.y(), row.translation.z(),
                                     row.rotation.w(), row.rotation.x(), row.rotation.y(), row.rotation.z()});
        limits.insert(limits.end(), {dof.lower, dof.upper});
        limited = limited || dof.path.empty() || dof.lower != dof.path.front().value ||
                  dof.upper != dof.path.back().value;
    }
    if (counts.empty()) return;
    prim.set(schema::paths, rows);
    prim.set(schema::pathRows, counts);
    if (limited) prim.set(schema::pathLimits, Value(Numbers{limits, 2}));
}

void writePlanes(PrimWriter& prim, const Joint& joint) {
    std::vector<double> rows;
    for (const LimitPlane& plane : joint.planes) {
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            rows.push_back(joint.dofs[k].kind == DofKind::Rotation ? toRadians(plane.coefficients.at(k))
                                                                   : plane.coefficients.at(k));
        rows.push_back(plane.bound);
    }
    if (!rows.empty()) prim.set(schema::limitPlanes, rows);
}

/// What of ours a joint needs beyond USD's own attributes; nothing for an ordinary hinge or slide.
void writeOurs(PrimWriter& prim, const Joint& joint, const std::vector<DofSpelling>& spellings) {
    std::vector<std::string> tokens, names;
    std::vector<double> scales, rests;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        const Dof& dof = joint.dofs[k];
        tokens.push_back(spellings[k].token);
        names.push_back(dof.name.empty() ? spellings[k].token : dof.name);
        scales.push_back(spellings[k].scale);
        rests.push_back(dof.kind == DofKind::Rotation ? toDegrees(dof.rest) : dof.rest);
    }
    const auto all = [](const std::vector<double>& values, double value) {
        return std::all_of(values.begin(), values.end(), [&](double v) { return v == value; });
    };
    if (typeOf(joint) == "PhysicsJoint") prim.set(schema::dofOrder, tokens);
    if (names != tokens) prim.set(schema::dofNames, names);
    if (!all(scales, 1)) prim.set(schema::dofScale, scales);
    if (!all(rests, 0)) prim.set(schema::rest, rests);
    writePaths(prim, joint);
    writePlanes(prim, joint);
}

void writeFrame(PrimWriter& prim, const Pose& frame, const Attribute& position, const Attribute& rotation) {
    if (frame.translation() != Vec3::Zero()) prim.set(position, Vec3(frame.translation()));
    if (frame.linear() != Eigen::Matrix3d::Identity())
        prim.set(rotation, Eigen::Quaterniond(frame.linear()).normalized());
}

} // namespace

void writeDofs(PrimWriter& prim, const Joint& joint) {
    const auto spellings = spell(joint);
    const std::string type = typeOf(joint);
    const bool alone = type != "PhysicsJoint";
    if (alone && !spellings.empty())
        prim.setUnless(schema::axis, spellings[0].token.substr(spellings[0].token.size() - 1), "X");
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        if (joint.dofs[k].kind != DofKind::Path) writeLimits(prim, joint.dofs[k], spellings[k], alone);
        if (k < joint.drives.size()) writeDrive(prim, joint.dofs[k], spellings[k], joint.drives[k], alone);
    }
    if (!alone) lockTheRest(prim, spellings);
    writeOurs(prim, joint, spellings);
}

void writeJoints(Layer& layer, const SceneModel& scene) {
    for (const Joint& joint : scene.joints) {
        PrimWriter prim(makePrim(layer, joint.path, typeOf(joint)));
        if (joint.body0 >= 0) prim.setTargets(schema::body0, {scene.bodies[joint.body0].path});
        if (joint.body1 >= 0) prim.setTargets(schema::body1, {scene.bodies[joint.body1].path});
        writeFrame(prim, joint.frame0, schema::localPos0, schema::localRot0);
        writeFrame(prim, joint.frame1, schema::localPos1, schema::localRot1);
        prim.setUnless(schema::jointEnabled, Value(joint.enabled), Value(true));
        prim.setUnless(schema::collisionEnabled, Value(joint.collisionEnabled), Value(false));
        writeDofs(prim, joint);
    }
}

} // namespace tss
