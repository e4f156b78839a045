#include "FoundJoint.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/WholeTurn.h"

#include <osgTSS/Convert>
#include <osgTSS/JointTransform>

#include <cmath>

namespace osgTSS {

struct JointTransform::Description {
    tss::Joint joint;
    tss::Motion limits; ///< its DOFs and couplings again, as clampToLimits() wants them
};

JointTransform::JointTransform() : _joint(std::make_unique<Description>()) {
    setDataVariance(DYNAMIC);
}

JointTransform::~JointTransform() = default;

JointTransform::JointTransform(const tss::Joint& joint) : JointTransform() {
    setJoint(joint);
}

JointTransform::JointTransform(const JointTransform& other, const osg::CopyOp& copyop)
    : osg::Transform(other, copyop), _joint(std::make_unique<Description>(*other._joint)),
      _asked(other._asked), _values(other._values), _matrix(other._matrix), _inverse(other._inverse) {}

void JointTransform::setJoint(const tss::Joint& joint) {
    for (const tss::Dof& dof : joint.dofs)
        if (!(dof.lower <= dof.upper))
            throw tss::InputError({"", "", joint.path},
                                  "DOF '" + dof.name + "': expected lower limit <= upper limit");
    _joint->joint = joint;
    _joint->limits.dofs = joint.dofs;
    _joint->limits.planes = joint.planes;
    _asked = _values = tss::restValues(_joint->limits);
    update();
}

const tss::Joint& JointTransform::getJoint() const {
    return _joint->joint;
}

void JointTransform::setPath(const std::string& path) {
    _joint->joint.path = path;
}

const tss::Dof& JointTransform::getDof(unsigned int i) const {
    return _joint->joint.dofs[i];
}

void JointTransform::setFrames(const osg::Matrixd& toParent, const osg::Matrixd& toChild) {
    const tss::Pose frame0 = rigid(toParent, "frame of a joint"), frame1 = rigid(toChild, "frame of a joint");
    _joint->joint.frame0 = frame0;
    _joint->joint.frame1 = frame1;
    update();
}

unsigned int JointTransform::addDof(tss::DofKind kind, char axis, double lower, double upper, double rest) {
    if (axis < 'X' || axis > 'Z') throw tss::InputError("axis of a joint: expected X, Y or Z");
    tss::Dof dof;
    dof.name = (kind == tss::DofKind::Rotation ? "rot" : "trans") + std::string(1, axis);
    dof.kind = kind;
    dof.axis = tss::Vec3::Unit(axis - 'X');
    dof.lower = lower;
    dof.upper = upper;
    dof.rest = rest;
    if (!(lower <= rest && rest <= upper))
        throw tss::InputError("DOF '" + dof.name + "': expected lower limit <= rest <= upper limit");
    _joint->joint.dofs.push_back(dof);
    for (tss::LimitPlane& plane : _joint->joint.planes) plane.coefficients.push_back(0);
    _joint->limits.dofs = _joint->joint.dofs;
    _joint->limits.planes = _joint->joint.planes;
    _asked.push_back(rest);
    _values.push_back(rest);
    update();
    return getNumDofs() - 1;
}

unsigned int JointTransform::addRotation(char axis, double lower, double upper, double rest) {
    return addDof(tss::DofKind::Rotation, axis, lower, upper, rest);
}

unsigned int JointTransform::addTranslation(char axis, double lower, double upper, double rest) {
    return addDof(tss::DofKind::Translation, axis, lower, upper, rest);
}

void JointTransform::setValues(const std::vector<double>& asked) {
    std::vector<double> wish = _asked;
    for (std::size_t k = 0; k < wish.size() && k < asked.size(); ++k)
        if (std::isfinite(asked[k])) wish[k] = asked[k];
    tss::wrapTurns(_joint->limits, wish);
    _asked = tss::clampToLimits(_joint->limits, wish);
    setResolvedValues(_asked);
}

void JointTransform::setValue(unsigned int i, double asked) {
    std::vector<double> wish = _asked;
    wish.at(i) = asked;
    setValues(wish);
}

void JointTransform::setResolvedValues(const std::vector<double>& values) {
    if (values == _values) return;
    _values = values;
    _values.resize(_joint->joint.dofs.size());
    update();
}

void JointTransform::update() {
    const tss::Pose pose = tss::jointPose(_joint->joint, _values);
    _matrix = toOsg(pose);
    _inverse = toOsg(pose.inverse(Eigen::Isometry));
    dirtyBound();
}

bool JointTransform::computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor*) const {
    if (_referenceFrame == RELATIVE_RF)
        matrix.preMult(_matrix);
    else
        matrix = _matrix;
    return true;
}

bool JointTransform::computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor*) const {
    if (_referenceFrame == RELATIVE_RF)
        matrix.postMult(_inverse);
    else
        matrix = _inverse;
    return true;
}

} // namespace osgTSS
