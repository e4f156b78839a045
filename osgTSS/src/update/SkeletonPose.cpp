#include "SkeletonPose.h"

#include "osgTSS/src/CallbackOf.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/joints/BoneMotion.h"

#include <osgAnimation/RigGeometry>
#include <osgAnimation/UpdateBone>

#include <algorithm>

namespace osgTSS {

SkeletonPose::SkeletonPose(osg::Node& owner) {
    eachNode(owner, [&](osg::Node& node) {
        auto* bone = dynamic_cast<osgAnimation::Bone*>(&node);
        // One without such a callback keeps the matrix in the skeleton that it has.
        if (!bone || !callbackOf<osgAnimation::UpdateBone>(bone->getUpdateCallback())) return;
        osgAnimation::Skeleton* skeleton = skeletonOf(*bone);
        if (!skeleton) return;
        auto one = std::ranges::find(_skeletons, skeleton, [](const One& of) { return of.skeleton.get(); });
        if (one == _skeletons.end()) one = _skeletons.insert(one, One{skeleton, {}});
        one->bones.emplace_back(bone);
    });
}

void SkeletonPose::refresh() const {
    for (const One& one : _skeletons) {
        bool changed = false;
        for (const auto& bone : one.bones) {
            if (!bone.valid()) continue;
            const osgAnimation::Bone* parent = bone->getBoneParent();
            const osg::Matrix now =
                parent ? bone->getMatrix() * parent->getMatrixInSkeletonSpace() : bone->getMatrix();
            if (now == bone->getMatrixInSkeletonSpace()) continue;
            bone->setMatrixInSkeletonSpace(now);
            changed = true;
        }
        if (!changed || !one.skeleton.valid()) continue;
        eachNode(*one.skeleton, [&](osg::Node& node) { // meshes may have come
            auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(&node);
            if (rig && rig->getSkeleton() == one.skeleton.get()) rig->update();
        });
    }
}

} // namespace osgTSS
