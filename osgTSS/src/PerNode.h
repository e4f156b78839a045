#pragma once
#include <osg/Node>
#include <osg/observer_ptr>

#include <memory>
#include <vector>

namespace osgTSS {

/// A state for each node that a callback stands on: shallow copies of a graph share their callbacks. States
/// of nodes that are gone are dropped.
template <class State>
class PerNode {
public:
    /// The state of the node, made by `make` (which returns a unique_ptr) when there is none, or when `good`
    /// says that it is no longer good.
    template <class Make, class Good>
    State& of(osg::Node& node, const Make& make, const Good& good) {
        std::erase_if(_entries, [](const Entry& entry) { return !entry.node.valid(); });
        for (Entry& entry : _entries) {
            if (entry.node != &node) continue;
            if (!good(*entry.state)) entry.state = make();
            return *entry.state;
        }
        _entries.push_back({osg::observer_ptr<osg::Node>(&node), make()});
        return *_entries.back().state;
    }

private:
    struct Entry {
        osg::observer_ptr<osg::Node> node;
        std::unique_ptr<State> state;
    };
    std::vector<Entry> _entries;
};

} // namespace osgTSS
