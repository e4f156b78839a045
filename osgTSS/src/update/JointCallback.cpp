#include "JointBinding.h"
#include "PerNode.h"

#include <osgTSS/JointCallback>

namespace osgTSS {

struct JointCallback::Binding : JointBinding {
    using JointBinding::JointBinding;
};
struct JointCallback::Bindings : PerNode<Binding> {};

JointCallback::JointCallback() : _bindings(std::make_unique<Bindings>()) {}
JointCallback::~JointCallback() = default;

JointCallback::JointCallback(Scene* scene, std::vector<std::string> pairPaths) : JointCallback() {
    _scene = scene;
    _pairPaths = std::move(pairPaths);
}

JointCallback::JointCallback(const JointCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), SceneCallback(other, copyop), _pairPaths(other._pairPaths),
      _bindings(std::make_unique<Bindings>()) {}

void JointCallback::setScene(Scene* scene) {
    SceneCallback::setScene(scene);
    _bindings->clear();
}

void JointCallback::setPairPaths(std::vector<std::string> paths) {
    _pairPaths = std::move(paths);
    _bindings->clear();
}

void JointCallback::start(osg::Node& node) {
    _bindings->erase(node);
    if (_scene) bindingOf(node);
}

JointCallback::Binding& JointCallback::bindingOf(osg::Node& node) {
    return _bindings->of(
        node, [&](Binding* before) { return std::make_unique<Binding>(node, *_scene, _pairPaths, before); },
        // Started, but not updated yet: the graph may have been optimized since.
        [&](const Binding& binding) { return binding.updated && binding.fits(*_scene); });
}

bool JointCallback::run(osg::Object* object, osg::Object* data) {
    osg::Node* node = object ? object->asNode() : nullptr;
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    if (!node || !visitor || !_scene) return traverse(object, data);

    // Callbacks of the application may take this one from its node, and the scene from it.
    const osg::ref_ptr<JointCallback> self(this);
    const osg::ref_ptr<Scene> scene = _scene;
    Binding& binding = bindingOf(*node);
    const unsigned int traversal = visitor->getTraversalNumber();
    const osg::FrameStamp* stamp = visitor->getFrameStamp();
    const unsigned int frame = stamp ? stamp->getFrameNumber() : 0;
    const bool again = stamp && binding.updated && binding.traversal == traversal && binding.frame == frame;
    binding.updated = true;
    binding.traversal = traversal;
    binding.frame = frame;

    if (!again) binding.restoreAsked();
    const bool result = traverse(object, data);
    if (_bindings->find(*node) != &binding) return result;
    if (!binding.fits(*scene)) return result; // the animation took a joint away
    if (!again)
        resolve(binding, *scene, *visitor);
    else
        binding.show();
    return result;
}

void JointCallback::resolve(Binding& binding, Scene& scene, osg::NodeVisitor& visitor) {
    const osg::ref_ptr<ContactCallback> callback = scene.getContactCallback();
    ToldContacts told;
    {
        const MeasureUpdate measure(scene.getCache().updateTime);
        binding.watch(scene, _pairPaths);
        binding.resolve();
        binding.show();
        if (callback) told = binding.contacts(scene, visitor);
    }
    if (callback) told.tell(*callback, visitor);
}

void JointCallback::hold(osg::Node& node, osg::NodeVisitor& visitor) {
    if (!_scene || !_bindings->find(node)) return;
    const osg::ref_ptr<JointCallback> self(this);
    const osg::ref_ptr<Scene> scene = _scene;
    Binding& binding = bindingOf(node);
    binding.updated = true;
    if (binding.fits(*scene) && binding.movedSince()) resolve(binding, *scene, visitor);
}

} // namespace osgTSS
