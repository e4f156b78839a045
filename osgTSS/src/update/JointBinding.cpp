#include "JointBinding.h"

#include <osg/Notify>
#include <osgAnimation/Bone>

#include <cmath>
#include <utility>

namespace osgTSS {

namespace {

/// The nodes of a path that move what is below.
std::vector<const osg::Node*> transformsOf(const osg::NodePath& path) {
    std::vector<const osg::Node*> found;
    for (const osg::Node* node : path)
        if (const_cast<osg::Node*>(node)->asTransform()) found.push_back(node);
    return found;
}

/// The indices of the pairs that have a table.
std::vector<int> tabulated(const tss::SceneModel& model, const std::vector<std::string>& pairPaths) {
    std::vector<int> pairs;
    for (const std::string& path : pairPaths)
        if (const int pair = tss::findPair(model, path); pair >= 0 && model.pairs[pair].table)
            pairs.push_back(pair);
    return pairs;
}

} // namespace

/// What it knows of the node is what tables were installed for, and may be kept.
bool JointBinding::Bound::isOn(const osg::Node& node) const {
    return access && access->valid() && !path.empty() && path.back() == &node;
}

/// Whether the node hangs where it did. The nodes above are there as long as those below are.
bool JointBinding::Bound::inPlace() const {
    for (std::size_t k = path.size(); k-- > 1;) {
        const osg::Node::ParentList& parents = path[k]->getParents();
        if (std::ranges::find(parents, path[k - 1]) == parents.end()) return false;
    }
    return true;
}

JointBinding::JointBinding(osg::Node& owner, const Scene& scene, const std::vector<std::string>& pairPaths,
                           JointBinding* before)
    : _model(scene.shareModel()) {
    if (before && before->_model != _model) before = nullptr;
    const auto nodes = findJointNodes(owner);
    for (const int pair : tabulated(*_model, pairPaths))
        for (const int joint : _model->pairs[pair].joints) {
            if (_bound.contains(joint)) continue;
            const auto node = nodes.find(_model->joints[joint].path);
            bind(owner, joint, node != nodes.end() ? node->second.front() : nullptr, before);
        }
    if (before) {
        _plan = before->_plan;
        _q = before->_q;
        _report = before->_report;
        _report.lookAgain();
    }
    choose(scene, pairPaths);
}

bool JointBinding::fits(const Scene& scene) const {
    return _model == scene.shareModel() && std::ranges::all_of(_bound, [](const auto& entry) {
               const Bound& joint = entry.second;
               return !joint.access || (joint.access->valid() && joint.inPlace());
           });
}

/// node: that carries the joint; null: none does.
void JointBinding::bind(osg::Node& owner, int index, osg::Node* node, JointBinding* before) {
    Bound& joint = _bound[index];
    const std::string& path = _model->joints[index].path;
    Bound* known = before && before->_bound.contains(index) ? &before->_bound.at(index) : nullptr;
    const Bound* old = before && before->updated ? known : nullptr;
    const bool lost = !old || old->access;
    if (node) {
        joint.access = makeJointNode(*node, _model->joints[index]);
        if (joint.access && known && known->isOn(*node)) {
            joint.access = std::move(known->access);
            joint.told = known->told;
        }
        const osg::NodePathList paths = node->getParentalNodePaths(&owner);
        if (!paths.empty()) joint.path = paths.front();
        joint.transforms = transformsOf(joint.path);
        if (!_skeletons && dynamic_cast<osgAnimation::Bone*>(node)) _skeletons.emplace(owner);
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
std::vector<double> JointBinding::valuesOf(std::size_t joint) const {
    const auto first = _q.begin() + static_cast<std::ptrdiff_t>((*_plan)->firstValue[joint]);
    const std::size_t count = _model->joints[(*_plan)->joints[joint]].dofs.size();
    return {first, first + static_cast<std::ptrdiff_t>(count)};
}

/// Plans for the pairs whose joints are all there; joints stay where they are.
void JointBinding::choose(const Scene& scene, const std::vector<std::string>& pairPaths) {
    std::map<int, std::vector<double>> at;
    for (std::size_t j = 0; _plan && j < (*_plan)->joints.size() && !_q.empty(); ++j)
        at[(*_plan)->joints[j]] = valuesOf(j);
    std::vector<std::string> kept;
    for (const int pair : tabulated(*_model, pairPaths))
        if (std::ranges::all_of(_model->pairs[pair].joints,
                                [&](int joint) { return _bound[joint].access && _bound[joint].served; }))
            kept.push_back(_model->pairs[pair].path);
    _plan = scene.getCache().plan(kept);
    _joints.clear();
    _q.clear();
    _answers.clear();
    for (const int joint : (*_plan)->joints) {
        _joints.push_back(_bound[joint].access.get());
        const auto known = at.find(joint);
        const std::vector<double> values = known != at.end() ? known->second : _joints.back()->shown();
        for (std::size_t k = 0; k < values.size(); ++k) // what is no number cannot be gone on from
            _q.push_back(std::isfinite(values[k]) ? values[k] : _model->joints[joint].dofs[k].rest);
    }
}

void JointBinding::watch(const Scene& scene, const std::vector<std::string>& pairPaths) {
    bool changed = false;
    for (auto& [index, joint] : _bound) {
        if (!joint.access) continue;
        const auto stray = joint.access->stray();
        const bool servedNow = !stray || !stray->unserved;
        changed = changed || servedNow != joint.served;
        joint.served = servedNow;
        if (stray) warnOnce(index, *stray);
    }
    if (changed) choose(scene, pairPaths);
}

void JointBinding::warnOnce(int joint, const Stray& stray) {
    if (std::exchange(_bound.at(joint).told, true)) return;
    OSG_WARN << "osgTSS: joint " << _model->joints[joint].path << ": " << stray.what << "; "
             << (stray.unserved ? "its tables know nothing there, and its pairs are not kept apart"
                                : "it is held at them")
             << std::endl;
}

void JointBinding::restoreAsked() const {
    for (const auto& [index, joint] : _bound)
        if (joint.access) joint.access->restoreAsked();
}

void JointBinding::resolve() {
    if (_joints.empty()) return;
    _asked.clear();
    for (const JointNode* joint : _joints) {
        const std::vector<double> values = joint->asked();
        _asked.insert(_asked.end(), values.begin(), values.end());
    }
    warnBeyondLimits();
    for (std::size_t k = 0; k < _q.size(); ++k)
        if (!std::isfinite(_asked[k])) _asked[k] = _q[k]; // it stays where it is
    _askedLast = _asked;
    _answers = _plan->inRoom([&](auto& room) { return tss::resolve(**_plan, _q, _asked, room); });
    _q = _asked;
}

bool JointBinding::movedSince() const {
    constexpr double rounding = 1e-6; // nodes hold floats
    std::size_t next = 0;
    for (const JointNode* joint : _joints)
        for (const double value : joint->asked()) {
            const auto same = [&](double known) {
                return std::abs(value - known) <= rounding * (1 + std::abs(known));
            };
            if (std::isfinite(value) && !same(_q[next]) &&
                (next >= _askedLast.size() || !same(_askedLast[next])))
                return true;
            ++next;
        }
    return false;
}

/// Warns of the joints that are asked for values beyond their limits, at which they stop.
void JointBinding::warnBeyondLimits() {
    std::size_t next = 0;
    for (const int joint : (*_plan)->joints)
        for (const tss::Dof& dof : _model->joints[joint].dofs) {
            const double value = _asked[next++];
            if ((value >= dof.lower && value <= dof.upper) || _bound.at(joint).told) continue;
            if (const auto beyond = beyondLimits(dof, value)) warnOnce(joint, *beyond);
        }
}

void JointBinding::show() const {
    for (std::size_t j = 0; j < _joints.size(); ++j) _joints[j]->show(valuesOf(j));
    if (_skeletons) _skeletons->refresh();
}

ToldContacts JointBinding::contacts(const Scene& scene, osg::NodeVisitor& visitor) {
    return _report.report(scene, *_plan, _q, _answers, visitor);
}

} // namespace osgTSS
