#pragma once
#include <osg/Math>

#include <cmath>
#include <cstddef>
#include <vector>

namespace osgTSS {

/// Reads and writes the values of a joint on the node that carries them.
class JointNode {
public:
    virtual ~JointNode() = default;

    /// The node is still there.
    virtual bool valid() const = 0;
    virtual std::size_t dofCount() const = 0;
    /// Before anything writes: what was asked for last comes back, so that an animation that steps from its
    /// own last value, or an application that asks once, does not see that it was stopped.
    virtual void restoreAsked() = 0;
    /// What is asked for.
    virtual std::vector<double> asked() const = 0;
    /// What the node shows.
    virtual std::vector<double> shown() const = 0;
    /// Shows these values.
    virtual void show(const std::vector<double>& values) = 0;
};

/// How far an angle is from the one nearest to `middle` that differs from it by whole turns.
inline double wholeTurns(double angle, double middle) {
    return 2 * osg::PI * std::round((angle - middle) / (2 * osg::PI));
}

} // namespace osgTSS
