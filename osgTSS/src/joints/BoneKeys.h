#pragma once
#include "AnimationChannels.h"

#include <osg/Matrixd>
#include <osgAnimation/Bone>

namespace osgTSS {

/// The matrices that the keys of each animation take a bone through, also between keys: what its stack of
/// elements says at those times. Empty where no channel moves an element of it.
std::vector<std::vector<osg::Matrixd>> boneRuns(osgAnimation::Bone& bone, const AnimationChannels& channels);

/// What the stack of the bone says now; the bone's own matrix where it has none.
osg::Matrixd boneNow(osgAnimation::Bone& bone);

} // namespace osgTSS
