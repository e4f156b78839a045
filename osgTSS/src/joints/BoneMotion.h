#pragma once
#include "AnimationChannels.h"
#include "FoundJoint.h"

#include <osg/Matrixd>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <optional>

namespace osgTSS {

/// Turns of less than this (radians, from the mean of all keys) are no degree of freedom, and axes that are
/// scaled differently by less are a turn all the same: what keys are rounded by, and bones sheared between
/// matrices as keys; or the user value "osgTSS:still" (degrees) of the bone.
double boneStill(const osg::Node& bone);

/// How a bone moves against its parent node, by the keys of all animations and the pose that it was bound in.
/// One joint whose DOFs are the axes that the keys use: "slide.x" ... "slide.z", then one "turn", or "turn1"
/// to "turn3"; its limits are the range of the keys and tss::keysSlack (tss::keyedJoint()). A joint without
/// DOFs is a bone that stands, where its frame0 is. Rest is the bound pose; where a skin is bound to a bone
/// that stands otherwise without any key, it is a joint from the one pose to the other. Throws
/// tss::InputError with the reason for keys that are no rigid motion, or turn too far about several axes.
FoundJoints boneMotion(osgAnimation::Bone& bone, const AnimationChannels& channels);

/// The matrices that the keys of each animation take a bone through, also between keys: what its stack of
/// elements says at those times. Empty where no channel moves an element of it.
std::vector<std::vector<osg::Matrixd>> boneRuns(osgAnimation::Bone& bone, const AnimationChannels& channels);

/// What the stack of the bone says now; the bone's own matrix where it has none.
osg::Matrixd boneNow(osgAnimation::Bone& bone);

/// Where a bone stands in its parent when the mesh is bound to it; nothing for one that says nothing of that.
std::optional<osg::Matrixd> boneBound(osgAnimation::Bone& bone);

/// The skeleton that a bone is part of; null where there is none above.
osgAnimation::Skeleton* skeletonOf(osg::Node& bone);

/// Whether a mesh of the bone's skeleton is tagged as a skin.
bool wearsSkin(osgAnimation::Bone& bone);

} // namespace osgTSS
