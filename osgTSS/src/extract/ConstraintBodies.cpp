#include "SkeletonMeshes.h"
#include "osgTSS/src/joints/FoundJoint.h"

#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"

#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>

#include <algorithm>
#include <sstream>

// The joints and bodies that the visitor adds to its model where something moves.
namespace osgTSS {

namespace {

std::vector<double> restOf(const tss::Joint& joint) {
    std::vector<double> rest;
    for (const tss::Dof& dof : joint.dofs) rest.push_back(dof.rest);
    return rest;
}

} // namespace

void ConstraintVisitor::enterJoint(osg::Transform& node, FoundJoints found) {
    if (!_seen.insert(&node).second) {
        return warn("the joint is reached over several parents: it was extracted at the first, the others "
                    "follow it, and what they meet is not looked at");
    }
    const auto parent = toSimilarity(_place.toBody);
    if (!parent)
        return warn("what hangs below is left out: the transforms above it shear, or scale axes differently");
    const double off = std::max(found.off, parent->off);
    if (off > 1e-6) {
        std::ostringstream text;
        text << "its matrices are rotations and equal scales to " << off << " only; the nearest are taken";
        warn(text.str());
    }
    const auto list = [&](std::string& all, const std::string& axes) {
        if (!axes.empty()) all += (all.empty() ? "" : ", ") + pathText() + " (" + axes + ")";
    };
    list(_unlimited, found.unlimited);
    list(_turning, found.turning);

    const double scale = _place.scale * parent->scale;
    tss::Pose toBody0 = parent->pose;
    toBody0.translation() *= _place.scale;
    int body = _place.body;
    for (std::size_t k = 0; k < found.joints.size(); ++k) {
        tss::Joint& joint = found.joints[k];
        // What the node's own scale enlarges is below the last joint.
        scaleLengths(joint, scale);
        joint.frame0 = toBody0 * joint.frame0;
        toBody0 = tss::Pose::Identity();
        joint.path = freePath(node.getName().empty() ? "Joint" : node.getName());
        const bool last = k + 1 == found.joints.size();
        body = addJoint(joint, body, node, last ? scale * found.scale : 0);
    }
    enter(node, {body, osg::Matrixd(), scale * found.scale, _place.visible, _place.color});
}

/// Adds the joint and the body that it moves, and returns that. scale: of the node's children to the body; 0:
/// a body between two joints of one node.
int ConstraintVisitor::addJoint(tss::Joint joint, int body0, osg::Node& node, double scale) {
    const int index = static_cast<int>(_model.joints.size());
    joint.body0 = body0;
    _model.joints.push_back(joint);
    _jointNodes.push_back(&node);
    const int body1 = addBody(node, "Body", scale);
    if (scale == 0) _bodyNodes.back().node = nullptr;
    _model.joints[index].body1 = body1;
    _model.bodies[body0].rigid = _model.bodies[body1].rigid = true;
    _jointAbove[body1] = index;
    _model.bodies[body1].placement = _model.bodies[body0].placement * tss::jointPose(joint, restOf(joint));
    return body1;
}

void ConstraintVisitor::enterMoved(osg::Transform& node, const osg::Matrixd& matrix) {
    const auto similarity = toSimilarity(matrix);
    if (!similarity)
        return warn("what hangs below is left out: it moves, and shears or scales axes differently");
    const double scale = _place.scale * similarity->scale;
    tss::Pose local = similarity->pose;
    local.translation() *= _place.scale;
    const tss::Pose above = _model.bodies[_place.body].placement;
    const int body = addBody(node, "Moved", scale);
    _model.bodies[body].placement = above * local;
    enter(node, {body, osg::Matrixd(), scale, _place.visible, _place.color});
}

int ConstraintVisitor::addBody(osg::Node& node, const char* fallback, double scale) {
    tss::Body body;
    const std::string& name = node.getName();
    body.path = freePath(name.empty() ? fallback : name + "Body");
    body.displayName = name;
    _model.bodies.push_back(body);
    _bodyNodes.push_back({&node, scale});
    _groups.emplace_back();
    _dropped.push_back(0);
    _jointAbove.push_back(-1);
    _skeletonOf.push_back(_skeleton ? &_skeleton->skeleton() : nullptr);
    return static_cast<int>(_model.bodies.size()) - 1;
}

/// As tss::freePrimName(), which looks through the whole scene for each: too slow for all pairs of many
/// bodies.
std::string ConstraintVisitor::freePath(const std::string& wanted) {
    const std::string stem = "/" + _model.defaultPrim + "/" + tss::freePrimName(tss::SceneModel{}, wanted);
    std::string path = stem;
    for (int& number = _numbers[stem]; !_paths.insert(path).second;)
        path = stem + std::to_string(number = std::max(number + 1, 2));
    return path;
}

} // namespace osgTSS
