#include "StandingParts.h"

#include "PairBodies.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/UserValues.h"
#include "osgTSS/src/extract/MovedNodes.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/AutoTransform>
#include <osg/Camera>
#include <osg/Geometry>
#include <osg/PagedLOD>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgTSS/Overlay>

#include <set>
#include <utility>

namespace osgTSS {

namespace {

/// All is looked at once in so many calls; looking at the whole graph anew costs milliseconds, and is done at
/// most once in as many more.
constexpr std::size_t calls = 32;

bool isJoint(osg::Node& node) {
    return saysJoint(node) || dynamic_cast<osgAnimation::Bone*>(&node) || carriesJoint(node);
}

/// What stands below does so whatever stands beside the node.
bool movesOtherwise(osg::Node& node) {
    return dynamic_cast<osg::AutoTransform*>(&node) || dynamic_cast<osg::Camera*>(&node) ||
           dynamic_cast<osgAnimation::Skeleton*>(&node) || movesItself(node) || hasFlag(node, "osgTSS:moved");
}

/// What osgTSS shows left out.
std::vector<osg::Node*> childrenOf(osg::Node& node) {
    std::vector<osg::Node*> children;
    osg::Group* group = node.asGroup();
    for (unsigned int k = 0; group && k < group->getNumChildren(); ++k)
        if (!dynamic_cast<Overlay*>(group->getChild(k))) children.push_back(group->getChild(k));
    return children;
}

} // namespace

/// What osgAnimation deforms every update is known by its number of vertices alone.
StandingParts::Drawn StandingParts::drawnBy(const osg::Node& node) {
    const osg::Geometry* geometry = node.asGeometry();
    const osg::Array* vertices = geometry ? geometry->getVertexArray() : nullptr;
    if (!vertices) return {};
    Drawn drawn;
    drawn.count = vertices->getNumElements();
    if (dynamic_cast<const osgAnimation::RigGeometry*>(geometry) ||
        dynamic_cast<const osgAnimation::MorphGeometry*>(geometry))
        return drawn;
    drawn.vertices = vertices;
    drawn.modified = vertices->getModifiedCount();
    for (const auto& set : geometry->getPrimitiveSetList())
        if (set)
            for (const std::size_t value :
                 {reinterpret_cast<std::size_t>(set.get()), std::size_t(set->getMode()),
                  std::size_t(set->getNumIndices()), std::size_t(set->getModifiedCount())})
                drawn.primitives =
                    (drawn.primitives ^ value) * 0x9e3779b97f4a7c15; // golden ratio: spreads bits
    return drawn;
}

/// Machine by machine, which is all that joints hold together, and body by body of each.
class StandingParts::Collect {
public:
    explicit Collect(StandingParts& into) : _into(into) { addMachine(into._root, true); }

private:
    struct Machine {
        bool served = false; ///< tables or proofs are for some of its joints
        std::vector<Part> parts{};
    };
    /// What hangs at and below a node and is part of its body: drawables, and the joints of further bodies.
    struct Held {
        bool any = false, known = false;
        std::vector<std::size_t> whole{}; ///< the transforms that carry all of it, as parts of the machine

        void add(Held other) {
            if (!other.any) return;
            whole = any ? std::vector<std::size_t>() : std::move(other.whole);
            any = true;
            known = known || other.known;
        }
    };

    /// Where a machine stands as a whole does not matter, so that the places that carry all of it are
    /// dropped.
    void addMachine(osg::Node& top, bool known) {
        Machine outer = std::exchange(_machine, {});
        for (std::size_t part : addNode(top, known).whole) _machine.parts[part].place.reset();
        if (_machine.served) std::ranges::move(_machine.parts, std::back_inserter(_into._parts));
        _machine = std::move(outer);
    }

    Held addBelow(osg::Node& node, bool known) {
        known = known && !_into.cameSince(node);
        if (_seen.contains(&node)) return {node.asDrawable() != nullptr, node.asDrawable() && known};
        if (!node.asTransform() || isJoint(node) || !movesOtherwise(node)) return addNode(node, known);
        addMachine(node, known);
        return {};
    }

