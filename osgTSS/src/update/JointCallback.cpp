#include "ContactReport.h"
#include "PerNode.h"
#include "SkeletonPose.h"
#include "osgTSS/src/SceneCache.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/Node>
#include <osg/Notify>
#include <osgTSS/JointCallback>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace osgTSS {

namespace {

/// A joint of the pairs, its node, and how that is reached from the node that the callback stands on.
struct BoundJoint {
    std::unique_ptr<JointNode> access;        ///< null: its pairs are not kept apart
    osg::NodePath path;                       ///< from the callback's node to the joint's
    std::vector<const osg::Node*> transforms; ///< of these
    bool served = true;                       ///< false while it stands where no table of its knows it
    bool told = false;                        ///< that it went beyond its limits

    /// Whether it is of this node: what it knows of the node is what tables were installed for, and is kept.
    bool isOn(const osg::Node& node) const {
        return access && access->valid() && !path.empty() && path.back() == &node;
    }

    /// Whether the node hangs where it did. The nodes above are there as long as those below are.
    bool inPlace() const {
        for (std::size_t k = path.size(); k-- > 1;) {
            const osg::Node::ParentList& parents = path[k]->getParents();
            if (std::ranges::find(parents, path[k - 1]) == parents.end()) return false;
        }
        return true;
    }
};

/// The nodes of a path that move what is below, to be compared only: they may be gone later.
std::vector<const osg::Node*> transformsOf(const osg::NodePath& path) {
    std::vector<const osg::Node*> found;
    for (const osg::Node* node : path)
        if (const_cast<osg::Node*>(node)->asTransform()) found.push_back(node);
    return found;
}

} // namespace

/// What belongs to one node that the callback stands on.
struct JointCallback::Binding {
    std::shared_ptr<const tss::SceneModel> model; ///< that the rest was made from
    std::map<int, BoundJoint> bound;              ///< by the model's joint
    std::vector<std::string> served;              ///< pairs that are kept apart now
    std::shared_ptr<SharedPlan> plan;             ///< of these
    std::vector<JointNode*> joints;               ///< of the plan's
    std::vector<double> q;                        ///< where the joints are
    std::vector<double> asked;                    ///< room for what is asked
    std::vector<double> askedLast;                ///< before it was held, where something was
    std::vector<tss::GroupAnswer> found;
    ContactReport contacts;                ///< carried on when other pairs are kept apart
    std::optional<SkeletonPose> skeletons; ///< where some joint is a bone
    unsigned int traversal = 0, frame = 0; ///< of the last update
    bool updated = false;                  ///< there was one

    Binding(osg::Node& node, const Scene& scene, const std::vector<std::string>& pairPaths, Binding* before);

    void bind(osg::Node& owner, int index, osg::Node* node, Binding* before);
    bool stillGood(const Scene& scene) const {
        return model == scene.shareModel() && std::ranges::all_of(bound, [](const auto& entry) {
                   const BoundJoint& joint = entry.second;
                   return !joint.access || (joint.access->valid() && joint.inPlace());
               });
    }
    std::vector<double> valuesOf(std::size_t joint) const;
    void choose(const Scene& scene, const std::vector<std::string>& pairPaths);
    void watch(const Scene& scene, const std::vector<std::string>& pairPaths);
    void restoreAsked() const;
    void resolve();
    bool movedSince() const;
    void tell(int index, const Stray& stray);
    void tellBeyond();
    void show() const;
};

/// before: what stood here, of the same graph; null at the start.
JointCallback::Binding::Binding(osg::Node& owner, const Scene& scene,
                                const std::vector<std::string>& pairPaths, Binding* before)
    : model(scene.shareModel()) {
    if (before && before->model != model) before = nullptr;
    const auto nodes = findJointNodes(owner);
    for (const std::string& path : pairPaths) {
        const int pair = tss::findPair(*model, path);
        if (pair < 0 || !model->pairs[pair].table) continue;
        for (int index : model->pairs[pair].joints) {
            if (bound.contains(index)) continue;
            const auto node = nodes.find(model->joints[index].path);
            bind(owner, index, node != nodes.end() ? node->second.front() : nullptr, before);
        }
    }
    if (before) {
        // Where the joints that are left are, so that none goes through anything meanwhile.
        plan = before->plan;
        q = before->q;
        contacts = before->contacts;
        contacts.lookAgain();
    }
    choose(scene, pairPaths);
}

