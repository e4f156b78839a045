#include "bake/pipeline/RestRule.h"

#include "bake/base/Error.h"
#include "bake/search/NodePairs.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace tss {

RuleAtRest ruleAtRest(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options) {
    const SphereFit &a = spheres.a, &b = spheres.b;
    RuleAtRest ruled;
    if (options.atRest == AtRest::Collide || spheres.clearanceAtRest > 0) return ruled;
    if (options.spheres != SphereMethod::Medial) {
        ruled.rule = ruleOfSpheres(a.spheres, b.spheres, motion, options.atRest);
        ruled.bySpheres = !ruled.rule.empty();
        return ruled;
    }
    if (a.region.empty() || b.region.empty()) return ruled;
    ruled.region = spheres.region;
    // Spheres stick out by up to their protrusion, so that depths that differ by less are not told apart; and
    // tests count as contact from a gap of epsilon on.
    if (options.atRest == AtRest::Offset)
        ruled.region.depth = depthAtRest(a.spheres, b.spheres, motion, a.region, b.region) +
                             spheres.protrusions / 2 + options.epsilon;
    ruled.rule = {a.region, b.region, ruled.region.depth};
    return ruled;
}

void checkRest(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options) {
    if (options.atRest == AtRest::Collide || options.spheres != SphereMethod::Medial) return;
    const SphereSet &a = spheres.a.spheres, &b = spheres.b.spheres;
    const ContactRule region(spheres.a.region, spheres.b.region, -1);
    const std::vector<double> rest = restValues(motion);
    double least = std::numeric_limits<double>::infinity();
    visitPairsWithin(SphereTree(a), SphereTree(b), pose(motion, rest), options.epsilon,
                     [&](std::uint32_t i, std::uint32_t j, double gap) {
                         if (!region.excepts({i, j})) least = std::min(least, gap);
                     });
    if (least <= options.epsilon)
        throw InputError(
            fmt::format("the meshes are {} apart at rest, and their spheres, rounded as files hold them, {}: "
                        "expected coordinates nearer to the origin, or a rest pose with more clearance",
                        lengthText(spheres.clearanceAtRest, options.metersPerUnit),
                        lengthText(least, options.metersPerUnit)));
}

void noteRest(const PairSpheres& spheres, const RuleAtRest& ruled, const Motion& motion,
              const BakeOptions& options, std::vector<std::string>& notes) {
    if (ruled.bySpheres)
        notes.push_back("spheres overlap where the meshes do at rest, and these spheres stand for no known "
                        "part of the surface: what contact is missed by leaving them out is not known");
    if (options.spheres == SphereMethod::Medial || !(spheres.clearanceAtRest > 0)) return;
    const std::vector<double> rest = restValues(motion);
    const SphereTree a(spheres.a.spheres), b(spheres.b.spheres);
    if (smallestGap(a, b, pose(motion, rest), 1) > options.epsilon) return;
    notes.push_back(fmt::format("the meshes are {} apart at rest, these spheres are not: contact there; "
                                "--spheres medial makes them apart, others may with a --tolerance below {}",
                                lengthText(spheres.clearanceAtRest, options.metersPerUnit),
                                lengthText(spheres.clearanceAtRest / 2, options.metersPerUnit)));
}

} // namespace tss
