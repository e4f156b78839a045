#pragma once
#include "bake/compare/MeshTruth.h"
#include "bake/compare/Methods.h"
#include "bake/spheres/GenerateSpheres.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

/// A mesh as a whole problem needs it: both sphere sets conservative with a proven protrusion, the table all
/// pairs that can meet at some of many poses and hence all that the tests below can ask for.
inline tss::compare::ComparedPair makeProblem(tss::TriangleMesh a, tss::TriangleMesh b, tss::Motion motion,
                                              double tolerance) {
    tss::compare::ComparedPair problem{std::move(a), std::move(b), std::move(motion), {}, {}, {}, {}, {}};
    tss::SphereOptions options;
    options.tolerance = tolerance;
    const tss::SphereFit fitA = fitSpheres(problem.meshA, options), fitB = fitSpheres(problem.meshB, options);
    problem.a = fitA.spheres;
    problem.b = fitB.spheres;
    problem.fitA.coverage = fitA.coverage;
    problem.fitA.protrusion = fitA.protrusion;
    problem.fitB.coverage = fitB.coverage;
    problem.fitB.protrusion = fitB.protrusion;
    std::vector<tss::SpherePair> all;
    for (std::uint32_t i = 0; i < problem.a.size(); ++i)
        for (std::uint32_t j = 0; j < problem.b.size(); ++j) all.push_back({i, j});
    problem.table = makeTable(problem.a, problem.b, all, {}, problem.motion);
    problem.table.certified = true; // it is the whole model
    const auto stated = tss::compare::statedBySpheres(problem);
    problem.table.boundMiss = stated.miss;
    problem.table.boundEarly = stated.early;
    return problem;
}

inline tss::Motion makeMotion(std::vector<tss::Dof> dofs) {
    tss::Motion motion;
    motion.dofs = std::move(dofs);
    return motion;
}

/// A lid with a knob that turns and slides over a box with a ball on it.
inline tss::compare::ComparedPair lidOverBall(double tolerance = 0.05) {
    using tss::Vec3;
    const auto together = [](tss::TriangleMesh a, const tss::TriangleMesh& b) {
        const int shift = static_cast<int>(a.vertices.size());
        a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
        for (const tss::Tri& t : b.triangles) a.triangles.push_back(t + tss::Tri::Constant(shift));
        return a;
    };
    const tss::TriangleMesh base =
        together(boxMesh({0, -1, -0.4}, {3, 1, 0}), ballMesh({2.5, 0.3, 0.25}, 0.35, 2));
    const tss::TriangleMesh lid =
        together(boxMesh({0.2, -0.9, 0.5}, {3, 0.9, 0.8}), ballMesh({1.5, -0.2, 0.45}, 0.3, 2));
    return makeProblem(base, lid,
                       makeMotion({joints::turn({0, 0, 0.3}, Vec3::UnitY(), -0.35, 0.25),
                                   joints::slide(Vec3::UnitY(), -0.3, 0.3)}),
                       tolerance);
}

inline tss::compare::ComparedPair lidHinged(double tolerance = 0.05) {
    tss::compare::ComparedPair problem = lidOverBall(tolerance);
    problem.motion.dofs.pop_back();
    problem.table.motion = problem.motion;
    return problem;
}
