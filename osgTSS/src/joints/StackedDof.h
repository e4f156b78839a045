#pragma once
#include "AnimationChannels.h"

#include "bake/model/SceneModel.h"

#include <osg/observer_ptr>
#include <osgAnimation/UpdateMatrixTransform>

#include <array>

namespace osgTSS {

/// A DOF that an animated element of a stack gives.
struct MovedAxis {
    tss::Dof dof;
    tss::TimeSamples drive;
    Eigen::Quaterniond axes = Eigen::Quaterniond::Identity(); ///< the DOF's axes in the stack's
};

/// The DOFs of one element of a node, from the parent inwards; none when no channel moves it. Throws
/// tss::InputError.
std::vector<MovedAxis> movedAxes(const osgAnimation::StackedTransformElement& element, const osg::Node& node,
                                 const AnimationChannels& channels, const std::string& target,
                                 double timeCodesPerSecond);

/// One component of an element, read and written.
class StackedDof {
public:
    double value() const;
    void setValue(double value);

private:
    friend std::vector<StackedDof> findStackedDofs(osgAnimation::UpdateMatrixTransform&, const tss::Joint&);

    enum Part { ANGLE, TRANSLATION, TURN };
    osg::observer_ptr<osgAnimation::StackedTransformElement> _element;
    Part _part = ANGLE;
    int _index = 0;              ///< of a translation the axis, of a quaternion the place in `_order`
    std::array<int, 3> _order{}; ///< of a quaternion's turns
    double _middle = 0;          ///< of the limits, which a quaternion's angles are nearest to
};

/// The components of a stack that the DOFs of a joint name, one each; empty when one is missing.
std::vector<StackedDof> findStackedDofs(osgAnimation::UpdateMatrixTransform& animation,
                                        const tss::Joint& joint);

} // namespace osgTSS
