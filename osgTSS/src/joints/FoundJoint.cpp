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

} // namespace osgTSS
