#include "BodyNodes.h"
#include "DrawnVertices.h"
#include "PerNode.h"
#include "SceneCache.h"
#include "SoftParts.h"
#include "SoftTags.h"

#include "bake/base/Error.h"

#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/ValueObject>
#include <osgTSS/MuscleCallback>
#include <osgTSS/SkinGeometry>

#include <cmath>
#include <limits>

namespace osgTSS {

namespace {

/// A muscle as one drawable shows it.
struct Shown {
    std::shared_ptr<const tss::SceneModel> model;
    int muscle = -1;
    std::shared_ptr<const tss::MuscleDeformer> deformer; ///< null: not to be played
    tss::TriangleMesh mesh;
    std::optional<DrawnVertices> drawn; ///< of a geometry that the muscle was made from; else one a vertex
    double activation = std::numeric_limits<double>::quiet_NaN();

    Shown(SkinGeometry& geometry, const Scene& scene, const std::string& path) : model(scene.shareModel()) {
        for (std::size_t m = 0; m < model->muscles.size(); ++m)
            if (model->muscles[m].path == path) muscle = static_cast<int>(m);
        if (muscle < 0) return;
        try {
            deformer = scene.getCache().muscle(muscle);
            mesh = deformer->muscle().surface;
            if (!replacedBy(geometry) || !geometry.getRestGeometry()) return;
            drawn = DrawnVertices::of(*geometry.getRestGeometry(), mesh, bodyScale(geometry),
                                      tss::vertexNormals(mesh));
        } catch (const tss::InputError& error) {
            OSG_WARN << "osgTSS: muscle " << path << " does not play: " << error.what() << std::endl;
        }
    }
};

/// The number that the application has written on its own drawable; nothing where it has not.
std::optional<double> askedOf(SkinGeometry& geometry) {
    const osg::Drawable* own = replacedBy(geometry);
    double wide = 0;
    float narrow = 0;
    if (own && own->getUserValue(activationTag, wide)) return wide;
    if (own && own->getUserValue(activationTag, narrow)) return narrow;
    return std::nullopt;
}

} // namespace

struct MuscleCallback::States : PerNode<Shown> {};

MuscleCallback::MuscleCallback() : _states(std::make_unique<States>()) {}
MuscleCallback::~MuscleCallback() = default;

MuscleCallback::MuscleCallback(Scene* scene, std::string musclePath) : MuscleCallback() {
    _scene = scene;
    _musclePath = std::move(musclePath);
}

MuscleCallback::MuscleCallback(const MuscleCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), _scene(other._scene),
      _musclePath(other._musclePath), _states(std::make_unique<States>()) {}

bool MuscleCallback::run(osg::Object* object, osg::Object* data) {
    const bool result = traverse(object, data);
    auto* geometry = dynamic_cast<SkinGeometry*>(object);
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    if (!geometry || !visitor || !visitor->getFrameStamp() || !_scene) return result;
    const MeasureUpdate measure(_scene->getCache().updateTime);
    Shown& shown = _states->of(
        *geometry, [&](const Shown*) { return std::make_unique<Shown>(*geometry, *_scene, _musclePath); },
        [&](const Shown& state) { return state.model == _scene->shareModel(); });
    if (!shown.deformer || !geometry->getVertices() ||
        (!shown.drawn && geometry->getVertices()->size() != shown.mesh.vertices.size()))
        return result;
    if (const auto asked = askedOf(*geometry)) _scene->setActivation(shown.muscle, *asked);
    const double time = _scene->getClock().timeCode(*visitor->getFrameStamp());
    const double activation = _scene->getActivation(shown.muscle, time);
    if (activation == shown.activation) return result;
    shown.activation = activation;
    shown.mesh.vertices = shown.deformer->vertices(activation);
    const std::vector<tss::Vec3> normals = tss::vertexNormals(shown.mesh);
    if (shown.drawn)
        shown.drawn->deform(*geometry, shown.mesh.vertices, normals);
    else
        geometry->deform(shown.mesh.vertices, normals);
    return result;
}

} // namespace osgTSS
