#include "CollectTriangles.h"
#include "DofTransformJoint.h"

#include "bake/base/Error.h"
#include "bake/scene/AddPair.h"
#include "bake/scene/Kinematics.h"

#include <osg/Geometry>
#include <osg/LOD>
#include <osg/Material>
#include <osg/Notify>
#include <osg/Switch>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/JointTransform>

#include <algorithm>

namespace osgTSS {

namespace {

const osg::Material* materialOf(const osg::Node& node) {
    const osg::StateSet* state = node.getStateSet();
    return state ? dynamic_cast<const osg::Material*>(state->getAttribute(osg::StateAttribute::MATERIAL))
                 : nullptr;
}

/// The colour of a geometry's first vertex, where its material does not say otherwise.
std::optional<osg::Vec4> vertexColor(const osg::Drawable& drawable) {
    const osg::Geometry* geometry = drawable.asGeometry();
    const osg::Array* colors = geometry ? geometry->getColorArray() : nullptr;
    if (!colors || colors->getNumElements() == 0) return std::nullopt;
    if (const auto* floats = dynamic_cast<const osg::Vec4Array*>(colors)) return floats->front();
    if (const auto* bytes = dynamic_cast<const osg::Vec4ubArray*>(colors)) {
        const osg::Vec4ub& c = bytes->front();
        return osg::Vec4(c.r(), c.g(), c.b(), c.a()) / 255.0f;
    }
    return std::nullopt;
}

void scaleLengths(tss::Joint& joint, double scale) {
    if (scale == 1) return;
    joint.frame0.translation() *= scale;
    joint.frame1.translation() *= scale;
    for (tss::Dof& dof : joint.dofs) {
        dof.origin *= scale;
        if (dof.kind == tss::DofKind::Translation) dof.axis *= scale;
        dof.frame.translation() *= scale;
        for (tss::PathRow& row : dof.path) row.translation *= scale;
    }
}

std::vector<double> restOf(const tss::Joint& joint) {
    std::vector<double> rest;
    for (const tss::Dof& dof : joint.dofs) rest.push_back(dof.rest);
    return rest;
}

} // namespace

ConstraintVisitor::ConstraintVisitor(Pairs pairs) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _pairs(pairs) {
    setNodeMaskOverride(~0u);
}

void ConstraintVisitor::enter(osg::Node& node, const Place& place) {
    const Place above = _place;
    _place = place;
    _place.visible = place.visible && node.getNodeMask() != 0;
    const osg::Material* material = materialOf(node);
    if (material && material->getColorMode() == osg::Material::OFF)
        _place.color = material->getDiffuse(osg::Material::FRONT);
    if (_place.body < 0) { // the first node: what no joint moves
        _model.defaultPrim = tss::freePrimName(_model, node.getName().empty() ? "Scene" : node.getName());
        _place.body = addBody(node, "World");
    }
    traverse(node);
    _place = above;
}

void ConstraintVisitor::apply(osg::Node& node) {
    enter(node, _place);
}

void ConstraintVisitor::apply(osg::Transform& node) {
    if (auto* joint = dynamic_cast<JointTransform*>(&node)) {
        if (_place.body < 0) _place.body = addBody(node, "World");
        tss::Joint extracted = joint->getJoint();
        for (std::size_t k = 0; k < extracted.dofs.size(); ++k) extracted.dofs[k].rest = joint->getValue(k);
        return enterJoint(node, std::move(extracted));
    }
    if (auto* dof = dynamic_cast<osgSim::DOFTransform*>(&node)) {
        if (_place.body < 0) _place.body = addBody(node, "World");
        try {
            return enterJoint(node, jointOf(*dof, _model.timeCodesPerSecond));
        } catch (const tss::InputError& error) {
            refuse(error.message);
        }
    }
    osg::Matrix matrix =
        node.getReferenceFrame() == osg::Transform::RELATIVE_RF ? _place.toBody : osg::Matrixd();
    node.computeLocalToWorldMatrix(matrix, this);
    if (node.getUpdateCallback() || node.getDataVariance() == osg::Object::DYNAMIC)
        return enterMoved(node, matrix);
    Place place = _place;
    place.toBody = matrix;
    enter(node, place);
}

void ConstraintVisitor::apply(osg::Switch& node) {
    const Place above = _place;
    enter(node, above);
}

void ConstraintVisitor::apply(osg::LOD& node) {
    if (node.getNumChildren() == 0) return;
    // The finest level: seen from nearest, or covering the most pixels.
    unsigned int finest = 0;
    const bool pixels = node.getRangeMode() == osg::LOD::PIXEL_SIZE_ON_SCREEN;
    for (unsigned int i = 1; i < std::min(node.getNumChildren(), node.getNumRanges()); ++i)
        if (pixels ? node.getMaxRange(i) > node.getMaxRange(finest)
                   : node.getMinRange(i) < node.getMinRange(finest))
            finest = i;
    node.getChild(finest)->accept(*this);
}

void ConstraintVisitor::apply(osg::Drawable& drawable) {
    Place place = _place;
    enter(drawable, place);
    if (_place.body < 0) return;
    tss::Body& body = _model.bodies[_place.body];
    const bool first = body.mesh.empty();
    collectTriangles(drawable, place.toBody, place.scale, body.mesh);
    if (body.mesh.empty()) return;
    const bool visible = place.visible && drawable.getNodeMask() != 0;
    body.visible = first ? visible : body.visible || visible;
    if (!first) return;
    const osg::Material* material = materialOf(drawable);
    std::optional<osg::Vec4> color = place.color;
    if (material && material->getColorMode() == osg::Material::OFF)
        color = material->getDiffuse(osg::Material::FRONT);
    if (!color) color = vertexColor(drawable);
    if (color) body.displayColor = toLinearColor(*color);
}

void ConstraintVisitor::enterJoint(osg::Transform& node, tss::Joint joint) {
    if (!_seen.insert(&node).second) {
        OSG_NOTICE << "osgTSS: joint " << pathText()
                   << " is reached over several parents; it was extracted at the first, the others follow it"
                   << std::endl;
        return;
    }
    if (node.getReferenceFrame() != osg::Transform::RELATIVE_RF)
        refuse("expected a transform relative to its parent");
    const auto parent = toSimilarity(_place.toBody);
    if (!parent) refuse("the transforms above it mirror, or scale axes differently: expected equal scales");

    const int body0 = _place.body;
    const double scale = _place.scale * parent->scale;
    scaleLengths(joint, scale);
    tss::Pose toBody0 = parent->pose;
    toBody0.translation() *= _place.scale;
    joint.frame0 = toBody0 * joint.frame0;
    joint.body0 = body0;
    joint.path = "/" + _model.defaultPrim + "/" +
                 tss::freePrimName(_model, node.getName().empty() ? "Joint" : node.getName());
    const int index = static_cast<int>(_model.joints.size());
    _model.joints.push_back(joint);
    _jointNodes.push_back(&node);

    const int body1 = addBody(node, "Body");
    _model.joints[index].body1 = body1;
    _model.bodies[body0].rigid = _model.bodies[body1].rigid = true;
    _jointAbove[body1] = index;
    _model.bodies[body1].placement = _model.bodies[body0].placement * tss::jointPose(joint, restOf(joint));

    Place place;
    place.body = body1;
    place.scale = scale;
    place.visible = _place.visible;
    place.color = _place.color;
    enter(node, place);
}

void ConstraintVisitor::enterMoved(osg::Transform& node, const osg::Matrixd& matrix) {
    const auto similarity = toSimilarity(matrix);
    if (!similarity)
        refuse("a transform that moves mirrors, or scales axes differently: expected equal scales");
    Place place = _place;
    const tss::Pose above = _place.body < 0 ? tss::Pose::Identity() : _model.bodies[_place.body].placement;
    place.body = addBody(node, "Moved");
    place.scale = _place.scale * similarity->scale;
    place.toBody = osg::Matrixd();
    tss::Pose local = similarity->pose;
    local.translation() *= _place.scale;
    _model.bodies[place.body].placement = above * local;
    enter(node, place);
}

int ConstraintVisitor::addBody(const osg::Node& node, const char* fallback) {
    tss::Body body;
    const std::string& name = node.getName();
    body.path =
        "/" + _model.defaultPrim + "/" + tss::freePrimName(_model, name.empty() ? fallback : name + "Body");
    body.displayName = name;
    _model.bodies.push_back(body);
    _jointAbove.push_back(-1);
    return static_cast<int>(_model.bodies.size()) - 1;
}

std::vector<int> ConstraintVisitor::jointsToTop(int body) const {
    std::vector<int> joints;
    for (int joint = _jointAbove[body]; joint >= 0; joint = _jointAbove[_model.joints[joint].body0])
        joints.push_back(joint);
    return joints;
}

void ConstraintVisitor::addPairs() {
    const auto add = [&](int a, int b) {
        std::vector<int> up = jointsToTop(a), down = jointsToTop(b);
        while (!up.empty() && !down.empty() && up.back() == down.back()) {
            up.pop_back();
            down.pop_back();
        }
        tss::Pair pair;
        pair.bodyA = a;
        pair.bodyB = b;
        pair.joints = up;
        pair.joints.insert(pair.joints.end(), down.rbegin(), down.rend());
        pair.path = pair.joints.size() == 1
                        ? _model.joints[pair.joints[0]].path
                        : "/" + _model.defaultPrim + "/" +
                              tss::freePrimName(_model, _model.bodies[b].displayName + "Pair");
        _model.pairs.push_back(pair);
    };
    const int count = static_cast<int>(_model.bodies.size());
    const auto top = [&](int body) {
        while (_jointAbove[body] >= 0) body = _model.joints[_jointAbove[body]].body0;
        return body;
    };
    const auto nextAbove = [&](int body) {
        do body = _jointAbove[body] < 0 ? -1 : _model.joints[_jointAbove[body]].body0;
        while (body >= 0 && _model.bodies[body].mesh.empty());
        return body;
    };
    for (int b = 0; b < count; ++b) {
        if (_model.bodies[b].mesh.empty() || _jointAbove[b] < 0) continue;
        if (_pairs == ALL) {
            for (int a = 0; a < b; ++a)
                if (!_model.bodies[a].mesh.empty() && top(a) == top(b)) add(a, b);
            continue;
        }
        if (const int a = nextAbove(b); a >= 0) add(a, b);
        if (_pairs != SIBLINGS) continue;
        for (int a = 0; a < b; ++a)
            if (!_model.bodies[a].mesh.empty() && _jointAbove[a] >= 0 &&
                _model.joints[_jointAbove[a]].body0 == _model.joints[_jointAbove[b]].body0)
                add(a, b);
    }
}

const tss::SceneModel& ConstraintVisitor::getModel() {
    if (_finished) return _model;
    _finished = true;
    addPairs();
    for (const tss::Joint& joint : _model.joints)
        for (const tss::TimeSamples& drive : joint.drives)
            if (!drive.empty()) _model.endTimeCode = std::max(_model.endTimeCode, drive.times.back());
    return _model;
}

std::string ConstraintVisitor::pathText() const {
    std::string text;
    for (const osg::Node* node : getNodePath())
        text += "/" + (node->getName().empty() ? std::string(node->className()) : node->getName());
    return text;
}

void ConstraintVisitor::refuse(const std::string& why) const {
    throw tss::InputError({"", "", pathText()}, why);
}

} // namespace osgTSS
