#pragma once
#include <osg/Node>
#include <osg/observer_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <vector>

namespace osgTSS {

/// The skeletons at and below a node, so that what the bones are set to after their update is drawn: a rigged
/// mesh takes not their matrices, but those in the skeleton that their update callbacks have made of them.
class SkeletonPose {
public:
    explicit SkeletonPose(osg::Node& owner);

    /// Bones whose matrices are others than at their update, and all below them, get their matrices in the
    /// skeleton anew; the meshes of a skeleton where there are such are deformed once more. Nothing is done
    /// where nothing was set.
    void refresh() const;

private:
    struct One {
        osg::observer_ptr<osgAnimation::Skeleton> skeleton;
        std::vector<osg::observer_ptr<osgAnimation::Bone>> bones; ///< parents first; those with an update
    };
    std::vector<One> _skeletons;
};

} // namespace osgTSS
