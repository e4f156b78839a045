#include "ContactReport.h"
#include "JointNodes.h"
#include "PerNode.h"
#include "SceneCache.h"

#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/observer_ptr>
#include <osgTSS/JointCallback>

#include <algorithm>

namespace osgTSS {

/// What belongs to one node that the callback stands on.
struct JointCallback::Binding {
    std::shared_ptr<const tss::SceneModel> model; ///< that the rest was made from
    std::shared_ptr<SharedPlan> plan;
    std::vector<std::unique_ptr<JointNode>> joints; ///< of the plan's; empty when one is missing
    std::vector<double> q;                          ///< where the joints are
    std::vector<double> asked;                      ///< room for what is asked
    std::vector<tss::JointAnswer> found;
    ContactReport contacts;
    unsigned int traversal = 0, frame = 0; ///< of the last update
    bool updated = false;                  ///< there was one
    bool toldBeyond = false;               ///< that more is asked than the limits allow

    Binding(osg::Node& node, const Scene& scene, const std::vector<std::string>& pairPaths);

    bool stillGood(const Scene& scene) const {
        return model == scene.shareModel() &&
               std::all_of(joints.begin(), joints.end(), [](const auto& joint) { return joint->valid(); });
    }
    void resolve();
    void tellBeyond();
    void show() const;
    void tell(const Scene& scene, osg::NodeVisitor& visitor);
};

JointCallback::Binding::Binding(osg::Node& owner, const Scene& scene,
                                const std::vector<std::string>& pairPaths)
    : model(scene.shareModel()), plan(scene.getCache().plan(pairPaths)) {
    const auto nodes = findJointNodes(owner);
    for (int index : (*plan)->joints) {
        const tss::Joint& joint = model->joints[index];
        const auto found = nodes.find(joint.path);
        auto access = found == nodes.end() ? nullptr : makeJointNode(*found->second, joint);
        if (!access) {
            OSG_WARN << "osgTSS: nothing below node \"" << owner.getName() << "\" carries joint "
                     << joint.path << "; its pairs are not kept apart" << std::endl;
            joints.clear();
            q.clear();
            return;
        }
        const std::vector<double> values = access->shown();
        q.insert(q.end(), values.begin(), values.end());
        joints.push_back(std::move(access));
    }
}

void JointCallback::Binding::resolve() {
    if (joints.empty()) return;
    asked.clear();
    for (const auto& joint : joints) {
        const std::vector<double> values = joint->asked();
        asked.insert(asked.end(), values.begin(), values.end());
    }
    if (!toldBeyond) tellBeyond();
    found = plan->resolve(q, asked);
    q = asked;
}

/// Once: the graph asks for values that no table was made for, at whose limits the joint stops.
void JointCallback::Binding::tellBeyond() {
    std::size_t next = 0;
    for (int index : (*plan)->joints)
        for (const tss::Dof& dof : model->joints[index].dofs) {
            const double value = asked[next++], hair = 1e-6 * (dof.upper - dof.lower);
            if (toldBeyond || (value >= dof.lower - hair && value <= dof.upper + hair)) continue;
            toldBeyond = true;
            OSG_WARN << "osgTSS: joint " << model->joints[index].path << ": \"" << dof.name
                     << "\" is asked to go beyond the limits that its tables were made for; it stops there"
                     << std::endl;
        }
}

void JointCallback::Binding::show() const {
    auto next = q.begin();
    for (const auto& joint : joints) {
        const auto end = next + static_cast<std::ptrdiff_t>(joint->dofCount());
        joint->show(std::vector<double>(next, end));
        next = end;
    }
}

void JointCallback::Binding::tell(const Scene& scene, osg::NodeVisitor& visitor) {
    if (ContactCallback* callback = scene.getContactCallback(); callback && !joints.empty())
        contacts.tell(scene, **plan, q, found, *callback, visitor);
}

struct JointCallback::Bindings : PerNode<Binding> {};

JointCallback::JointCallback() : _bindings(std::make_unique<Bindings>()) {}
JointCallback::~JointCallback() = default;

JointCallback::JointCallback(Scene* scene, std::vector<std::string> pairPaths) : JointCallback() {
    _scene = scene;
    _pairPaths = std::move(pairPaths);
}

JointCallback::JointCallback(const JointCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), _scene(other._scene),
      _pairPaths(other._pairPaths), _bindings(std::make_unique<Bindings>()) {}

void JointCallback::setScene(Scene* scene) {
    _scene = scene;
    _bindings->clear();
}

void JointCallback::setPairPaths(std::vector<std::string> paths) {
    _pairPaths = std::move(paths);
    _bindings->clear();
}

std::vector<JointCallback::Answer> JointCallback::getAnswers(const osg::Node& node) const {
    std::vector<Answer> answers;
    const Binding* binding = _bindings->find(node);
    for (std::size_t g = 0; binding && g < binding->found.size(); ++g) {
        const tss::JointAnswer& found = binding->found[g];
        const std::string path =
            found.table < 0
                ? ""
                : binding->model
                      ->pairs[(*binding->plan)->groups[g].pairs[static_cast<std::size_t>(found.table)]]
                      .path;
        answers.push_back({found.status, found.gap, path, found.test});
    }
    return answers;
}

void JointCallback::start(osg::Node& node) {
    _bindings->erase(node);
    if (_scene) bindingOf(node);
}

JointCallback::Binding& JointCallback::bindingOf(osg::Node& node) {
    return _bindings->of(
        node,
        [&](const Binding* before) {
            auto made = std::make_unique<Binding>(node, *_scene, _pairPaths);
            if (before && made->q.size() == before->q.size()) made->q = before->q;
            return made;
        },
        // Started, but not updated yet: the graph may have been optimized since.
        [&](const Binding& binding) { return binding.updated && binding.stillGood(*_scene); });
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
    const MeasureUpdate measure(_scene->getCache().updateTime);
    if (!binding.stillGood(*_scene)) return result; // the animation took a joint away
    if (!again) binding.resolve();
    binding.show();
    if (!again) binding.tell(*_scene, *visitor);
    return result;
}

} // namespace osgTSS
