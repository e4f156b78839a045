#include "BoneKeys.h"

#include "osgTSS/src/CallbackOf.h"

#include <osgAnimation/UpdateMatrixTransform>

#include <algorithm>

namespace osgTSS {

namespace {

using namespace osgAnimation;

/// Places looked at from one key to the next, the first key among them: turns bend between keys.
constexpr int stepsBetweenKeys = 4;

/// Elements of its own, so that nothing of what plays is touched.
class StackCopy {
public:
    StackCopy(UpdateMatrixTransform& stack, const AnimationChannels::Channels& channels) {
        for (const auto& element : stack.getStackedTransforms())
            _elements.push_back(osg::clone(element.get(), osg::CopyOp::DEEP_COPY_ALL));
        for (const auto& channel : channels)
            for (const auto& element : _elements) {
                if (element->getName() != channel->getName()) continue;
                osg::ref_ptr<Channel> copy = channel->clone();
                Target* target = element->getOrCreateTarget();
                if (target && copy->setTarget(target)) _channels.push_back(copy);
            }
    }

    std::vector<double> times() const {
        std::vector<double> all;
        for (const auto& channel : _channels) {
            const std::vector<double> keys = keyTimes(*channel);
            all.insert(all.end(), keys.begin(), keys.end());
        }
        std::ranges::sort(all);
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }

    osg::Matrixd at(double time) const {
        for (const auto& channel : _channels) channel->reset();
        for (const auto& channel : _channels) channel->update(time, 1, 0);
        osg::Matrix matrix;
        for (const auto& element : _elements) {
            element->update(static_cast<float>(time));
            if (!element->isIdentity()) element->applyToMatrix(matrix);
        }
        return matrix;
    }

private:
    std::vector<osg::ref_ptr<StackedTransformElement>> _elements;
    std::vector<osg::ref_ptr<Channel>> _channels;
};

} // namespace

std::vector<std::vector<osg::Matrixd>> boneRuns(Bone& bone, const AnimationChannels& channels) {
    std::vector<std::vector<osg::Matrixd>> runs;
    UpdateMatrixTransform* stack = callbackOf<UpdateMatrixTransform>(bone.getUpdateCallback());
    if (!stack) return runs;
    for (const AnimationChannels::Channels& animation : channels.of(stack->getName())) {
        const StackCopy copy(*stack, animation);
        const std::vector<double> times = copy.times();
        if (times.empty()) continue;
        std::vector<osg::Matrixd> run;
        for (std::size_t k = 0; k + 1 < times.size(); ++k)
            for (int step = 0; step < stepsBetweenKeys; ++step)
                run.push_back(copy.at(times[k] + (times[k + 1] - times[k]) * step / stepsBetweenKeys));
        run.push_back(copy.at(times.back()));
        runs.push_back(std::move(run));
    }
    return runs;
}

osg::Matrixd boneNow(Bone& bone) {
    UpdateMatrixTransform* stack = callbackOf<UpdateMatrixTransform>(bone.getUpdateCallback());
    if (!stack) return bone.getMatrix();
    osg::Matrix matrix;
    for (const auto& element : stack->getStackedTransforms())
        if (!element->isIdentity()) element->applyToMatrix(matrix);
    return matrix;
}

} // namespace osgTSS
