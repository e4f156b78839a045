#include "MovedNodes.h"

#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Skeleton>
#include <osgTSS/JointCallback>
#include <osgTSS/LimitsCallback>
#include <osgTSS/MuscleCallback>
#include <osgTSS/SkinCallback>

namespace osgTSS {

bool movesItself(osg::Node& node) {
    for (osg::Callback* callback = node.getUpdateCallback(); callback;
         callback = callback->getNestedCallback()) {
        const bool others =
            dynamic_cast<JointCallback*>(callback) || dynamic_cast<LimitsCallback*>(callback) ||
            dynamic_cast<MuscleCallback*>(callback) || dynamic_cast<SkinCallback*>(callback) ||
            dynamic_cast<osgAnimation::AnimationManagerBase*>(callback) ||
            dynamic_cast<osgAnimation::Skeleton::UpdateSkeleton*>(callback);
        if (!others) return true;
    }
    return false;
}

} // namespace osgTSS