/// node: that carries the joint; null: none does.
void JointCallback::Binding::bind(osg::Node& owner, int index, osg::Node* node, Binding* before) {
    BoundJoint& joint = bound[index];
    const std::string& path = model->joints[index].path;
    BoundJoint* known = before && before->bound.contains(index) ? &before->bound.at(index) : nullptr;
    const BoundJoint* old = before && before->updated ? known : nullptr;
    const bool lost = !old || old->access;
    if (node) {
        joint.access = makeJointNode(*node, model->joints[index]);
        if (joint.access && known && known->isOn(*node)) {
            joint.access = std::move(known->access);
            joint.told = known->told;
        }
        const osg::NodePathList paths = node->getParentalNodePaths(&owner);
        if (!paths.empty()) joint.path = paths.front();
        joint.transforms = transformsOf(joint.path);
        if (!skeletons && dynamic_cast<osgAnimation::Bone*>(node)) skeletons.emplace(owner);
    }
    if (!joint.access) {
        if (old) joint.transforms = old->transforms;
        if (lost)
            OSG_WARN << "osgTSS: nothing below node \"" << owner.getName() << "\" carries joint " << path
                     << (old ? " any more" : "") << "; its pairs are not kept apart" << std::endl;
    } else if (old && !old->transforms.empty() && old->transforms != joint.transforms) {
        OSG_WARN << "osgTSS: joint " << path << " hangs elsewhere than its tables were made for; "
                 << "its pairs are not kept apart until install() is called again" << std::endl;
        joint.access = nullptr;
        joint.transforms = old->transforms;
    }
}

/// Where a joint of the plan is.
std::vector<double> JointCallback::Binding::valuesOf(std::size_t joint) const {
    const auto first = q.begin() + static_cast<std::ptrdiff_t>((*plan)->firstValue[joint]);
    const std::size_t count = model->joints[(*plan)->joints[joint]].dofs.size();
    return {first, first + static_cast<std::ptrdiff_t>(count)};
}

/// The pairs whose joints are all there, and their plan; joints stay where they are.
void JointCallback::Binding::choose(const Scene& scene, const std::vector<std::string>& pairPaths) {
    std::map<int, std::vector<double>> at;
    for (std::size_t j = 0; plan && j < (*plan)->joints.size() && !q.empty(); ++j)
        at[(*plan)->joints[j]] = valuesOf(j);
    served.clear();
    for (const std::string& path : pairPaths) {
        const int pair = tss::findPair(*model, path);
        if (pair < 0 || !model->pairs[pair].table) continue;
        const std::vector<int>& of = model->pairs[pair].joints;
        if (std::ranges::all_of(of, [&](int j) { return bound[j].access && bound[j].served; }))
            served.push_back(path);
    }
    plan = scene.getCache().plan(served);
    joints.clear();
    q.clear();
    found.clear();
    for (int index : (*plan)->joints) {
        joints.push_back(bound[index].access.get());
        const auto known = at.find(index);
        const std::vector<double> values = known != at.end() ? known->second : joints.back()->shown();
        for (std::size_t k = 0; k < values.size(); ++k) // what is no number cannot be gone on from
            q.push_back(std::isfinite(values[k]) ? values[k] : model->joints[index].dofs[k].rest);
    }
}

