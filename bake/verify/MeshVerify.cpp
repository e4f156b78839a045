#include "bake/verify/MeshVerify.h"

#include "bake/base/Error.h"
#include "bake/verify/Models.h"
#include "bake/verify/Nesting.h"
#include "bake/verify/StickingOut.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tss {

namespace {

using namespace verify;

/// The two bodies, a bound for all coordinates, and what rounding is granted.
struct Frame {
    VerifiedBody a, b;
    const Motion& motion;
    double size = 0, band = 0;

    Frame(const TriangleMesh& meshA, const TriangleMesh& meshB, const Motion& motion,
          std::span<const Sphere> spheresA, std::span<const Sphere> spheresB)
        : a(meshA), b(meshB), motion(motion) {
        const auto reach = [](const TriangleMesh& mesh, std::span<const Sphere> spheres) {
            double most = 0;
            for (const Vec3& v : mesh.vertices) most = std::max(most, v.norm());
            for (const Sphere& s : spheres) most = std::max(most, s.centre.norm() + s.radius);
            return most;
        };
        size = reach(meshA, spheresA) + coordinateBound(motion, reach(meshB, spheresB));
        // Of the bodies' own size, and of what a point may be off on its way through far axes.
        band = 1e-10 * (diagonal(meshA) + diagonal(meshB)) +
               16 * PoseBox(motion, limitsOf(motion), size).error();
    }
};

/// What limits are given in.
double rangeOf(const Motion& motion) {
    double range = 0;
    for (const Dof& dof : motion.dofs)
        range =
            std::max({range, dof.upper - dof.lower, 1e-3 * std::abs(dof.lower), 1e-3 * std::abs(dof.upper)});
    return range;
}

/// Some pose keeps all limits, to rounding: the rest, drawn into them, or the middle of a box of Q.
bool somePose(const Motion& motion) {
    const double range = rangeOf(motion);
    if (withinLimits(motion, clampToLimits(motion, restValues(motion)), 1e-9 * range)) return true;
    std::vector<Box> boxes{limitsOf(motion)};
    for (int looked = 0; !boxes.empty() && looked < 1'000'000; ++looked) {
        const Box box = std::move(boxes.back());
        boxes.pop_back();
        if (!meetsPlanes(motion, box)) continue;
        std::vector<double> middle;
        std::size_t widest = 0;
        for (std::size_t k = 0; k < box.lower.size(); ++k) {
            middle.push_back(box.middle(k));
            if (box.upper[k] - box.lower[k] > box.upper[widest] - box.lower[widest]) widest = k;
        }
        if (withinLimits(motion, middle, 1e-12 * range)) return true;
        if (!(box.upper[widest] - box.lower[widest] > 1e-12 * range)) continue;
        for (Box& half : box.halves(widest, middle[widest])) boxes.push_back(std::move(half));
    }
    return false;
}

/// What must be so before anything is proven.
std::string unfit(const Motion& motion) {
    try {
        checkMotion(motion);
    } catch (const InputError& error) {
        return error.message;
    }
    if (motion.dofCount() > maxDofs) return fmt::format("its motion has more than {} DOFs", maxDofs);
    if (!somePose(motion)) return "its limits leave no pose at all: nothing is proven by that";
    return {};
}

void take(MeshVerdict& verdict, MeshProofResult&& result) {
    verdict.cells += result.cells;
    verdict.work += result.work;
    if (result.proven) return;
    verdict.reason = std::move(result.reason);
    verdict.pose = std::move(result.pose);
}

/// False: what is exempt may not be.
bool takeRegion(MeshVerdict& verdict, const Frame& frame, const RestRegion& region) {
    RegionVerdict judged = judgeRegion(frame.a, frame.b, frame.motion, region);
    verdict.reason = std::move(judged.reason);
    verdict.farthestExempt = judged.farthest;
    return verdict.holds();
}

/// Shows that wherever a test fires the two surfaces are at most as far apart as the table states: how far
/// the spheres of each test stick out of their bodies bounds how far apart the bodies are, and Nesting.h
/// shows that then neither is inside the other with the surfaces apart.
void proveEarly(MeshVerdict& verdict, const Frame& frame, const StickingOut& outA, const StickingOut& outB,
                const std::vector<MeshTest>& tests, double stated, const Progress& progress) {
    const double granted = (stated + frame.band) * (1 + 1e-6);
    verdict.earlyBound = mostTogether(tests, outA.surface, outB.surface);
    verdict.early = *verdict.earlyBound <= granted;
    if (verdict.early) return;
    verdict.fillings = (frame.a.solid && frame.a.solid->open()) || (frame.b.solid && frame.b.solid->open());
    verdict.earlyBound = mostTogether(tests, outA.body, outB.body);
    if (!(*verdict.earlyBound <= granted)) {
        verdict.reason = "its spheres stick out by more than the stored bound on early reports";
        return;
    }
    NestingResult nesting =
        proveNoNesting(frame.a, frame.b, frame.motion, frame.size, tests, granted, progress);
    verdict.cells += nesting.cells;
    verdict.early = nesting.reason.empty();
    verdict.reason = std::move(nesting.reason);
    verdict.pose = std::move(nesting.pose);
}

void proveMiss(MeshVerdict& verdict, const Frame& frame, const RestRegion& region, const MeshClaim& claim,
               const Progress& progress) {
    const SurfaceTree treeA(frame.a.mesh, region.a), treeB(frame.b.mesh, region.b);
    MeshProofResult result = proveMeshClaim(treeA, treeB, frame.motion, frame.size, claim, progress);
    verdict.miss = result.proven;
    take(verdict, std::move(result));
}

} // namespace

