#include "osgTSS/src/draw/BodyGeometry.h"
#include "osgTSS/src/draw/BodyNodes.h"

#include "bake/model/Kinematics.h"

#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgTSS/Convert>
#include <osgTSS/CreateGraph>
#include <osgTSS/DriveCallback>
#include <osgTSS/JointTransform>
#include <osgTSS/MuscleCallback>

#include <algorithm>

namespace osgTSS {

namespace {

/// From above and beside, so that shapes read where the headlight of a viewer flattens them. With that
/// headlight (0.8 diffuse) 64 degrees away the two add up to 1.0 at most; the ambient of both, 0.1 and 0.12,
/// comes on top.
osg::ref_ptr<osg::LightSource> makeKeyLight() {
    constexpr float strength = 0.35f, fill = 0.12f;
    osg::ref_ptr<osg::Light> light = new osg::Light;
    light->setLightNum(1);
    light->setPosition(osg::Vec4(-0.45f, -0.45f, 0.8f, 0)); // left, towards a viewer in front, up
    light->setAmbient(osg::Vec4(fill, fill, fill, 1));
    light->setDiffuse(osg::Vec4(strength, strength, strength, 1));
    light->setSpecular(osg::Vec4(strength, strength, strength, 1));
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setName("KeyLight");
    source->setLight(light);
    return source;
}

class GraphMaker {
public:
    GraphMaker(Scene& scene, osg::Group& world)
        : _scene(scene), _model(scene.getModel()), _world(world), _groups(_model.bodies.size()) {}

    void make() {
        _muscle.assign(_model.bodies.size(), -1);
        _deforms.assign(_model.bodies.size(), false);
        for (std::size_t m = 0; m < _model.muscles.size(); ++m) {
            _muscle[_model.muscles[m].body] = static_cast<int>(m);
            _deforms[_model.muscles[m].body] = true;
        }
        for (const tss::SkinModel& skin : _model.skins) _deforms[skin.body] = true;
        findMovers();
        for (std::size_t body = 0; body < _groups.size(); ++body) group(static_cast<int>(body));
    }

private:
    void findMovers() {
        _mover = tss::movers(_model);
        for (std::size_t j = 0; j < _model.joints.size(); ++j) {
            const tss::Joint& joint = _model.joints[j];
            if (!joint.enabled || joint.body1 < 0 || _mover[joint.body1] == static_cast<int>(j)) continue;
            OSG_NOTICE << "osgTSS: joint " << joint.path << " is not played: body "
                       << _model.bodies[joint.body1].path << " is moved by other joints already" << std::endl;
        }
    }

    osg::Group* group(int body) {
        if (body < 0) return &_world;
        osg::ref_ptr<osg::Group>& made = _groups[body];
        if (made) return made;
        const tss::Body& model = _model.bodies[body];
        const int bone = _muscle[body] < 0 ? -1 : _model.muscles[_muscle[body]].bone;
        if (_mover[body] >= 0) {
            made = new osg::Group;
            makeJoint(_model.joints[_mover[body]])->addChild(made);
        } else if (bone >= 0 && bone != body) {
            const tss::Pose onBone = _model.bodies[bone].placement.inverse(Eigen::Isometry) * model.placement;
            made = new osg::MatrixTransform(toOsg(onBone));
            group(bone)->addChild(made);
        } else {
            made = new osg::MatrixTransform(toOsg(model.placement));
            _world.addChild(made);
        }
        made->setName(model.displayName.empty() ? tss::primName(model.path) : model.displayName);
        made->setDataVariance(osg::Object::DYNAMIC);
        tagBody(*made, model.path);
        if (!model.mesh.empty()) made->addChild(shape(body));
        return made;
    }

    osg::ref_ptr<osg::Node> shape(int body) {
        const tss::Body& model = _model.bodies[body];
        if (!_deforms[body]) return makeBodyNode(model);
        osg::ref_ptr<SkinGeometry> skin = makeDeformingNode(model);
        if (_muscle[body] < 0) return skin;
        const tss::MuscleModel& muscle = _model.muscles[_muscle[body]];
        if (muscle.insertionBone < 0) // else see install()
            skin->addUpdateCallback(new MuscleCallback(&_scene, muscle.path));
        return skin;
    }

    JointTransform* makeJoint(const tss::Joint& joint) {
        osg::ref_ptr<JointTransform> transform = new JointTransform(joint);
        transform->setName(tss::primName(joint.path));
        const bool driven =
            std::ranges::any_of(joint.drives, [](const tss::TimeSamples& drive) { return !drive.empty(); });
        if (driven) transform->addUpdateCallback(new DriveCallback(&_scene));
        group(joint.body0)->addChild(transform);
        return transform;
    }

    Scene& _scene;
    const tss::SceneModel& _model;
    osg::Group& _world;
    std::vector<int> _mover;
    std::vector<int> _muscle;   ///< whose surface each body is, -1: none's
    std::vector<bool> _deforms; ///< a muscle's surface, or a skin
    std::vector<osg::ref_ptr<osg::Group>> _groups;
};

} // namespace

osg::ref_ptr<osg::Group> createGraph(Scene& scene, const GraphOptions& options) {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName(scene.getModel().defaultPrim);
    // Keeps the root, and with it the scene, through osgUtil::Optimizer.
    root->setDataVariance(osg::Object::DYNAMIC);
    osg::ref_ptr<osg::Group> world = root;
    if (options.rotateUp && scene.getModel().upAxis == 'Y') {
        world = new osg::MatrixTransform(osg::Matrixd::rotate(osg::PI_2, osg::X_AXIS));
        world->setName("YUpToZUp");
        world->setDataVariance(osg::Object::DYNAMIC);
        root->addChild(world);
    }
    GraphMaker(scene, *world).make();
    if (options.keyLight) {
        osg::ref_ptr<osg::LightSource> light = makeKeyLight();
        light->setStateSetModes(*root->getOrCreateStateSet(), osg::StateAttribute::ON);
        root->addChild(light);
    }
    scene.attachTo(*root);
    return root;
}

} // namespace osgTSS
