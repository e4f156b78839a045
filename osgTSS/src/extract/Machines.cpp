#include "Machines.h"

#include "FindQuietly.h"
#include "TableFit.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osgTSS/JointTransform>

#include <algorithm>
#include <set>

namespace osgTSS {

namespace {

/// "Gun2" is a further "Gun".
bool sameKind(const std::string& path, const std::string& other) {
    const std::string name = tss::primName(path), first = tss::primName(other);
    return name.starts_with(first) && name.find_first_not_of("0123456789", first.size()) == name.npos;
}

/// Which of the joints of its node a found joint is.
int ordinal(const std::vector<osg::Node*>& nodes, int joint) {
    return static_cast<int>(std::count(nodes.begin(), nodes.begin() + joint, nodes[joint]));
}

} // namespace

Machines::Machines(osg::Node& root, const tss::SceneModel& model)
    : _root(root), _model(model), _tagged(findJointNodes(root)) {
    for (std::size_t j = 0; j < model.joints.size(); ++j)
        _modelJoints.emplace(model.joints[j].path, static_cast<int>(j));
}

const Machines::Extraction& Machines::extraction(bool activeOnly) {
    std::unique_ptr<Extraction>& made = activeOnly ? _active : _all;
    if (!made) {
        made = std::make_unique<Extraction>();
        made->found = &findQuietly(_root, made->visitor, activeOnly);
    }
    return *made;
}

/// Found joints that may be the model's: of the nodes that carry its path, or else of its name or, nameless,
/// of none.
std::vector<int> Machines::candidates(const Extraction& in, int joint, bool nameless) const {
    const std::vector<osg::Node*>& nodes = in.visitor.getJointNodes();
    const std::string& path = _model.joints[joint].path;
    std::vector<int> found;
    if (const auto tagged = _tagged.find(path); tagged != _tagged.end()) {
        // A chain of joints of one node keeps its order.
        int place = 0;
        for (int before = joint - 1; before >= 0; --before) {
            const auto other = _tagged.find(_model.joints[before].path);
            if (other == _tagged.end() || other->second.front() != tagged->second.front()) break;
            ++place;
        }
        for (std::size_t j = 0; j < nodes.size(); ++j)
            if (ordinal(nodes, static_cast<int>(j)) == place &&
                std::ranges::find(tagged->second, nodes[j]) != tagged->second.end())
                found.push_back(static_cast<int>(j));
    }
    const auto isFree = [&](const osg::Node* node) {
        const auto placed = _placed.find(node);
        return placed == _placed.end() || placed->second.contains(path);
    };
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        const std::string& name = in.found->joints[j].path;
        const bool same = name == path || (!_modelJoints.contains(name) && sameKind(name, path)) ||
                          (nameless && nodes[j]->getName().empty() && isFree(nodes[j]));
        if (same && std::ranges::find(found, static_cast<int>(j)) == found.end())
            found.push_back(static_cast<int>(j));
    }
    return found;
}

/// All chains of candidates of the pair's joints that hang on each other.
void Machines::extend(const Extraction& in, const tss::Pair& pair, bool nameless, std::vector<int>& chain,
                      std::vector<std::vector<int>>& chains) const {
    constexpr std::size_t most = 10000;
    if (chain.size() == pair.joints.size()) return chains.push_back(chain);
    for (int next : candidates(in, pair.joints[chain.size()], nameless)) {
        if (chains.size() >= most) return;
        if (!chain.empty()) {
            const tss::Joint &a = in.found->joints[chain.back()], &b = in.found->joints[next];
            const bool touch = a.body0 == b.body0 || a.body0 == b.body1 || a.body1 == b.body0;
            if (!touch || std::ranges::find(chain, next) != chain.end()) continue;
        }
        chain.push_back(next);
        extend(in, pair, nameless, chain, chains);
        chain.pop_back();
    }
}