MeshVerdict verifyOnMeshes(const TriangleMesh& meshA, const TriangleMesh& meshB, const Table& table,
                           const Motion& motion, std::uint64_t work, const Progress& progress) {
    MeshVerdict verdict;
    verdict.reason = unfit(motion);
    if (verdict.reason.empty()) verdict.reason = motionMismatch(table.motion, motion);
    if (!verdict.reason.empty()) return verdict;
    const Frame frame(meshA, meshB, motion, table.a, table.b);
    verdict.band = frame.band;
    verdict.exempt = exemptShare(meshA, meshB, table.restRegion);
    MeshClaim claim;
    claim.tests = meshTests(table);
    claim.miss = table.boundMiss.value_or(0);
    claim.band = frame.band;
    claim.work = work;
    // First what is soon said.
    if (!takeRegion(verdict, frame, table.restRegion)) return verdict;
    const StickingOut outA = stickingOut(frame.a, table.a), outB = stickingOut(frame.b, table.b);
    verdict.reason = contradiction(table, outA, outB, frame.band);
    if (!verdict.holds()) return verdict;
    if (table.boundEarly) proveEarly(verdict, frame, outA, outB, claim.tests, *table.boundEarly, progress);
    if (verdict.holds() && table.boundMiss) proveMiss(verdict, frame, table.restRegion, claim, progress);
    return verdict;
}

MeshVerdict verifyOnMeshes(const TriangleMesh& meshA, const TriangleMesh& meshB, const NeverCollides& proof,
                           const Motion& motion, std::uint64_t work, const Progress& progress) {
    MeshVerdict verdict;
    verdict.reason = unfit(motion);
    if (verdict.holds() && !withinLimits(motion, restValues(motion), 1e-9 * rangeOf(motion)))
        verdict.reason = "its rest is beyond its limits, where nothing is proven";
    if (!verdict.holds()) return verdict;
    const Frame frame(meshA, meshB, motion, {}, {});
    verdict.band = frame.band;
    verdict.exempt = exemptShare(meshA, meshB, proof.restRegion);
    if (!(proof.clearance > frame.band)) {
        verdict.reason = "it states no positive clearance of the meshes";
        return verdict;
    }
    if (!takeRegion(verdict, frame, proof.restRegion)) return verdict;
    MeshClaim claim;
    claim.near = proof.clearance * (1 - 1e-9) - frame.band;
    claim.band = frame.band;
    claim.work = work;
    if (apartAcrossAxis(meshA, meshB, motion, proof.clearance)) {
        verdict.cells = 1;
        verdict.miss = true;
        return verdict;
    }
    proveMiss(verdict, frame, proof.restRegion, claim, progress);
    return verdict;
}

} // namespace tss
