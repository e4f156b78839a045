#include "PerNode.h"
#include "osgTSS/src/SceneCache.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/draw/DrawnVertices.h"
#include "osgTSS/src/extract/SoftParts.h"

#include "bake/base/Error.h"
#include "bake/model/UnderSkin.h"
#include "bake/respond/SkinResponse.h"

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgTSS/Convert>
#include <osgTSS/SkinCallback>

namespace osgTSS {

namespace {

/// What something below a skin moves with.
struct Bone {
    int muscle = -1;                   ///< whose activation it has; -1: none
    osg::observer_ptr<osg::Node> node; ///< null: it does not move with anything
    bool outside = false;              ///< but stands where the graph as a whole does
    tss::Pose restInverse;             ///< skin to bone, at rest
};

/// A skin as it plays below one node.
struct Played {
    std::shared_ptr<const tss::SceneModel> model;
    const tss::SkinModel* skin = nullptr;
    osg::observer_ptr<SkinGeometry> geometry;
    BodyFrame frame;                    ///< of the skin
    std::optional<DrawnVertices> drawn; ///< of a geometry that the skin was made from; else one per vertex
    std::vector<Bone> bones;            ///< one per muscle or bone below the skin
    bool riding = false;                ///< some of them moves with a node
    std::unique_ptr<tss::SkinResponse> response;
    osg::observer_ptr<osgAnimation::MorphGeometry> morph; ///< that makes the skin's own shape; null: none
    std::vector<double> activations;
    std::vector<tss::Pose> poses;
    std::vector<tss::Vec3> shift;                ///< by morph targets
    unsigned int traversal = 0, frameNumber = 0; ///< of the last update
    bool updated = false, written = false;

