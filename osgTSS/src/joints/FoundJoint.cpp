#include "FoundJoint.h"

#include "bake/base/Error.h"

#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>

namespace osgTSS {

void scaleLengths(tss::Joint& joint, double factor) {
    if (factor == 1) return;
    joint.frame0.translation() *= factor;
    joint.frame1.translation() *= factor;
    for (tss::Dof& dof : joint.dofs) {
        dof.origin *= factor;
        if (dof.kind == tss::DofKind::Translation) dof.axis *= factor;
        dof.frame.translation() *= factor;
        for (tss::PathRow& row : dof.path) row.translation *= factor;
    }
}

tss::Pose rigid(const osg::Matrixd& matrix, const char* what, double* off) {
    const auto similarity = toSimilarity(matrix);
    const double grown = similarity ? std::abs(similarity->scale - 1) : 0;
    if (off && similarity) *off = std::max({*off, similarity->off, grown});
    if (!similarity || grown > fewDigits)
        throw tss::InputError(std::string(what) +
                              ": expected a rigid matrix, without scale, shear or mirror");
    return similarity->pose;
}

double evenScale(const osg::Vec3d& scale, double& off) {
    const double along = scale.x();
    const double uneven = std::max(std::abs(scale.y() - along), std::abs(scale.z() - along));
    if (!(std::abs(along) > 0) || !(uneven <= fewDigits * std::abs(along))) return 0;
    off = std::max(off, uneven / std::abs(along));
    return std::abs(along - 1) < std::max(1e-6, off) ? 1 : along; // as toSimilarity()
}

} // namespace osgTSS
