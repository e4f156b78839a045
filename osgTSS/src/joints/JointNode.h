#pragma once
#include "bake/motion/DofUnits.h"
#include "bake/motion/WholeTurn.h"

#include <osg/observer_ptr>

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace osgTSS {

/// How a node stands where the joint that was found in it does not.
struct Stray {
    std::string what;
    bool unserved = false; ///< nothing can be said of its pairs there; else it is held at its limits
};

/// How far beyond a limit the floats of nodes and their matrices may have put a value.
inline double nodeRounding(const tss::Dof& dof) {
    return tss::belowRange(dof, 1e-5 * (1 + std::abs(dof.lower) + std::abs(dof.upper)));
}

/// What to say of a value beyond the limits of a DOF; nothing for one within, and for a whole turn.
inline std::optional<Stray> beyondLimits(const tss::Dof& dof, double value) {
    const double slack = nodeRounding(dof);
    if (tss::wholeTurn(dof) || (value >= dof.lower - slack && value <= dof.upper + slack))
        return std::nullopt;
    std::ostringstream text;
    text << "it is asked for " << dof.name << " " << tss::toUser(dof, value) << ", beyond the limits "
         << tss::toUser(dof, dof.lower) << " to " << tss::toUser(dof, dof.upper);
    return Stray{text.str(), false};
}

/// Reads and writes the values of a joint on the node that carries them.
class JointNode {
public:
    virtual ~JointNode() = default;

    /// The node is still there.
    virtual bool valid() const = 0;
    /// Before anything writes: what was asked for last comes back, so that an animation that steps from its
    /// own last value, or an application that asks once, does not see that it was stopped.
    virtual void restoreAsked() {}
    /// What is asked for.
    virtual std::vector<double> asked() const = 0;
    /// What the node shows: what is asked for is written on it, unless it keeps both.
    virtual std::vector<double> shown() const { return asked(); }
    /// Whether what is asked for is within what the joint was made for.
    virtual std::optional<Stray> stray() const { return std::nullopt; }
    /// Shows these values.
    virtual void show(const std::vector<double>& values) = 0;
};

/// A node on which what is shown is written over what was asked for. State: what of the node holds the
/// values. While nothing stops the joint, it is left exactly as it was set.
template <class Node, class State>
class OverwrittenNode : public JointNode {
public:
    explicit OverwrittenNode(Node& node) : _node(&node) {}

    bool valid() const override { return _node.valid(); }
    void restoreAsked() final {
        if (_stopped && read() == _shown) write(_asked);
    }
    void show(const std::vector<double>& values) final {
        _stopped = values != asked();
        if (!_stopped) return;
        _asked = read();
        write(stateAt(values));
        _shown = read();
    }

protected:
    virtual State read() const = 0;
    virtual void write(const State& state) = 0;
    virtual State stateAt(const std::vector<double>& values) const = 0;

    const osg::observer_ptr<Node> _node;

private:
    bool _stopped = false;
    State _asked{}, _shown{};
};

} // namespace osgTSS
