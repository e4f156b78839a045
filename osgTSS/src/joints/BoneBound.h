#pragma once
#include <osg/Matrixd>
#include <osgAnimation/Bone>

#include <optional>

namespace osgTSS {

/// Where a bone stands in its parent when the mesh is bound to it; nothing for one that says nothing of that.
std::optional<osg::Matrixd> boneBound(osgAnimation::Bone& bone);

/// Whether a mesh of the bone's skeleton is tagged as a skin.
bool wearsSkin(osgAnimation::Bone& bone);

} // namespace osgTSS
