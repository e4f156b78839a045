#pragma once
#include "Playback.h"

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/UpdateBone>

#include <map>
#include <string>
#include <vector>

/// A graph with a skeleton whose bones keys turn, and a mesh that is bound to them.
class Rigged {
public:
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager = new osgAnimation::BasicAnimationManager;
    osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    std::map<std::string, osgAnimation::Bone*> bones;

    Rigged() {
        root->addChild(skeleton);
        skeleton->setDefaultUpdateCallback();
        root->addUpdateCallback(manager);
    }

    static osg::Quat turn(double degrees, const osg::Vec3& axis = osg::Vec3(0, 1, 0)) {
        return osg::Quat(osg::DegreesToRadians(degrees), axis);
    }

    /// above: its parent's name, empty: the skeleton. bound: in the skeleton, where the mesh is bound to it.
    /// now: how it is turned from there in the file.
    osgAnimation::Bone* addBone(const std::string& name, const std::string& above, const osg::Matrix& bound,
                                const osg::Quat& now = osg::Quat()) {
        osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
        osgAnimation::Bone* parent = above.empty() ? nullptr : bones.at(above);
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::inverse(bound));
        bone->setMatrixInSkeletonSpace(bound);
        const osg::Matrix local = parent ? bound * parent->getInvBindMatrixInSkeletonSpace() : bound;
        bone->setMatrix(osg::Matrix::rotate(now) * local);
        osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
        update->getStackedTransforms().push_back(new osgAnimation::StackedMatrixElement("bindmatrix", local));
        update->getStackedTransforms().push_back(
            new osgAnimation::StackedQuaternionElement("quaternion", now));
        bone->setUpdateCallback(update);
        bones[name] = bone;
        (parent ? static_cast<osg::Group&>(*parent) : *skeleton).addChild(bone);
        return bone;
    }

    /// step: seconds from one to the next.
    void addKeys(const std::string& bone, const std::vector<osg::Quat>& turns, double step = 0.5) {
        osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
            new osgAnimation::QuatSphericalLinearChannel;
        channel->setName("quaternion");
        channel->setTargetName(bone);
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        for (const osg::Quat& one : turns)
            keys->push_back(osgAnimation::QuatKeyframe(step * double(keys->size()), one));
        animation->addChannel(channel);
    }

    /// The same as whole matrices, as Collada's files have them.
    void addMatrixKeys(const std::string& bone, const std::vector<osg::Quat>& turns, double step) {
        osg::ref_ptr<osgAnimation::MatrixLinearChannel> channel = new osgAnimation::MatrixLinearChannel;
        channel->setName("bindmatrix");
        channel->setTargetName(bone);
        const osg::Matrixd local = bones.at(bone)->getMatrix();
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        for (const osg::Quat& one : turns)
            keys->push_back(osgAnimation::MatrixKeyframe(step * double(keys->size()),
                                                         osg::Matrixf(osg::Matrixd::rotate(one) * local)));
        animation->addChannel(channel);
    }
};
