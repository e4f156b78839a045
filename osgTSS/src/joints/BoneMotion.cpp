#include "BoneMotion.h"

#include "bake/base/Error.h"
#include "bake/character/KeyedJoint.h"
#include "bake/motion/WholeTurn.h"

#include <osg/ValueObject>
#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace osgTSS {

namespace {

/// Poses of the bone against its parent, and the scale that it has at all of them.
struct Samples : tss::KeyedPoses {
    bool skin = false; ///< that of its skeleton follows it
    double scale = 0;
    double off = 0;

    void add(const osg::Matrixd& matrix, bool first) {
        constexpr double most = 0.05;
        const auto similarity = toSimilarity(matrix, std::max(still, most));
        if (!similarity) throw tss::InputError("its keys shear it, or scale its axes differently");
        if (scale == 0) scale = similarity->scale;
        if (std::abs(similarity->scale - scale) > std::max(still, similarity->off) * std::abs(scale))
            throw tss::InputError(std::string("its keys change its size") +
                                  (skin ? ", which its skin does not follow" : ""));
        off = std::max(off, similarity->off);
        size = std::max(size, similarity->pose.translation().norm());
        samples.push_back({similarity->pose, first});
    }
};

Samples samplesOf(osgAnimation::Bone& bone, const AnimationChannels& channels) {
    Samples samples;
    samples.still = boneStill(bone);
    samples.skin = wearsSkin(bone);
    for (const auto& run : boneRuns(bone, channels))
        for (std::size_t k = 0; k < run.size(); ++k) samples.add(run[k], k == 0);
    if (samples.off > samples.still) {
        std::ostringstream text;
        text.precision(2);
        text << "between its keys, which are matrices, OpenSceneGraph scales its axes differently, by up to "
             << 100 * samples.off << " %: still=" << std::ceil(20 * samples.off * 360 / tss::fullTurn) / 20
             << " in -O takes that for none, more keys make it less";
        throw tss::InputError(text.str());
    }
    const std::optional<osg::Matrixd> bound = boneBound(bone);
    // A bone that no key moves may stand otherwise than it is bound, which only a skin looks at.
    const bool keyed = !samples.samples.empty();
    if (!keyed) samples.add(boneNow(bone), true);
    if (bound && (keyed || samples.skin) && toSimilarity(*bound)) {
        samples.rest = samples.samples.size();
        samples.add(*bound, true);
        samples.size = std::max(samples.size, bone.getInvBindMatrixInSkeletonSpace().getTrans().length());
    }
    return samples;
}

} // namespace

double boneStill(const osg::Node& bone) {
    constexpr double rounded = tss::keysStill;
    double degrees = 0;
    return bone.getUserValue("osgTSS:still", degrees) && degrees > 0
               ? std::max(rounded, degrees * tss::fullTurn / 360)
               : rounded;
}

FoundJoints boneMotion(osgAnimation::Bone& bone, const AnimationChannels& channels) {
    const Samples samples = samplesOf(bone, channels);
    const tss::KeyedJoint keyed = tss::keyedJoint(samples);
    FoundJoints found;
    found.scale = samples.scale;
    // Neither a text file's digits nor what was taken for standing still are worth a word for each bone.
    found.off = std::max(samples.off, keyed.off);
    if (found.off <= samples.still) found.off = 0;
    found.joints = {keyed.joint};
    return found;
}

} // namespace osgTSS