    Played(osg::Node& owner, const Scene& scene, const std::string& path);
    void findBones(const BodyNodes& nodes);
    void pose(osg::Node& owner);
    void morphed(osg::NodeVisitor& visitor);
    void update(osg::Node& owner, osg::NodeVisitor& visitor, const Scene& scene, double time);
};

Played::Played(osg::Node& owner, const Scene& scene, const std::string& path) : model(scene.shareModel()) {
    const int index = tss::findSkin(*model, path);
    if (index < 0) return;
    skin = &model->skins[index];
    const BodyNodes nodes = findBodyNodes(owner);
    const std::string& body = model->bodies[skin->body].path;
    geometry = nodes.shape(body);
    frame = nodes.frame(body);
    if (!geometry.valid() || !frame.node.valid()) {
        OSG_WARN << "osgTSS: nothing below node \"" << owner.getName() << "\" shows skin " << path
                 << std::endl;
        return;
    }
    const tss::TriangleMesh& mesh = model->bodies[skin->body].mesh;
    if (replacedBy(*geometry)) {
        drawn = DrawnVertices::of(*geometry->getRestGeometry(), mesh, frame.scale, tss::skinNormals(mesh));
        if (!drawn) {
            OSG_WARN << "osgTSS: skin " << path
                     << " does not play: its geometry has other vertices than its mesh" << std::endl;
            return;
        }
    }
    findBones(nodes);
    morph = dynamic_cast<osgAnimation::MorphGeometry*>(replacedBy(*geometry));
    try {
        if (const auto rig = scene.getCache().rig(index)) response = std::make_unique<tss::SkinResponse>(rig);
    } catch (const tss::InputError& error) {
        OSG_WARN << "osgTSS: skin " << path << " does not play: " << error.what() << std::endl;
    }
}

void Played::findBones(const BodyNodes& nodes) {
    const tss::Pose skinInverse = model->bodies[skin->body].placement.inverse(Eigen::Isometry);
    for (const tss::UnderSkin& under : tss::underSkin(*model, *skin)) {
        Bone bone;
        bone.muscle = under.muscle;
        const int body = under.bone;
        const bool along = body < 0 || model->bodies[body].path == carrierPath(*geometry);
        if (!along) bone.node = nodes.frame(model->bodies[body].path).node;
        bone.outside = !along && !bone.node.valid() && drawn; // its root is a transform
        if (bone.node.valid() || bone.outside) {
            bone.restInverse = (skinInverse * model->bodies[body].placement).inverse(Eigen::Isometry);
            riding = true;
        }
        bones.push_back(bone);
    }
}

/// How far each of them has been carried since rest, in the skin's frame. One that was taken out of the graph
/// stays where it was.
void Played::pose(osg::Node& owner) {
    poses.resize(bones.size(), tss::Pose::Identity());
    const std::optional<osg::Matrixd> fromSkin = toAbove(owner, *frame.node);
    if (!fromSkin) return;
    const osg::Matrixd toSkin = osg::Matrixd::inverse(*fromSkin);
    for (std::size_t k = 0; k < bones.size(); ++k) {
        std::optional<osg::Matrixd> fromBone;
        if (bones[k].outside)
            fromBone = osg::Matrixd();
        else if (bones[k].node.valid())
            fromBone = toAbove(owner, *bones[k].node);
        if (fromBone) poses[k] = carriedSince(*fromBone, toSkin, frame.scale, bones[k].restInverse);
    }
}

/// The geometry's own morphing, which its traversal leaves out while it is not drawn.
void Played::morphed(osg::NodeVisitor& visitor) {
    if (osg::Callback* callback = morph->getUpdateCallback()) callback->run(morph.get(), &visitor);
    const auto& rest = static_cast<const osg::Vec3Array&>(*geometry->getRestGeometry()->getVertexArray());
    const auto* now = dynamic_cast<const osg::Vec3Array*>(morph->getVertexArray());
    shift.clear();
    if (!now || now->size() != rest.size()) return;
    for (const std::uint32_t vertex : response->rig().vertices) {
        const std::uint32_t one = drawn->of(vertex).front();
        shift.push_back(frame.scale * toCore((*now)[one] - rest[one]));
    }
}

void Played::update(osg::Node& owner, osg::NodeVisitor& visitor, const Scene& scene, double time) {
    activations.clear();
    for (const Bone& bone : bones)
        activations.push_back(bone.muscle < 0 ? 0 : scene.getActivation(bone.muscle, time));
    if (riding) pose(owner);
    if (morph.valid() && drawn) morphed(visitor);
    const bool moved = response->update(activations, poses, shift).moved;
    if (written && !moved) return;
    written = true; // a copy of a graph is drawn as the graph stood until then
    if (drawn)
        drawn->deform(*geometry, response->rig().vertices, response->positions(), response->normals());
    else
        geometry->deform(response->rig().vertices, response->positions(), response->normals());
}

} // namespace

struct SkinCallback::States : PerNode<Played> {};

SkinCallback::SkinCallback() : _states(std::make_unique<States>()) {}
SkinCallback::~SkinCallback() = default;

SkinCallback::SkinCallback(Scene* scene, std::string skinPath) : SkinCallback() {
    _scene = scene;
    _skinPath = std::move(skinPath);
}

SkinCallback::SkinCallback(const SkinCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), SceneCallback(other, copyop), _skinPath(other._skinPath),
      _states(std::make_unique<States>()) {}

bool SkinCallback::run(osg::Object* object, osg::Object* data) {
    const osg::ref_ptr<SkinCallback> self(this); // an application may take it from its node meanwhile
    const bool result = traverse(object, data);
    osg::Node* node = object ? object->asNode() : nullptr;
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    const osg::FrameStamp* stamp = visitor ? visitor->getFrameStamp() : nullptr;
    if (!node || !stamp || !_scene) return result;
    const MeasureUpdate measure(_scene->getCache().updateTime);
    Played& played = _states->of(
        *node, [&](const Played*) { return std::make_unique<Played>(*node, *_scene, _skinPath); },
        [&](const Played& state) {
            return state.model == _scene->shareModel() &&
                   (!state.response || (state.geometry.valid() && state.frame.node.valid()));
        });
    if (!played.response) return result;
    const unsigned int traversal = visitor->getTraversalNumber(), frame = stamp->getFrameNumber();
    if (played.updated && played.traversal == traversal && played.frameNumber == frame) return result;
    played.updated = true;
    played.traversal = traversal;
    played.frameNumber = frame;
    played.update(*node, *visitor, *_scene, _scene->getClock().timeCode(*stamp));
    return result;
}

} // namespace osgTSS
