#include "SkeletonPose.h"

#include "osgTSS/src/CallbackOf.h"
#include "osgTSS/src/EachNode.h"

#include <osg/NodeVisitor>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/UpdateBone>

namespace osgTSS {

class SkeletonPose::Collect : public osg::NodeVisitor {
public:
    explicit Collect(std::vector<One>& found) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _found(found) {
        setNodeMaskOverride(~0u);
    }

    void apply(osg::Transform& node) override {
        auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(&node);
        const int above = _in;
        if (skeleton) {
            _in = static_cast<int>(_found.size());
            _found.emplace_back().skeleton = skeleton;
        } else if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node);
                   bone && _in >= 0 && callbackOf<osgAnimation::UpdateBone>(bone->getUpdateCallback())) {
            // One without such a callback keeps the matrix in the skeleton that it has.
            _found[_in].bones.emplace_back(bone);
        }
        traverse(node);
        _in = above;
    }

private:
    std::vector<One>& _found;
    int _in = -1;
};

SkeletonPose::SkeletonPose(osg::Node& owner) {
    Collect visitor(_skeletons);
    owner.accept(visitor);
    std::erase_if(_skeletons, [](const One& one) { return one.bones.empty(); });
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
