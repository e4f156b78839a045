#include "JointNodes.h"
#include "JointResolver.h"

#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/observer_ptr>
#include <osgTSS/JointCallback>

#include <algorithm>

namespace osgTSS {

/// What belongs to one node that the callback stands on.
struct JointCallback::Binding {
    osg::observer_ptr<osg::Node> node;
    std::shared_ptr<const tss::SceneModel> model; ///< that the rest was made from
    std::vector<std::unique_ptr<JointNode>> joints;
    std::vector<ResolverPair> pairs;
    std::vector<double> q; ///< of all joints, one after the other: where they are
    std::vector<tss::JointResult> results;
    unsigned int traversal = 0, frame = 0; ///< of the last update
    bool updated = false;                  ///< there was one

    Binding(osg::Node& node, std::shared_ptr<const tss::SceneModel> model,
            const std::vector<std::string>& pairPaths);

    bool stillGood(const std::shared_ptr<const tss::SceneModel>& current) const {
        return model == current &&
               std::all_of(joints.begin(), joints.end(), [](const auto& joint) { return joint->valid(); });
    }
    std::vector<double> asked() const;
    void show() const;
};

namespace {

struct Offsets {
    std::vector<int> ofJoint; ///< first value of each joint of the model, -1: not in use
    std::size_t count = 0;
};

} // namespace

JointCallback::Binding::Binding(osg::Node& owner, std::shared_ptr<const tss::SceneModel> scene,
                                const std::vector<std::string>& pairPaths)
    : node(&owner), model(std::move(scene)) {
    const auto nodes = findJointNodes(owner);
    Offsets offsets{std::vector<int>(model->joints.size(), -1), 0};
    const auto bind = [&](int index) {
        if (offsets.ofJoint[index] >= 0) return true;
        const tss::Joint& joint = model->joints[index];
        const auto found = nodes.find(joint.path);
        auto access = found == nodes.end() ? nullptr : makeJointNode(*found->second, joint);
        if (!access) return false;
        offsets.ofJoint[index] = static_cast<int>(offsets.count);
        offsets.count += access->dofCount();
        const std::vector<double> values = access->shown();
        q.insert(q.end(), values.begin(), values.end());
        joints.push_back(std::move(access));
        return true;
    };
    for (const std::string& path : pairPaths) {
        const int index = tss::findPair(*model, path);
        if (index < 0 || !model->pairs[index].table) continue;
        const tss::Pair& pair = model->pairs[index];
        ResolverPair resolved{pair.table, {}};
        bool complete = true;
        for (int joint : pair.joints) {
            complete = complete && bind(joint);
            if (!complete) break;
            for (std::size_t k = 0; k < model->joints[joint].dofs.size(); ++k)
                resolved.slots.push_back(offsets.ofJoint[joint] + k);
        }
        if (complete && resolved.slots.size() == pair.table->motion.dofCount())
            pairs.push_back(std::move(resolved));
        else
            OSG_WARN << "osgTSS: pair " << path << " is not resolved: its joints are not below node \""
                     << owner.getName() << "\", or have other degrees of freedom than its table" << std::endl;
    }
}

std::vector<double> JointCallback::Binding::asked() const {
    std::vector<double> values;
    values.reserve(q.size());
    for (const auto& joint : joints) {
        const std::vector<double> asked = joint->asked();
        values.insert(values.end(), asked.begin(), asked.end());
    }
    return values;
}

void JointCallback::Binding::show() const {
    auto next = q.begin();
    for (const auto& joint : joints) {
        joint->show(std::vector<double>(next, next + static_cast<std::ptrdiff_t>(joint->dofCount())));
        next += static_cast<std::ptrdiff_t>(joint->dofCount());
    }
}

JointCallback::JointCallback() = default;
JointCallback::~JointCallback() = default;

JointCallback::JointCallback(Scene* scene, std::vector<std::string> pairPaths)
    : _scene(scene), _pairPaths(std::move(pairPaths)) {}

JointCallback::JointCallback(const JointCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), _scene(other._scene),
      _pairPaths(other._pairPaths) {}

void JointCallback::setScene(Scene* scene) {
    _scene = scene;
    _bindings.clear();
}

void JointCallback::setPairPaths(std::vector<std::string> paths) {
    _pairPaths = std::move(paths);
    _bindings.clear();
}

std::vector<tss::JointResult> JointCallback::getResults(const osg::Node& node) const {
    for (const auto& binding : _bindings)
        if (binding->node == &node) return binding->results;
    return {};
}

void JointCallback::start(osg::Node& node) {
    std::erase_if(_bindings, [&](const auto& binding) { return binding->node == &node; });
    if (_scene) bindingOf(node);
}

JointCallback::Binding& JointCallback::bindingOf(osg::Node& node) {
    std::erase_if(_bindings, [](const auto& binding) { return !binding->node.valid(); });
    for (auto& binding : _bindings) {
        if (binding->node != &node) continue;
        if (binding->updated && binding->stillGood(_scene->shareModel())) return *binding;
        auto again = std::make_unique<Binding>(node, _scene->shareModel(), _pairPaths);
        if (again->q.size() == binding->q.size()) again->q = binding->q;
        binding = std::move(again);
        return *binding;
    }
    _bindings.push_back(std::make_unique<Binding>(node, _scene->shareModel(), _pairPaths));
    return *_bindings.back();
}

bool JointCallback::run(osg::Object* object, osg::Object* data) {
    osg::Node* node = object ? object->asNode() : nullptr;
    osg::NodeVisitor* visitor = data ? data->asNodeVisitor() : nullptr;
    if (!node || !visitor || !_scene) return traverse(object, data);

    Binding& binding = bindingOf(*node);
    const unsigned int traversal = visitor->getTraversalNumber();
    const osg::FrameStamp* stamp = visitor->getFrameStamp();
    const unsigned int frame = stamp ? stamp->getFrameNumber() : 0;
    const bool again = stamp && binding.updated && binding.traversal == traversal && binding.frame == frame;
    binding.updated = true;
    binding.traversal = traversal;
    binding.frame = frame;

    if (!again)
        for (const auto& joint : binding.joints) joint->restoreAsked();
    const bool result = traverse(object, data);
    if (!binding.stillGood(_scene->shareModel())) return result; // the animation took a joint away
    if (!again) {
        std::vector<double> q = binding.asked();
        binding.results = resolveJoints(binding.pairs, binding.q, q);
        binding.q = std::move(q);
    }
    binding.show();
    return result;
}

} // namespace osgTSS
