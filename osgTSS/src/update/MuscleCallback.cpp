#include "PerNode.h"
#include "osgTSS/src/SceneCache.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/draw/DrawnVertices.h"
#include "osgTSS/src/extract/SoftParts.h"
#include "osgTSS/src/extract/SoftTags.h"

#include "bake/base/Error.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleSpan.h"

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/ValueObject>
#include <osgTSS/MuscleCallback>
#include <osgTSS/SkinGeometry>

#include <algorithm>
#include <limits>
#include <optional>

namespace osgTSS {

namespace {

/// The number that the application has written on a drawable; nothing where it has not.
std::optional<double> writtenOn(const osg::Drawable* drawable) {
    double wide = 0;
    float narrow = 0;
    if (drawable && drawable->getUserValue(activationTag, wide)) return wide;
    if (drawable && drawable->getUserValue(activationTag, narrow)) return narrow;
    return std::nullopt;
}

/// What the application asks for: what it has written last, on its own drawable or on the geometry that
/// stands there under its name.
struct Asked {
    std::optional<double> value, here, own;

    void look(SkinGeometry& geometry) {
        const std::optional<double> nowHere = writtenOn(&geometry), nowOwn = writtenOn(replacedBy(geometry));
        if (nowHere != here)
            value = nowHere;
        else if (nowOwn != own)
            value = nowOwn;
        here = nowHere;
        own = nowOwn;
    }
};

/// A muscle as one drawable shows it.
struct Shown {
    osg::observer_ptr<SkinGeometry> geometry;
    BodyFrame frame; ///< of the surface
    struct Bone {
        osg::observer_ptr<osg::Node> node;
        tss::Pose restInverse; ///< surface to the bone, at rest
    };
    std::vector<Bone> bones; ///< of a muscle over several those behind the first
    std::shared_ptr<const tss::SceneModel> model;
    int muscle;
    std::shared_ptr<const tss::MuscleDeformer> deformer; ///< null: not to be played
    std::optional<tss::MuscleShape> shape;
    tss::TriangleMesh mesh;
    std::optional<DrawnVertices> drawn; ///< of a geometry that the muscle was made from; else one per vertex
    double activation = std::numeric_limits<double>::quiet_NaN();
    Asked asked;

    tss::ChainMotion moved; ///< of the bones, in the surface's frame

    Shown(osg::Node& node, const Scene& scene, const std::string& path)
        : geometry(dynamic_cast<SkinGeometry*>(&node)), model(scene.shareModel()),
          muscle(tss::findMuscle(*model, path)) {
        if (muscle < 0) return;
        try {
            deformer = scene.getCache().muscle(muscle);
            shape.emplace(*deformer);
            mesh = deformer->muscle().surface;
            if (!geometry.valid()) findNodes(node);
            if (!geometry.valid() || !replacedBy(*geometry) || !geometry->getRestGeometry()) return;
            drawn = DrawnVertices::of(*geometry->getRestGeometry(), mesh, bodyScale(*geometry),
                                      tss::vertexNormals(mesh));
        } catch (const tss::InputError& error) {
            OSG_WARN << "osgTSS: muscle " << path << " does not play: " << error.what() << std::endl;
        }
    }

    void findNodes(osg::Node& owner) {
        const BodyNodes nodes = findBodyNodes(owner);
        const tss::MuscleModel& own = model->muscles[muscle];
        const tss::Body& body = model->bodies[own.body];
        frame = nodes.frame(body.path);
        if (!frame.node.valid()) return;
        geometry = nodes.shape(body.path);
        if (!geometry.valid() || own.insertionBone < 0) return;
        for (const int index : tss::muscleChain(*model, own)) {
            const tss::Body& bone = model->bodies[index];
            bones.push_back(
                {nodes.frame(bone.path).node, bone.placement.inverse(Eigen::Isometry) * body.placement});
            if (!bones.back().node.valid()) return bones.clear();
        }
        moved.resize(bones.size(), tss::Pose::Identity());
    }

    /// Finds where the bones are. One that was taken out of the graph stays where it was.
    tss::ChainMotion findBones(osg::Node& owner) const {
        tss::ChainMotion now = moved;
        const auto from = !bones.empty() && frame.node.valid() ? toAbove(owner, *frame.node) : std::nullopt;
        for (std::size_t k = 0; from && k < bones.size(); ++k) {
            const auto fromBone = bones[k].node.valid() ? toAbove(owner, *bones[k].node) : std::nullopt;
            if (fromBone)
                now[k] =
                    carriedSince(*fromBone, osg::Matrixd::inverse(*from), frame.scale, bones[k].restInverse);
        }
        return now;
    }

    /// Whether it looks otherwise than in the last update.
    bool change(osg::Node& owner, double now) {
        tss::ChainMotion found = findBones(owner);
        const auto same = [](const tss::Pose& a, const tss::Pose& b) { return a.matrix() == b.matrix(); };
        if (now == activation && std::ranges::equal(found, moved, same)) return false;
        activation = now;
        moved = std::move(found);
        mesh.vertices = shape->vertices(activation, moved);
        return true;
    }
};

} // namespace

struct MuscleCallback::States : PerNode<Shown> {};

MuscleCallback::MuscleCallback() : _states(std::make_unique<States>()) {}
MuscleCallback::~MuscleCallback() = default;

MuscleCallback::MuscleCallback(Scene* scene, std::string musclePath) : MuscleCallback() {
    _scene = scene;
    _musclePath = std::move(musclePath);
}

MuscleCallback::MuscleCallback(const MuscleCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), SceneCallback(other, copyop), _musclePath(other._musclePath),
      _states(std::make_unique<States>()) {}

bool MuscleCallback::run(osg::Object* object, osg::Object* data) {
    const osg::ref_ptr<MuscleCallback> self(this); // an application may take it from its node meanwhile
    const bool result = traverse(object, data);
    osg::Node* node = object ? object->asNode() : nullptr;
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    if (!node || !visitor || !visitor->getFrameStamp() || !_scene) return result;
    const MeasureUpdate measure(_scene->getCache().updateTime);
    Shown& shown = _states->of(
        *node, [&](const Shown*) { return std::make_unique<Shown>(*node, *_scene, _musclePath); },
        [&](const Shown& state) { return state.model == _scene->shareModel(); });
    SkinGeometry* geometry = shown.geometry.get();
    if (!shown.deformer || !geometry || !geometry->getVertices() ||
        (!shown.drawn && geometry->getVertices()->size() != shown.mesh.vertices.size()))
        return result;
    shown.asked.look(*geometry);
    if (shown.asked.value) _scene->setActivation(shown.muscle, *shown.asked.value);
    const double time = _scene->getClock().timeCode(*visitor->getFrameStamp());
    if (!shown.change(*node, _scene->getActivation(shown.muscle, time))) return result;
    const std::vector<tss::Vec3> normals = tss::vertexNormals(shown.mesh);
    if (shown.drawn)
        shown.drawn->deform(*geometry, shown.mesh.vertices, normals);
    else
        geometry->deform(shown.mesh.vertices, normals);
    return result;
}

} // namespace osgTSS