std::string Machines::unfit(const Extraction& in, const tss::Pair& pair,
                            const std::vector<int>& chain) const {
    // A graph that createGraph() made has the model's bodies as nodes of their own, which a visitor, that
    // knows joints alone, takes together.
    const std::vector<osg::Node*>& nodes = in.visitor.getJointNodes();
    bool made = true;
    for (std::size_t k = 0; k < chain.size() && made; ++k) {
        const auto* node = dynamic_cast<const JointTransform*>(nodes[chain[k]]);
        const tss::Joint& joint = _model.joints[pair.joints[k]];
        made = node && node->getJoint().path == joint.path && node->getNumChildren() > 0 &&
               joint.body1 >= 0 && bodyPath(*node->getChild(0)) == _model.bodies[joint.body1].path;
    }
    const tss::Joint &first = in.found->joints[chain.front()], &model = _model.joints[pair.joints.front()];
    if (made && model.body0 >= 0 && in.found->bodies[first.body0].path != _model.bodies[model.body0].path) {
        for (std::size_t k = 0; k < chain.size(); ++k) {
            const auto& node = static_cast<const JointTransform&>(*nodes[chain[k]]);
            const std::string why = whyWider(node.getJoint(), _model.joints[pair.joints[k]]);
            if (!why.empty()) return why;
        }
        return "";
    }
    return whyUnfit(*in.found, chain, _model, pair);
}

std::vector<PairPlace> Machines::placesOf(int index, std::string& why, bool nameless) {
    const tss::Pair& pair = _model.pairs[index];
    std::vector<PairPlace> places;
    why = "no nodes of the graph carry its joints";
    if (pair.joints.empty()) return places;
    // What is shown now is looked at where all that can be shown does not fit.
    for (bool activeOnly : {false, true}) {
        const Extraction& in = extraction(activeOnly);
        std::vector<int> chain;
        std::vector<std::vector<int>> chains;
        extend(in, pair, nameless, chain, chains);
        for (const std::vector<int>& found : chains) {
            const std::string not_ = unfit(in, pair, found);
            if (!not_.empty()) {
                if (!activeOnly) why = not_;
                continue;
            }
            PairPlace place{index, {}};
            for (int joint : found) place.joints.push_back(in.visitor.getJointNodes()[joint]);
            places.push_back(std::move(place));
        }
        if (!places.empty() || chains.empty()) break;
    }
    return places;
}

std::vector<std::string> Machines::unknown() {
    std::vector<std::string> lines;
    std::set<const osg::Node*> shared;
    for (std::size_t p = 0; p < _model.pairs.size(); ++p) {
        const tss::Pair& pair = _model.pairs[p];
        if (!pair.table && !pair.proof) continue;
        bool there = true;
        for (int joint : pair.joints) {
            const std::string& path = _model.joints[joint].path;
            const auto nodes = _tagged.find(path);
            there = there && nodes != _tagged.end();
            if (!there) break;
            osg::Node& node = *nodes->second.front();
            if (pathsFrom(_root, node).size() > 1 && shared.insert(&node).second)
                lines.push_back(
                    "joint " + path +
                    " is there over several parents: it is kept apart as at the first of them, and "
                    "what the others meet is not looked at");
        }
        std::string why;
        if (there && placesOf(static_cast<int>(p), why).empty())
            lines.push_back("pair " + pair.path + " is kept apart by what does not fit the graph: " + why);
    }
    return lines;
}

void Machines::tag(const PairPlace& place) {
    const tss::Pair& pair = _model.pairs[place.pair];
    const Extraction& in = *_all;
    const std::vector<osg::Node*>& nodes = in.visitor.getJointNodes();
    const auto tagOf = [&](int found, int model) {
        const ConstraintVisitor::BodyNode& at = in.visitor.getBodyNodes()[found];
        if (at.node && model >= 0) tagBody(*at.node, _model.bodies[model].path, at.scale);
    };
    for (std::size_t k = 0; k < place.joints.size(); ++k) {
        const tss::Joint& joint = _model.joints[pair.joints[k]];
        _placed[place.joints[k]].insert(joint.path);
        if (const auto tagged = _tagged.find(joint.path);
            tagged != _tagged.end() &&
            std::ranges::find(tagged->second, place.joints[k]) != tagged->second.end())
            continue; // it and its bodies are named already
        tagJoint(*place.joints[k], joint.path);
        for (std::size_t j = 0; j < nodes.size(); ++j)
            if (nodes[j] == place.joints[k]) {
                tagOf(in.found->joints[j].body0, joint.body0);
                tagOf(in.found->joints[j].body1, joint.body1);
            }
    }
}

} // namespace osgTSS