    Held addNode(osg::Node& node, bool known) {
        if (dynamic_cast<osg::PagedLOD*>(&node)) return {};
        _seen.insert(&node);
        Held held{node.asDrawable() != nullptr, node.asDrawable() && known};
        Part part{&node, known, drawnBy(node)};
        for (osg::Node* child : childrenOf(node)) {
            Held below = addBelow(*child, known);
            part.children.push_back({child, below.known});
            held.add(std::move(below));
        }
        if (node.asTransform() && isJoint(node)) {
            _machine.served = _machine.served || carriesJoint(node);
            held = {true};
        } else if (node.asTransform() && held.any) {
            part.known = held.known;
            part.place = ownMatrix(*node.asTransform());
            held.whole.push_back(_machine.parts.size());
        }
        _machine.parts.push_back(std::move(part));
        return held;
    }

    StandingParts& _into;
    std::set<const osg::Node*> _seen;
    Machine _machine;
};

StandingParts::StandingParts(osg::Node& root, const tss::SceneModel& model) : _root(root), _model(model) {
    Collect(*this);
}

bool StandingParts::cameSince(osg::Node& node) const {
    const auto found = _since.find(&node);
    return found != _since.end() && found->second.valid();
}

/// What is gone is missed by the group that it was in.
bool StandingParts::isOther(const Part& part) {
    osg::Node* node = part.node.get();
    if (!node) return false;
    const auto same = [](const Child& was, const osg::Node* is) { return was.node.get() == is; };
    return drawnBy(*node) != part.drawn || (part.place && ownMatrix(*node->asTransform()) != *part.place) ||
           !std::ranges::equal(part.children, childrenOf(*node), same);
}

/// Empty: nothing.
std::string StandingParts::whatConcerns(const Part& part, PairBodies& bodies) {
    osg::Node& node = *part.node;
    const std::vector<osg::Node*> children = childrenOf(node);
    const std::string geometry = "the geometry at node \"" + node.getName() + "\" is other than";
    for (const osg::NodePath& path : pathsFrom(_root, node)) {
        const bool moved = part.place && ownMatrix(*node.asTransform()) != *part.place;
        if (moved || drawnBy(node) != part.drawn) {
            // What a callback moves since then is a body of its own now.
            const osg::NodePath above(path.begin(), path.end() - 1);
            const bool own = moved && movesOtherwise(node);
            if ((part.known && bodies.hold(own ? above : path)) || bodies.mayBeMetBy(node, above))
                return moved ? "transform \"" + node.getName() + "\" stands elsewhere than" : geometry;
        }
        for (const Child& was : part.children)
            if (was.known && std::ranges::find(children, was.node.get()) == children.end() &&
                bodies.hold(path))
                return geometry;
        for (osg::Node* child : children) {
            if (std::ranges::find(part.children, child, [](const Child& was) { return was.node.get(); }) !=
                part.children.end())
                continue;
            if (bodies.mayBeMetBy(*child, path)) return geometry;
            _since[child] = child;
        }
    }
    return "";
}

std::optional<std::string> StandingParts::changed() {
    if (_pause > 0) {
        --_pause;
        return std::nullopt;
    }
    bool other = false;
    for (std::size_t k = (_parts.size() + calls - 1) / calls; k-- > 0 && !other;) {
        other = isOther(_parts[_next]);
        _next = (_next + 1) % _parts.size();
    }
    if (!other) return std::nullopt;
    PairBodies bodies(_root, _model);
    for (const Part& part : _parts) {
        if (!isOther(part)) continue;
        const std::string what = whatConcerns(part, bodies);
        if (what.empty()) continue;
        _parts.clear();
        return what;
    }
    _parts.clear();
    _next = 0;
    _pause = calls;
    Collect(*this);
    return std::nullopt;
}

} // namespace osgTSS
