#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <string>
#include <vector>

namespace osgTSS {

/// The joints that a node is, from its parent's frame inwards: one, or a chain where DOFs do not share a
/// frame.
struct FoundJoints {
    std::vector<tss::Joint> joints; ///< without bodies and paths
    double scale = 1;               ///< of what hangs below, the same at all times; negative: mirrored too
    std::string unlimited{}; ///< axes that slide without limits, taken to stay where they are; empty: none
    std::string turning{};   ///< axes that turn all the way round as none is limited, where two and more do
    double off = 0;          ///< how far a matrix in it is from the rotation that is taken for it
};

/// The lengths of a joint in other units; a negative factor is a mirror, which turns pass unchanged.
void scaleLengths(tss::Joint& joint, double factor);

/// The matrix as a rigid motion, the nearest one where it is written with few digits (`off`: raised to how
/// far that is). Throws tss::InputError that begins with `what` for another.
tss::Pose rigid(const osg::Matrixd& matrix, const char* what, double* off = nullptr);

/// The scale where it is the same in all directions, to `fewDigits` of it (`off`: raised to how far that is);
/// 0 where it is not.
double evenScale(const osg::Vec3d& scale, double& off);

} // namespace osgTSS
