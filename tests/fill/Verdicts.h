#pragma once
#include "bake/fill/ContactZoneFit.h"
#include "bake/search/NodePairs.h"
#include "bake/spheres/RoundToFloat.h"
#include "tests/GroundTruth.h"
#include "tests/Joints.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

/// Sphere sets against the meshes themselves.
namespace zone {

using joints::turn;

constexpr double degree = std::numbers::pi / 180;

struct Scene {
    tss::TriangleMesh a, b;
    tss::Motion motion;
};

struct Verdicts {
    int touching = 0, missed = 0, early = 0;
    double worst = 0; ///< largest distance of the meshes at which the spheres touch
};

inline Verdicts verdicts(const GroundTruth& truth, const tss::ContactZoneFit& fit, const tss::Motion& motion,
                         const std::vector<std::vector<double>>& poses) {
    // As a scene file keeps them.
    const tss::SphereTree a(tss::roundToFloat(fit.a.fit.spheres)), b(tss::roundToFloat(fit.b.fit.spheres));
    Verdicts v;
    for (const std::vector<double>& q : poses) {
        const tss::Pose at = pose(motion, q);
        const bool meshes = truth.touches(at), spheres = smallestGap(a, b, at, 1e-300) <= 0;
        v.touching += meshes;
        v.missed += meshes && !spheres;
        if (!meshes && spheres) {
            ++v.early;
            v.worst = std::max(v.worst, truth.distance(at));
        }
    }
    return v;
}

inline tss::ContactZoneOptions tolerance(double value) {
    tss::ContactZoneOptions options;
    options.tolerance = value;
    options.atRest = tss::AtRest::Collide;
    return options;
}

/// True contact is never missed, none is claimed farther off than twice the tolerance.
inline void checkVerdicts(const tss::TriangleMesh& a, const tss::TriangleMesh& b, const tss::Motion& motion,
                          const tss::ContactZoneFit& fit, double tolerance, std::size_t count) {
    const GroundTruth truth(a, b);
    const Verdicts random = verdicts(truth, fit, motion, tss::randomPoses(motion, count, 1));
    CHECK(random.missed == 0);
    CHECK(random.worst <= 2 * tolerance);
    const Verdicts near = verdicts(truth, fit, motion, nearContactPoses(truth, motion, count / 4, 1e-3, 2));
    CHECK(near.touching > 0);
    CHECK(near.missed == 0);
    CHECK(near.worst <= 2 * tolerance);
}

} // namespace zone
