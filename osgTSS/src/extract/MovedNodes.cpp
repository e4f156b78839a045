#include "MovedNodes.h"

#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Skeleton>
#include <osgTSS/JointCallback>
#include <osgTSS/LimitsCallback>
#include <osgTSS/MuscleCallback>
#include <osgTSS/SkinCallback>

namespace osgTSS {

bool isInstalled(const osg::Callback& callback) {
    return dynamic_cast<const JointCallback*>(&callback) || dynamic_cast<const LimitsCallback*>(&callback) ||
           dynamic_cast<const MuscleCallback*>(&callback) || dynamic_cast<const SkinCallback*>(&callback);
}

bool movesItself(osg::Node& node) {
    for (osg::Callback* callback = node.getUpdateCallback(); callback;
         callback = callback->getNestedCallback())
        if (!isInstalled(*callback) && !dynamic_cast<osgAnimation::AnimationManagerBase*>(callback) &&
            !dynamic_cast<osgAnimation::Skeleton::UpdateSkeleton*>(callback))
            return true;
    return false;
}

} // namespace osgTSS
