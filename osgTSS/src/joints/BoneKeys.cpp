#include "BoneMotion.h"

#include "bake/base/Order.h"
#include "osgTSS/src/CallbackOf.h"

#include <osgAnimation/UpdateMatrixTransform>

#include <algorithm>

namespace osgTSS {

namespace {

using namespace osgAnimation;

/// Places looked at from one key to the next, as turns bend between keys.
constexpr int stepsBetweenKeys = 4;

/// Elements of its own, so that nothing of what plays is touched. What this animation does not move is where
/// another one begins that does: where it is now may be of the moment.
class StackCopy {
public:
    StackCopy(UpdateMatrixTransform& stack, const AnimationChannels::Channels& animation,
              const std::vector<AnimationChannels::Channels>& all) {
        for (const auto& element : stack.getStackedTransforms()) {
            _elements.push_back(osg::clone(element.get(), osg::CopyOp::DEEP_COPY_ALL));
            const Channels own = channelsOf(*_elements.back(), animation);
            _channels.insert(_channels.end(), own.begin(), own.end());
            for (std::size_t k = 0, moved = own.size(); moved == 0 && k < all.size(); ++k) {
                const Channels other = channelsOf(*_elements.back(), all[k]);
                for (const auto& channel : other) channel->update(channel->getStartTime(), 1, 0);
                moved = other.size();
            }
        }
    }

    /// Times of the keys, and times between them.
    std::vector<double> times() const {
        std::vector<double> all;
        for (const auto& channel : _channels) {
            const std::vector<double> keys = keyTimes(*channel);
            all.insert(all.end(), keys.begin(), keys.end());
        }
        tss::sortOnce(all);
        const bool curves =
            std::ranges::any_of(_channels, [](const auto& channel) { return isCurve(*channel); });
        return withSteps(all, curves ? stepsOfCurve : stepsBetweenKeys);
    }

    osg::Matrixd at(double time) {
        for (const auto& channel : _channels) channel->reset();
        for (const auto& channel : _channels) channel->update(time, 1, 0);
        _elements.update(static_cast<float>(time));
        return _elements.getMatrix();
    }

private:
    using Channels = std::vector<osg::ref_ptr<Channel>>;

    StackedTransform _elements;
    Channels _channels;
};

} // namespace

std::vector<std::vector<osg::Matrixd>> boneRuns(Bone& bone, const AnimationChannels& channels) {
    std::vector<std::vector<osg::Matrixd>> runs;
    UpdateMatrixTransform* stack = callbackOf<UpdateMatrixTransform>(bone.getUpdateCallback());
    if (!stack) return runs;
    const std::vector<AnimationChannels::Channels> animations = channels.of(bone, stack->getName());
    for (const AnimationChannels::Channels& animation : animations) {
        StackCopy copy(*stack, animation, animations);
        std::vector<osg::Matrixd> run;
        for (const double time : copy.times()) run.push_back(copy.at(time));
        if (!run.empty()) runs.push_back(std::move(run));
    }
    return runs;
}

osg::Matrixd boneNow(Bone& bone) {
    UpdateMatrixTransform* stack = callbackOf<UpdateMatrixTransform>(bone.getUpdateCallback());
    return stack ? osg::Matrixd(stackMatrix(stack->getStackedTransforms())) : bone.getMatrix();
}

} // namespace osgTSS
