#include "StandingParts.h"

#include "osgTSS/src/extract/MovedNodes.h"
#include "osgTSS/src/joints/JointNodes.h"
#include "osgTSS/src/joints/TaggedJoint.h"

#include <osg/AutoTransform>
#include <osg/Camera>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/PagedLOD>
#include <osg/ValueObject>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>
#include <osgSim/DOFTransform>
#include <osgTSS/JointTransform>
#include <osgTSS/Overlay>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

namespace osgTSS {

namespace {

constexpr std::size_t calls = 64;

bool isJoint(osg::Node& node) {
    return dynamic_cast<JointTransform*>(&node) || dynamic_cast<osgSim::DOFTransform*>(&node) ||
           dynamic_cast<osgAnimation::Bone*>(&node) || isTagged(node) || carriesJoint(node);
}

/// What stands below does so whatever stands beside the node.
bool movesOtherwise(osg::Node& node) {
    bool moved = false;
    return dynamic_cast<osg::AutoTransform*>(&node) || dynamic_cast<osg::Camera*>(&node) ||
           dynamic_cast<osgAnimation::Skeleton*>(&node) || movesItself(node) ||
           (node.getUserValue("osgTSS:moved", moved) && moved);
}

} // namespace

/// Machine by machine, which is all that joints hold together, and body by body of each.
class StandingParts::Collect : public osg::NodeVisitor {
public:
    Collect(osg::Node& root, std::vector<Part>& parts)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _parts(parts) {
        setNodeMaskOverride(~0u);
        collect([&] { root.accept(*this); });
    }

    void apply(osg::Node& node) override {
        if (dynamic_cast<Overlay*>(&node) || !_seen.insert(&node).second) return;
        add(node, false);
        traverse(node);
    }
    void apply(osg::PagedLOD&) override {}
    void apply(osg::Drawable& drawable) override {
        ++_body->items;
        if (_seen.insert(&drawable).second) add(drawable, false);
    }
    void apply(osg::Transform& node) override {
        if (!_seen.insert(&node).second) return;
        add(node, false);
        if (isJoint(node)) {
            _machine->served = _machine->served || carriesJoint(node);
            ++_body->items;
            Body own, *const above = std::exchange(_body, &own);
            traverse(node);
            for (const auto& [place, below] : own.fixed)
                if (below > 0) _machine->parts.push_back(_machine->all[place]);
            _body = above;
        } else if (movesOtherwise(node)) {
            collect([&] { traverse(node); });
        } else {
            const std::size_t before = _body->items, place = _machine->all.size();
            _machine->all.push_back({&node, true, numberOf(node, true)});
            traverse(node);
            _body->fixed.emplace_back(place, _body->items - before);
        }
    }

private:
    struct Body {
        std::size_t items = 0;                                  ///< drawables, and joints of others
        std::vector<std::pair<std::size_t, std::size_t>> fixed; ///< places in `all`, and items below
    };
    struct Machine {
        bool served = false;     ///< tables or proofs are for some of its joints
        std::vector<Part> all;   ///< its fixed transforms
        std::vector<Part> parts; ///< what is looked at
    };

    void add(osg::Node& node, bool fixed) {
        _machine->parts.push_back({&node, fixed, numberOf(node, fixed)});
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
        _parts.insert(_parts.end(), own.parts.begin(), own.parts.end());
    }

    std::vector<Part>& _parts;
    std::set<const osg::Node*> _seen;
    Body* _body = nullptr;
    Machine* _machine = nullptr;
};

StandingParts::StandingParts(osg::Node& root) {
    Collect(root, _parts);
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

std::optional<std::string> StandingParts::changed() {
    for (std::size_t k = (_parts.size() + calls - 1) / calls; k-- > 0;) {
        const Part& part = _parts[_next];
        _next = (_next + 1) % _parts.size();
        // What is gone is missed by the group that it was in.
        if (!part.node.valid() || numberOf(*part.node, part.fixed) == part.number) continue;
        const std::string what = part.fixed
                                     ? "transform \"" + part.node->getName() + "\" stands elsewhere than"
                                     : "the geometry at node \"" + part.node->getName() + "\" is other than";
        _parts.clear();
        return what;
    }
    return std::nullopt;
}

} // namespace osgTSS
