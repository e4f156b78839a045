#include "bake/scene/SceneReading.h"

namespace tss {

namespace {

/// The joint's frame in a body, whose scale it takes on as the points do.
Pose readFrame(const SceneReading& reading, const PrimReader& prim, int body, const Attribute& position,
               const Attribute& rotation) {
    Pose frame = Pose::Identity();
    Vec3 at = prim.vector(position, Vec3::Zero());
    if (body >= 0 && reading.bodyXforms[body].stretched) at = reading.bodyXforms[body].stretch * at;
    frame.linear() = prim.rotation(rotation).toRotationMatrix();
    frame.translation() = at;
    return frame;
}

Joint readJoint(const SceneReading& reading, const PrimReader& prim) {
    Joint joint;
    joint.path = prim.place().path;
    const std::string path0 = prim.target(schema::body0), path1 = prim.target(schema::body1);
    joint.body0 = reading.body(prim, schema::body0, path0);
    joint.body1 = reading.body(prim, schema::body1, path1);
    if (path0.empty() && path1.empty())
        prim.problem("expected physics:body0 or physics:body1: a joint ties two bodies, or one to the world");
    else if (path0 == path1)
        reading.problems.add(prim.placeOf(schema::body1, "targetPaths"),
                             "expected another body than physics:body0, found \"" + path1 + "\"");
    joint.frame0 = readFrame(reading, prim, joint.body0, schema::localPos0, schema::localRot0);
    joint.frame1 = readFrame(reading, prim, joint.body1, schema::localPos1, schema::localRot1);
    joint.enabled = prim.flag(schema::jointEnabled, true);
    joint.collisionEnabled = prim.flag(schema::collisionEnabled, false);
    readDofs(prim, joint);
    return joint;
}

} // namespace

bool isJoint(const Prim& prim) {
    for (const char* type : {"PhysicsRevoluteJoint", "PhysicsPrismaticJoint", "PhysicsSphericalJoint",
                             "PhysicsFixedJoint", "PhysicsJoint"})
        if (prim.typeName == type) return true;
    return false;
}

void readJoints(SceneReading& reading) {
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        if (!isJoint(*reading.index.entries[i].prim)) continue;
        Joint joint = readJoint(reading, reading.reader(static_cast<int>(i)));
        reading.jointAt[joint.path] = static_cast<int>(reading.scene.joints.size());
        reading.scene.joints.push_back(std::move(joint));
    }
}

} // namespace tss