/// Says once of each joint that it goes beyond what its tables are for; pairs of a joint that stands where
/// they know nothing are let go while it does.
void JointCallback::Binding::watch(const Scene& scene, const std::vector<std::string>& pairPaths) {
    bool changed = false;
    for (auto& [index, joint] : bound) {
        if (!joint.access) continue;
        const auto stray = joint.access->stray();
        const bool servedNow = !stray || !stray->unserved;
        changed = changed || servedNow != joint.served;
        joint.served = servedNow;
        if (stray) tell(index, *stray);
    }
    if (changed) choose(scene, pairPaths);
}

/// Once a joint.
void JointCallback::Binding::tell(int index, const Stray& stray) {
    if (std::exchange(bound.at(index).told, true)) return;
    OSG_WARN << "osgTSS: joint " << model->joints[index].path << ": " << stray.what << "; "
             << (stray.unserved ? "its tables know nothing there, and its pairs are not kept apart"
                                : "it is held at them")
             << std::endl;
}

void JointCallback::Binding::restoreAsked() const {
    for (const auto& [index, joint] : bound)
        if (joint.access) joint.access->restoreAsked();
}

void JointCallback::Binding::resolve() {
    if (joints.empty()) return;
    asked.clear();
    for (const JointNode* joint : joints) {
        const std::vector<double> values = joint->asked();
        asked.insert(asked.end(), values.begin(), values.end());
    }
    tellBeyond();
    for (std::size_t k = 0; k < q.size(); ++k)
        if (!std::isfinite(asked[k])) asked[k] = q[k]; // it stays where it is
    askedLast = asked;
    found = plan->inRoom([&](auto& room) { return tss::resolve(**plan, q, asked, room); });
    q = asked;
}

/// Whether the joints are asked for other values than at the last resolve(), and than it came to. By what
/// nodes with floats can tell.
bool JointCallback::Binding::movedSince() const {
    std::size_t next = 0;
    for (const JointNode* joint : joints)
        for (const double value : joint->asked()) {
            const auto same = [&](double known) {
                return std::abs(value - known) <= 1e-6 * (1 + std::abs(known));
            };
            if (std::isfinite(value) && !same(q[next]) &&
                (next >= askedLast.size() || !same(askedLast[next])))
                return true;
            ++next;
        }
    return false;
}

/// The graph asks for values that no table was made for, at whose limits the joint stops.
void JointCallback::Binding::tellBeyond() {
    std::size_t next = 0;
    for (int index : (*plan)->joints)
        for (const tss::Dof& dof : model->joints[index].dofs) {
            const double value = asked[next++];
            if ((value >= dof.lower && value <= dof.upper) || bound.at(index).told) continue;
            if (const auto beyond = beyondLimits(dof, value)) tell(index, *beyond);
        }
}

void JointCallback::Binding::show() const {
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j]->show(valuesOf(j));
    if (skeletons) skeletons->refresh();
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

void JointCallback::start(osg::Node& node) {
    _bindings->erase(node);
    if (_scene) bindingOf(node);
}

JointCallback::Binding& JointCallback::bindingOf(osg::Node& node) {
    return _bindings->of(
        node, [&](Binding* before) { return std::make_unique<Binding>(node, *_scene, _pairPaths, before); },
        // Started, but not updated yet: the graph may have been optimized since.
        [&](const Binding& binding) { return binding.updated && binding.stillGood(*_scene); });
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
    if (!binding.stillGood(*scene)) return result; // the animation took a joint away
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
        if (callback) told = binding.contacts.report(scene, *binding.plan, binding.q, binding.found, visitor);
    }
    if (callback) told.tell(*callback, visitor);
}

void JointCallback::hold(osg::Node& node, osg::NodeVisitor& visitor) {
    if (!_scene || !_bindings->find(node)) return;
    const osg::ref_ptr<JointCallback> self(this);
    const osg::ref_ptr<Scene> scene = _scene;
    Binding& binding = bindingOf(node);
    binding.updated = true;
    if (binding.stillGood(*scene) && binding.movedSince()) resolve(binding, *scene, visitor);
}

} // namespace osgTSS
