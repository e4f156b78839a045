#include "CollectTriangles.h"
#include "MovedNodes.h"
#include "SkeletonMeshes.h"
#include "SoftParts.h"
#include "SoftTags.h"
#include "TagCheck.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/UserValues.h"
#include "osgTSS/src/joints/AnimationChannels.h"
#include "osgTSS/src/joints/BoneMotion.h"
#include "osgTSS/src/joints/JointKinds.h"
#include "osgTSS/src/joints/JointNodes.h"

#include "bake/base/Error.h"
#include "bake/model/AddPair.h"

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/Material>
#include <osg/Notify>
#include <osg/PagedLOD>
#include <osg/Projection>
#include <osg/ValueObject>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/Overlay>
#include <osgText/TextBase>

#include <algorithm>

namespace osgTSS {

namespace {

/// What the material of a node says, where it has one and vertices do not say otherwise.
std::optional<osg::Vec4> materialColor(const osg::Node& node) {
    const osg::StateSet* state = node.getStateSet();
    const osg::StateAttribute* found = state ? state->getAttribute(osg::StateAttribute::MATERIAL) : nullptr;
    const auto* material = dynamic_cast<const osg::Material*>(found);
    if (!material || material->getColorMode() != osg::Material::OFF) return std::nullopt;
    return material->getDiffuse(osg::Material::FRONT);
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

bool holdsJoints(osg::Node& node) {
    bool found = false;
    eachNode(node, [&](osg::Node& below) {
        found = found || (below.asTransform() && (movesItself(below) || saysJoint(below)));
    });
    return found;
}

} // namespace

ConstraintVisitor::ConstraintVisitor(Pairs pairs)
    : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _pairs(pairs), _owned(std::make_unique<tss::SceneModel>()),
      _model(*_owned), _soft(std::make_unique<SoftParts>()) {
    setNodeMaskOverride(~0u);
}

ConstraintVisitor::~ConstraintVisitor() = default;

/// At the first node: the body that no joint moves. False for a node that is drawn, but no part of any body.
bool ConstraintVisitor::begin(osg::Node& node) {
    const bool counts = !hasFlag(node, "osgTSS:ignored");
    if (!_model.bodies.empty()) return counts;
    _channels = std::make_unique<AnimationChannels>(node);
    _model.defaultPrim = tss::freePrimName(_model, node.getName().empty() ? "Scene" : node.getName());
    _place.body = addBody(node, "World", 1);
    if (node.asTransform()) _bodyNodes.back().node = nullptr; // the node's own frame is another
    return counts;
}

void ConstraintVisitor::enter(osg::Node& node, const PlaceInBody& place) {
    const PlaceInBody above = _place;
    _place = place;
    _place.visible = place.visible && node.getNodeMask() != 0;
    if (_skeleton) _skeleton->addNode(node, place);
    if (const auto color = materialColor(node)) _place.color = color;
    for (const std::string& wrong : wrongTags(node)) warn(wrong);
    std::string group;
    if (node.getUserValue("osgTSS:collides", group)) _groups[_place.body].insert(group);
    if (const auto skins = tagWords(node, boneTag))
        _soft->bones.push_back({_place.body, node.getName(), wordsOf(*skins)});
    if (auto* levels = dynamic_cast<osg::LOD*>(&node))
        traverseLevels(*levels);
    else
        traverse(node);
    _place = above;
}

void ConstraintVisitor::apply(osg::Node& node) {
    if (!dynamic_cast<Overlay*>(&node) && begin(node)) enter(node, _place);
}

void ConstraintVisitor::apply(osg::Transform& node) {
    if (!begin(node)) return;
    if (dynamic_cast<osgAnimation::Skeleton*>(&node)) return applySkeleton(node);
    applyTransform(node);
}

void ConstraintVisitor::applyTransform(osg::Transform& node) {
    // Turns to the eye, or is placed before it: no motion of a body.
    if (dynamic_cast<osg::AutoTransform*>(&node) || node.getReferenceFrame() != osg::Transform::RELATIVE_RF) {
        if (saysJoint(node) && _seen.insert(&node).second)
            warn("it is no joint, as it turns to the eye or is placed before it: expected a transform with "
                 "RELATIVE_RF that is no AutoTransform");
        return;
    }
    std::string why;
    const bool still = hasFlag(node, "osgTSS:static"), moved = hasFlag(node, "osgTSS:moved");
    try {
        if (!still)
            if (auto found = jointsOf(node, *_channels, _model.timeCodesPerSecond, why))
                return enterJoint(node, std::move(*found));
    } catch (const tss::InputError& error) {
        why = error.message;
    }
    if (!why.empty() && _seen.insert(&node).second) warn("it moves, but is no joint: " + why);
    osg::Matrix matrix = _place.toBody;
    const auto stands = standingBone(node);
    const bool moves = !still && ((movesItself(node) && !stands) || moved || !why.empty());
    auto* bone = dynamic_cast<osgAnimation::Bone*>(&node);
    const auto bound = moves && bone ? boneBound(*bone) : std::nullopt;
    if (bound)
        matrix = *bound * matrix;
    else if (stands && !still && why.empty())
        matrix = *stands * matrix;
    else
        node.computeLocalToWorldMatrix(matrix, this);
    if (moves) return enterMoved(node, matrix);
    PlaceInBody place = _place;
    place.toBody = matrix;
    enter(node, place);
}

/// Draws on what the eye sees, or a picture of its own.
void ConstraintVisitor::apply(osg::Camera& node) {
    if (node.getReferenceFrame() == osg::Transform::RELATIVE_RF && node.getBufferAttachmentMap().empty())
        apply(static_cast<osg::Transform&>(node));
}

/// A picture before the scene, in lengths of its own.
void ConstraintVisitor::apply(osg::Projection&) {}

void ConstraintVisitor::apply(osg::Billboard&) {}

/// Visits the finest level, the one seen from nearest or covering the most pixels, and those that are drawn
/// together with it at some distance.
void ConstraintVisitor::traverseLevels(osg::LOD& node) {
    const auto* paged = dynamic_cast<const osg::PagedLOD*>(&node);
    if (paged && paged->getNumFileNames() > paged->getNumChildren()) count(_paging);
    const unsigned int levels = std::min(node.getNumChildren(), node.getNumRanges());
    const bool pixels = node.getRangeMode() == osg::LOD::PIXEL_SIZE_ON_SCREEN;
    unsigned int finest = 0;
    for (unsigned int i = 1; i < levels; ++i)
        if (pixels ? node.getMaxRange(i) > node.getMaxRange(finest)
                   : node.getMinRange(i) < node.getMinRange(finest))
            finest = i;
    for (unsigned int i = 0; i < levels; ++i) {
        osg::Node& level = *node.getChild(i);
        const bool together =
            node.getMinRange(i) < node.getMaxRange(finest) && node.getMinRange(finest) < node.getMaxRange(i);
        if (i == finest || together)
            level.accept(*this);
        else if (holdsJoints(level) && _seen.insert(&level).second)
            warn("the joints of its coarser level \"" + level.getName() + "\" are not served");
    }
}

void ConstraintVisitor::apply(osg::Drawable& drawable) {
    if (!begin(drawable)) return;
    const auto* text = dynamic_cast<const osgText::TextBase*>(&drawable);
    if (text && text->getAutoRotateToScreen()) return; // as an osg::AutoTransform
    if (drawsByShader(drawable)) count(_shaded);
    const PlaceInBody place = _place;
    enter(drawable, place);
    if (addSoft(drawable)) return;
    if (auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(&drawable); rig && _skeleton)
        return _skeleton->addRig(*rig, getNodePath(), _place);
    tss::Body& body = _model.bodies[_place.body];
    const bool first = body.mesh.empty();
    _dropped[_place.body] += collectTriangles(drawable, place.toBody, place.scale, body.mesh);
    if (!body.mesh.empty()) addLook(drawable, place, first);
}

/// first: the body shows nothing else yet.
void ConstraintVisitor::addLook(const osg::Drawable& drawable, const PlaceInBody& place, bool first) {
    tss::Body& body = _model.bodies[place.body];
    const bool visible = place.visible && drawable.getNodeMask() != 0;
    body.visible = first ? visible : body.visible || visible;
    if (!first) return;
    std::optional<osg::Vec4> color = materialColor(drawable);
    if (!color) color = place.color;
    if (!color) color = vertexColor(drawable);
    if (color) body.displayColor = toLinearColor(*color);
}

/// Bones first, whatever order they have: a mesh is cut when all that hold it are known.
void ConstraintVisitor::applySkeleton(osg::Transform& node) {
    std::unique_ptr<SkeletonMeshes> outer = std::move(_skeleton);
    _skeleton = std::make_unique<SkeletonMeshes>(node);
    applyTransform(node);
    for (const SkeletonMeshes::Skin& skin : _skeleton->skins) {
        const std::size_t torn =
            _soft->setWeights(_model, skin.body, *skin.rig, skin.scale,
                              [&](const std::string& bone) { return _skeleton->bodyOf(bone); });
        if (torn > 0)
            warn("skin " + skin.rig->getName() + ": at " + std::to_string(torn) +
                 " places of it stand vertices that different bones hold, and go on to move as one");
    }
    for (const auto& [index, part] : _skeleton->parts()) {
        tss::Body& body = _model.bodies[index];
        const bool first = body.mesh.empty();
        const int offset = static_cast<int>(body.mesh.vertices.size());
        body.mesh.vertices.insert(body.mesh.vertices.end(), part.mesh.vertices.begin(),
                                  part.mesh.vertices.end());
        for (const tss::Tri& triangle : part.mesh.triangles)
            body.mesh.triangles.push_back(triangle + tss::Tri::Constant(offset));
        _dropped[index] += part.dropped;
        if (body.mesh.empty()) continue;
        PlaceInBody place = part.rig->place;
        place.body = index;
        addLook(*part.rig->geometry, place, first);
    }
    _skeleton = std::move(outer);
}

std::string ConstraintVisitor::pathText() const {
    std::string text;
    for (const osg::Node* node : getNodePath())
        text += "/" + (node->getName().empty() ? std::string(node->className()) : node->getName());
    return text;
}

void ConstraintVisitor::count(Some& some) const {
    if (some.count++ == 0) some.first = pathText();
}

void ConstraintVisitor::warn(const std::string& why) const {
    if (!_quiet) OSG_WARN << "osgTSS: " << pathText() << ": " << why << std::endl;
}

} // namespace osgTSS
