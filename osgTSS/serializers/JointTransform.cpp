#include "Exact.h"

#include "bake/base/Error.h"

#include <osgDB/ObjectWrapper>
#include <osgTSS/JointTransform>

namespace {

using tss::Dof;
using tss::DofKind;
using tss::Joint;
using tss::Pose;
using tss::Vec3;

const std::vector<std::string> kinds{"rotation", "translation", "path"};

std::vector<double> numbers(const Pose& pose) {
    std::vector<double> values;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) values.push_back(pose.matrix()(row, column));
    return values;
}

Pose readPose(osgDB::InputStream& is) {
    const std::vector<double> values = exactValues(is, 12);
    Pose pose = Pose::Identity();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) pose.matrix()(row, column) = values[3 * column + row];
    return pose;
}

void writeDof(osgDB::OutputStream& os, const Dof& dof) {
    writeName(os, dof.name);
    os << std::endl << kinds[static_cast<int>(dof.kind)];
    writeExact(os, {dof.origin.x(), dof.origin.y(), dof.origin.z(), dof.axis.x(), dof.axis.y(), dof.axis.z(),
                    dof.lower, dof.upper, dof.rest});
    std::vector<double> rows;
    for (const tss::PathRow& row : dof.path)
        rows.insert(rows.end(), {row.value, row.translation.x(), row.translation.y(), row.translation.z(),
                                 row.rotation.w(), row.rotation.x(), row.rotation.y(), row.rotation.z()});
    writeExact(os, rows);
    writeExact(os, numbers(dof.frame));
    os << std::endl;
}

Dof readDof(osgDB::InputStream& is) {
    Dof dof;
    std::string kind;
    dof.name = readName(is);
    is >> kind;
    for (std::size_t k = 0; k < kinds.size(); ++k)
        if (kinds[k] == kind) dof.kind = static_cast<DofKind>(k);
    const std::vector<double> v = exactValues(is, 9);
    dof.origin = Vec3(v[0], v[1], v[2]);
    dof.axis = Vec3(v[3], v[4], v[5]);
    dof.lower = v[6];
    dof.upper = v[7];
    dof.rest = v[8];
    const std::vector<double> rows = exactValues(is);
    for (std::size_t i = 0; i + 8 <= rows.size(); i += 8)
        dof.path.push_back({rows[i], Vec3(rows[i + 1], rows[i + 2], rows[i + 3]),
                            Eigen::Quaterniond(rows[i + 4], rows[i + 5], rows[i + 6], rows[i + 7])});
    dof.frame = readPose(is);
    return dof;
}

/// Shorter than what follows can hold: a count in a broken file does not allocate.
unsigned int readCount(osgDB::InputStream& is) {
    constexpr unsigned int most = 4096;
    unsigned int count = 0;
    is >> count;
    if (count > most) is.throwException("osgTSS::JointTransform: expected a count up to 4096");
    return count > most ? 0 : count;
}

} // namespace

static bool checkJoint(const osgTSS::JointTransform&) {
    return true;
}

static bool readJoint(osgDB::InputStream& is, osgTSS::JointTransform& node) {
    Joint joint;
    is >> is.BEGIN_BRACKET;
    joint.path = readName(is);
    joint.frame0 = readPose(is);
    joint.frame1 = readPose(is);
    for (unsigned int k = readCount(is); k > 0; --k) {
        joint.dofs.push_back(readDof(is));
        tss::TimeSamples drive;
        drive.times = exactValues(is);
        drive.values = exactValues(is, static_cast<int>(drive.times.size()));
        joint.drives.push_back(drive);
    }
    for (unsigned int k = readCount(is); k > 0; --k) {
        tss::LimitPlane plane;
        plane.coefficients = exactValues(is, static_cast<int>(joint.dofs.size()));
        plane.bound = exactValues(is, 1)[0];
        joint.planes.push_back(plane);
    }
    const std::vector<double> asked = exactValues(is, static_cast<int>(joint.dofs.size()));
    const std::vector<double> values = exactValues(is, static_cast<int>(joint.dofs.size()));
    is >> is.END_BRACKET;
    try {
        node.setJoint(joint);
    } catch (const tss::InputError& error) {
        is.throwException(std::string("osgTSS::JointTransform: ") + error.what());
        return false;
    }
    node.setValues(asked);
    node.setResolvedValues(values);
    return true;
}

static bool writeJoint(osgDB::OutputStream& os, const osgTSS::JointTransform& node) {
    const Joint& joint = node.getJoint();
    os << os.BEGIN_BRACKET << std::endl;
    writeName(os, joint.path);
    os << std::endl;
    writeExact(os, numbers(joint.frame0));
    writeExact(os, numbers(joint.frame1));
    os << static_cast<unsigned int>(joint.dofs.size()) << std::endl;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        writeDof(os, joint.dofs[k]);
        const tss::TimeSamples drive = k < joint.drives.size() ? joint.drives[k] : tss::TimeSamples{};
        writeExact(os, drive.times);
        writeExact(os, drive.values);
        os << std::endl;
    }
    os << static_cast<unsigned int>(joint.planes.size()) << std::endl;
    for (const tss::LimitPlane& plane : joint.planes) {
        writeExact(os, plane.coefficients);
        writeExact(os, {plane.bound});
        os << std::endl;
    }
    writeExact(os, node.getAskedValues());
    writeExact(os, node.getValues());
    os << os.END_BRACKET << std::endl;
    return true;
}

REGISTER_OBJECT_WRAPPER(osgTSS_JointTransform, new osgTSS::JointTransform, osgTSS::JointTransform,
                        "osg::Object osg::Node osg::Group osg::Transform osgTSS::JointTransform") {
    ADD_USER_SERIALIZER(Joint);
}
