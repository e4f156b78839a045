#include "bake/verify/MeshProof.h"

#include "bake/base/Parallel.h"
#include "bake/verify/Nesting.h"

#include <algorithm>

namespace tss::verify {

namespace {

/// How far each sphere sticks out of the body: of what its surface encloses, and of the surface alone.
struct StickingOut {
    std::vector<double> body, surface;
};

StickingOut stickingOut(const VerifiedBody& body, const std::vector<Sphere>& spheres) {
    StickingOut out{std::vector<double>(spheres.size()), std::vector<double>(spheres.size())};
    parallelFor(spheres.size(), [&](std::size_t i) {
        const Sphere& sphere = spheres[i];
        const double toSurface = body.surface.distance(sphere.centre);
        out.surface[i] = sphere.radius + toSurface;
        out.body[i] = out.surface[i];
        if (!body.solid) return;
        const double toBoundary = body.solid->boundary().distance(sphere.centre);
        const bool inside = toBoundary > 1e-9 * sphere.radius && body.solid->inside(sphere.centre);
        out.body[i] = inside ? std::max(0.0, sphere.radius - toBoundary)
                             : sphere.radius + std::min(toBoundary, toSurface);
    });
    return out;
}

/// The most that a test's spheres stick out together, with what it reaches beyond them.
double worst(const std::vector<MeshTest>& tests, const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (const MeshTest& t : tests) {
        // A negative threshold keeps the test silent until its spheres are as deep in each other.
        const double beyond = std::max(t.threshold, 0.0);
        most = std::max(most, a[t.sphereA] + b[t.sphereB] + beyond);
    }
    return most;
}

} // namespace

EarlyResult proveEarly(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion, double size,
                       const std::vector<Sphere>& spheresA, const std::vector<Sphere>& spheresB,
                       const std::vector<MeshTest>& tests, double claimed, const Progress& progress) {
    EarlyResult result;
    const StickingOut outA = stickingOut(a, spheresA), outB = stickingOut(b, spheresB);
    result.bound = worst(tests, outA.surface, outB.surface);
    const double granted = claimed * (1 + 1e-6);
    result.surfaces = result.bound <= granted;
    if (result.surfaces) {
        result.proven = true;
        return result;
    }
    result.bound = worst(tests, outA.body, outB.body);
    if (!(result.bound <= granted)) {
        result.reason = "its spheres stick out by more than the stored bound on early reports";
        return result;
    }
    NestingResult nesting = proveNoNesting(a, b, motion, size, tests, granted, progress);
    result.proven = nesting.reason.empty();
    result.reason = std::move(nesting.reason);
    result.pose = std::move(nesting.pose);
    result.cells = nesting.cells;
    return result;
}

} // namespace tss::verify
