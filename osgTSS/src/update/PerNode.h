#pragma once
#include <osg/Node>
#include <osg/observer_ptr>

#include <memory>
#include <mutex>
#include <unordered_map>

namespace osgTSS {

/// A state for each node that a callback stands on: shallow copies of a graph share their callbacks, a crowd
/// a thousand times, and may be updated in several threads, each of its own copies. States of nodes that are
/// gone are dropped by and by.
template <class State>
class PerNode {
public:
    /// The state of the node, made by `make` (which returns a unique_ptr) when there is none, or when `good`
    /// says that it is no longer good. `make` is given the old one, which may be null.
    template <class Make, class Good>
    State& of(osg::Node& node, const Make& make, const Good& good) {
        const std::lock_guard lock(_mutex);
        Entry& entry = _entries[&node];
        // Another node may stand where one that is gone stood.
        if (entry.state && !entry.node.valid()) entry.state = nullptr;
        if (!entry.state || !good(*entry.state)) {
            entry.node = &node;
            entry.state = make(entry.state.get());
            dropGone();
        }
        return *entry.state;
    }

    /// Null when there is none.
    const State* find(const osg::Node& node) const {
        const std::lock_guard lock(_mutex);
        const auto found = _entries.find(&node);
        return found != _entries.end() && found->second.node.valid() ? found->second.state.get() : nullptr;
    }

    void erase(const osg::Node& node) {
        const std::lock_guard lock(_mutex);
        _entries.erase(&node);
    }
    void clear() {
        const std::lock_guard lock(_mutex);
        _entries.clear();
    }

private:
    struct Entry {
        osg::observer_ptr<osg::Node> node;
        std::unique_ptr<State> state;
    };

    /// Each time that there are twice as many as were left: a constant cost a state.
    void dropGone() {
        if (_entries.size() < 2 * _left + 8) return;
        std::erase_if(_entries, [](const auto& entry) { return !entry.second.node.valid(); });
        _left = _entries.size();
    }

    mutable std::mutex _mutex;
    std::unordered_map<const osg::Node*, Entry> _entries; // whose states stay where they are
    std::size_t _left = 0;
};

} // namespace osgTSS
