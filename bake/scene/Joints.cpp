#include "bake/motion/DofUnits.h"
#include "bake/scene/SceneParts.h"

namespace tss {

namespace {

constexpr Attribute limitPlanes =
    declared("uniform double[] tss:limitPlanes",
             "couplings, rows of a coefficient a DOF and a bound: `c · q <= bound`, q in degrees or units of "
             "value. Planes of a pair that leave no pose, or not the rest, are refused");

const Fields<Joint>& jointFields() {
    static const Fields<Joint> fields{
        schema::body0,
        schema::body1,
        schema::localPos0,
        schema::localPos1,
        schema::localRot0,
        schema::localRot1,
        field("bool physics:jointEnabled", &Joint::enabled, true, anyNumber, ""),
        field("bool physics:collisionEnabled", &Joint::collisionEnabled, false, anyNumber, ""),
        schema::axis,
        schema::lowerLimit,
        schema::upperLimit,
        schema::coneAngle0,
        schema::coneAngle1,
        limitPlanes};
    return fields;
}

/// The joint's frame in a body, whose scale it takes on as the points do.
Pose readFrame(const SceneReading& reading, const PrimReader& prim, int body, const Attribute& position,
               const Attribute& rotation) {
    Pose frame = Pose::Identity();
    Vec3 at = prim.vector(position, Vec3::Zero());
    if (body >= 0) at = stretched(reading.bodyXforms[body], at);
    frame.linear() = prim.rotation(rotation).toRotationMatrix();
    frame.translation() = at;
    return frame;
}

void writeFrame(PrimWriter& prim, const Pose& frame, const Attribute& position, const Attribute& rotation) {
    if (frame.translation() != Vec3::Zero()) prim.set(position, Vec3(frame.translation()));
    if (frame.linear() != Eigen::Matrix3d::Identity())
        prim.set(rotation, Eigen::Quaterniond(frame.linear()).normalized());
}

} // namespace

bool isJoint(const Prim& prim) {
    for (const char* type : {"PhysicsRevoluteJoint", "PhysicsPrismaticJoint", "PhysicsSphericalJoint",
                             "PhysicsFixedJoint", "PhysicsJoint"})
        if (prim.typeName == type) return true;
    return false;
}

bool changes(const Property& property) {
    return property.timeSamples.size() + (property.defaultValue ? 1 : 0) > 1;
}

std::string changingOf(const Prim& joint) {
    for (const auto& [name, property] : joint.properties) {
        const bool ours = name.starts_with("tss:") && !name.starts_with("tss:drive:");
        if (changes(property) && (ours || name.starts_with("physics:") || name.starts_with("limit:")))
            return name;
    }
    return "";
}

std::string jointType(const Joint& joint) {
    if (joint.dofs.empty()) return "PhysicsFixedJoint";
    if (joint.dofs.size() > 1 || joint.dofs[0].kind == DofKind::Path) return "PhysicsJoint";
    return joint.dofs[0].kind == DofKind::Rotation ? "PhysicsRevoluteJoint" : "PhysicsPrismaticJoint";
}

void readPlanes(const PrimReader& prim, Joint& joint) {
    const auto numbers = prim.reals(limitPlanes);
    const std::size_t width = joint.dofs.size() + 1;
    if (numbers.size() % width != 0)
        return prim.problem(limitPlanes, "expected rows of ", width,
                            " numbers: a coefficient a DOF and the bound");
    for (std::size_t at = 0; at < numbers.size(); at += width) {
        LimitPlane plane;
        // A coefficient is divided by what its value is multiplied by.
        for (std::size_t k = 0; k + 1 < width; ++k)
            plane.coefficients.push_back(toUser(joint.dofs[k], numbers[at + k]));
        plane.bound = numbers[at + width - 1];
        joint.planes.push_back(plane);
    }
}

void writePlanes(PrimWriter& prim, const Joint& joint) {
    std::vector<double> rows;
    for (const LimitPlane& plane : joint.planes) {
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            rows.push_back(fromUser(joint.dofs[k], plane.coefficients.at(k)));
        rows.push_back(plane.bound);
    }
    if (!rows.empty()) prim.set(limitPlanes, rows);
}

void readJoints(SceneReading& reading) {
    reading.forPrims(isJoint, [&](const PrimReader& prim, int) {
        Joint joint;
        joint.path = prim.place().path;
        const std::string path0 = prim.target(schema::body0), path1 = prim.target(schema::body1);
        joint.body0 = reading.body(prim, schema::body0, path0);
        joint.body1 = reading.body(prim, schema::body1, path1);
        if (path0.empty() && path1.empty())
            prim.problem(
                "expected physics:body0 or physics:body1: a joint ties two bodies, or one to the world");
        else if (path0 == path1)
            prim.targetProblem(schema::body1, "expected another body than physics:body0, found \"", path1,
                               "\"");
        joint.frame0 = readFrame(reading, prim, joint.body0, schema::localPos0, schema::localRot0);
        joint.frame1 = readFrame(reading, prim, joint.body1, schema::localPos1, schema::localRot1);
        jointFields().read(prim, joint);
        readDofs(prim, joint);
        reading.jointAt[joint.path] = static_cast<int>(reading.scene.joints.size());
        reading.scene.joints.push_back(std::move(joint));
    });
}

void writeJoints(Layer& layer, const SceneModel& scene) {
    for (const Joint& joint : scene.joints) {
        PrimWriter prim(makePrim(layer, joint.path, jointType(joint)));
        if (joint.body0 >= 0) prim.setTargets(schema::body0, {scene.bodies[joint.body0].path});
        if (joint.body1 >= 0) prim.setTargets(schema::body1, {scene.bodies[joint.body1].path});
        writeFrame(prim, joint.frame0, schema::localPos0, schema::localRot0);
        writeFrame(prim, joint.frame1, schema::localPos1, schema::localRot1);
        jointFields().write(prim, joint);
        writeDofs(prim, joint);
    }
}

std::vector<SchemaType> jointSchemas() {
    return {jointFields().schema("PhysicsJoint"), dofSchema()};
}

} // namespace tss
