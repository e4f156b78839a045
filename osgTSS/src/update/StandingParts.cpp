#include "StandingParts.h"

#include "PairBodies.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/UserFlag.h"
#include "osgTSS/src/extract/MovedNodes.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/AutoTransform>
#include <osg/Camera>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/PagedLOD>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>
#include <osgTSS/Overlay>

#include <algorithm>
#include <functional>
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

} // namespace

/// Machine by machine, which is all that joints hold together, and body by body of each.
class StandingParts::Collect : public osg::NodeVisitor {
public:
    Collect(StandingParts& into) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _into(into) {
        setNodeMaskOverride(~0u);
        collect([&] { into._root.accept(*this); });
    }

    void apply(osg::Node& node) override {
        if (dynamic_cast<Overlay*>(&node) || !_seen.insert(&node).second) return;
        look(node);
    }
    void apply(osg::PagedLOD&) override {}
    void apply(osg::Drawable& drawable) override {
        ++_body->items;
        ++_body->drawn;
        if (_seen.insert(&drawable).second) look(drawable);
    }
    void apply(osg::Transform& node) override {
        if (!_seen.insert(&node).second) return;
        if (isJoint(node)) {
            _machine->served = _machine->served || carriesJoint(node);
            ++_body->items;
            Body own, *const above = std::exchange(_body, &own);
            look(node);
            for (const auto& [place, below] : own.fixed)
                if (below > 0) _machine->parts.push_back(_machine->all[place]);
            _body = above;
        } else if (movesOtherwise(node)) {
            collect([&] { look(node); });
        } else {
            const std::size_t before = _body->items, drawn = _body->drawn, place = _machine->all.size();
            _machine->all.push_back({&node, true, _known, numberOf(node, true)});
            look(node);
            _machine->all[place].known = _known && _body->drawn > drawn;
            _body->fixed.emplace_back(place, _body->items - before);
        }
    }

private:
    struct Body {
        std::size_t items = 0;                                  ///< drawables, and joints of others
        std::size_t drawn = 0;                                  ///< drawables that tables know
        std::vector<std::pair<std::size_t, std::size_t>> fixed; ///< places in `all`, and items below
    };
    struct Machine {
        bool served = false;     ///< tables or proofs are for some of its joints
        std::vector<Part> all;   ///< its fixed transforms
        std::vector<Part> parts; ///< what is looked at
    };

    void look(osg::Node& node) {
        const bool above = std::exchange(_known, _known && !_into.cameSince(node));
        Part part{&node, false, _known, numberOf(node, false)};
        if (osg::Group* group = node.asGroup())
            for (unsigned int k = 0; k < group->getNumChildren(); ++k) {
                osg::Node& child = *group->getChild(k);
                const std::size_t before = _body->drawn;
                child.accept(*this);
                const bool known = _known && !_into.cameSince(child);
                part.children.emplace_back(&child, known && _body->drawn > before);
            }
        else
            traverse(node);
        _machine->parts.push_back(std::move(part));
        _known = above;
    }

    /// Of a machine it does not matter where it stands as a whole.
    template <class Below>
    void collect(const Below& below) {
        Machine own, *const outer = std::exchange(_machine, &own);
        Body top, *const above = std::exchange(_body, &top);
        below();
        _machine = outer;
        _body = above;
        if (!own.served) return;
        for (const auto& [place, items] : top.fixed)
            if (items > 0 && items < top.items) own.parts.push_back(own.all[place]);
        _into._parts.insert(_into._parts.end(), own.parts.begin(), own.parts.end());
    }

    StandingParts& _into;
    std::set<const osg::Node*> _seen;
    bool _known = true;
    Body* _body = nullptr;
    Machine* _machine = nullptr;
};

StandingParts::StandingParts(osg::Node& root, const tss::SceneModel& model) : _root(root), _model(model) {
    Collect(*this);
}

bool StandingParts::cameSince(osg::Node& node) const {
    const auto found = _since.find(&node);
    return found != _since.end() && found->second.valid();
}

std::size_t StandingParts::numberOf(const osg::Node& node, bool fixed) {
    std::size_t number = 1;
    const auto add = [&](auto value) { number = number * 31 + std::hash<decltype(value)>()(value); };
    if (fixed) {
        osg::Matrix matrix;
        node.asTransform()->computeLocalToWorldMatrix(matrix, nullptr);
        std::for_each(matrix.ptr(), matrix.ptr() + 16, add);
    } else if (const osg::Group* group = node.asGroup()) {
        for (unsigned int k = 0; k < group->getNumChildren(); ++k)
            if (!dynamic_cast<const Overlay*>(group->getChild(k))) add(group->getChild(k));
    } else if (const osg::Geometry* geometry = node.asGeometry()) {
        add(geometry->getVertexArray() ? geometry->getVertexArray()->getNumElements() : 0u);
    }
    return number;
}

/// What is gone is missed by the group that it was in.
bool StandingParts::isOther(const Part& part) const {
    return part.node.valid() &&
           (numberOf(*part.node, part.fixed) != part.number ||
            std::ranges::any_of(part.children, [](const auto& child) { return !child.first.valid(); }));
}

/// Of a group: what is new below it, or gone.
bool StandingParts::childConcerns(const Part& part, const osg::NodePath& path, PairBodies& bodies) {
    osg::Group& group = *part.node->asGroup();
    for (const auto& [child, known] : part.children)
        if (known && !group.containsNode(child.get()) && bodies.hold(path)) return true;
    for (unsigned int k = 0; k < group.getNumChildren(); ++k) {
        osg::Node& child = *group.getChild(k);
        const auto same = [&](const auto& was) { return was.first.get() == &child; };
        if (dynamic_cast<Overlay*>(&child) || std::ranges::any_of(part.children, same)) continue;
        if (bodies.separatedBy(child) || bodies.mayBeMetBy(child, path)) return true;
        _since[&child] = &child;
    }
    return false;
}

/// Says what has come to a body of a pair; empty: nothing has.
std::string StandingParts::whatConcerns(const Part& part, PairBodies& bodies) {
    const std::string geometry = "the geometry at node \"" + part.node->getName() + "\" is other than";
    for (const osg::NodePath& path : pathsFrom(_root, *part.node)) {
        const osg::NodePath above(path.begin(), path.end() - 1);
        if (part.node->asGroup() && !part.fixed) {
            if (childConcerns(part, path, bodies)) return geometry;
            continue;
        }
        const bool carried = part.fixed && bodies.separatedBy(*part.node);
        if (carried || (part.known && bodies.hold(path)) || bodies.mayBeMetBy(*part.node, above))
            return part.fixed ? "transform \"" + part.node->getName() + "\" stands elsewhere than" : geometry;
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
    // From here on what is there now is what was there, but for what tables do not know.
    _parts.clear();
    _next = 0;
    _pause = calls;
    Collect(*this);
    return std::nullopt;
}

} // namespace osgTSS
