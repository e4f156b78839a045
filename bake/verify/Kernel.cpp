#include "bake/verify/Kernel.h"

#include "bake/base/Parallel.h"
#include "bake/verify/KernelProofs.h"
#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace tss {

using namespace verify;

namespace {

/// How far a kernel's gap may be off at this gap. error: of the squared distance; u: one roundoff.
double gapError(double u, double error, double contactDistance, double gap) {
    const double distance = std::max(0.0, contactDistance + gap), squared = distance * distance;
    // The square is rounded once more and the square root once; the contact distance and the difference once
    // each.
    const double whole = error + u * (squared + error);
    const double near = std::sqrt(std::max(0.0, squared - whole)), far = std::sqrt(squared + whole);
    return std::max(distance - near, far - distance) +
           u * (2 * far + 2 * std::abs(contactDistance) + std::abs(gap) + distance);
}

/// The table's gap in extended precision. Which tests that depends on is seen in doubles.
Real gapAt(const ExactPose& at, const std::vector<Exact>& tests, double rounding) {
    const Eigen::Matrix3d turn = at.turn.cast<double>();
    const Vec3 shift = at.shift.cast<double>();
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t k = 0; k < tests.size(); ++k) {
        const double gap = (turn * tests[k].b + shift - tests[k].a).norm() - tests[k].contactDistance;
        if (gap > least + rounding) continue;
        near.emplace_back(gap, k);
        least = std::min(least, gap);
    }
    Real gap = std::numeric_limits<Real>::infinity();
    for (const auto& [about, k] : near)
        if (about <= least + rounding)
            gap = std::min(gap, (at.at(tests[k].b) - tests[k].a.cast<Real>()).norm() -
                                    Real(tests[k].contactDistance));
    return gap;
}

/// How far the gap was off at the worst of some poses; the reason where an answer is wrong.
double tried(const Table& table, const PreparedTable& prepared, const TriedPoses& poses,
             const std::optional<DirectPose>& direct, std::string& reason) {
    double worst = 0;
    for (std::size_t n = 0; n < poses.values.size() && reason.empty(); ++n) {
        const std::vector<double>& q = poses.values[n];
        TableFeatures f;
        prepared.features(q.data(), f);
        if (direct && !direct->agreesAt(prepared, exactPose(table.motion, {q.begin(), q.end()}), f))
            reason = "at a pose the kernel's rotation or translation is another than the motion's";
        const double own = double(poses.gaps[n]), answer = prepared.gap(f).gap;
        if ((own <= 0 && !prepared.hit(f)) || (own > prepared.signBand() && prepared.hit(f)))
            reason =
                fmt::format("at a pose the gap is {:.6g} scene units and the kernel's verdict is wrong", own);
        if (own > prepared.kernels().margin() || own < -prepared.kernels().depth()) continue;
        worst = std::max(worst, std::abs(answer - own));
    }
    return worst;
}

/// Bounds what each test's rounding may do; `verdict` receives by how much it may report early and how far
/// its gap may be off. Returns what is wrong; empty: the rounding is within the kernel's bands.
std::string refuteRounding(const PreparedTable& prepared, const std::vector<Exact>& tests,
                           const std::optional<FeatureFormErrors>& fold,
                           const std::optional<DirectPose>& direct, KernelVerdict& verdict) {
    const StoredTests stored(prepared);
    if (!stored.eachOnce()) return "its blocks do not hold every test once";
    if (direct && !direct->agrees())
        return "the kernel's rotation or translation is another than the motion's";
    const double u = prepared.precision() == KernelPrecision::Float ? 0x1p-24 : 0x1p-53;
    for (std::size_t p = 0; p < tests.size(); ++p) {
        const Exact& test = tests[p];
        const PairErrors errors = fold ? fold->of(p, test)
                                       : directErrors(prepared, stored[p], test,
                                                      prepared.kernels().farthestT(), direct->rounding());
        // d^2 - c |c| <= -low means d <= sqrt(c |c| - low). A test with c < 0 never says contact, unless by
        // that.
        const double c = test.contactDistance, most = c * std::abs(c) - std::min(0.0, errors.sign.low);
        if (c >= 0 || most > 0) verdict.early = std::max(verdict.early, std::sqrt(most) - c);
        for (double gap : {-prepared.kernels().depth(), 0.0, prepared.kernels().margin()})
            verdict.gapOff = std::max(verdict.gapOff, gapError(u, errors.square, test.contactDistance, gap));
        if (errors.sign.high > 0 && test.contactDistance >= 0)
            return fmt::format(
                "test {} may miss a touch: its squared distance may be {:.3g} scene units squared too large",
                p, errors.sign.high);
    }
    if (verdict.early > prepared.signBand() * (1 + 1e-6))
        return fmt::format(
            "it may report contact {:.3g} scene units before the table does, more than its band of {:.3g}",
            verdict.early, prepared.signBand());
    return {};
}

/// The same of what is left out without asking a test, and of the answers at some poses.
std::string refuteAnswers(const Table& table, const PreparedTable& prepared, const TriedPoses& poses,
                          const std::vector<Exact>& tests, const std::optional<DirectPose>& direct,
                          KernelVerdict& verdict) {
    std::string reason;
    verdict.seen = tried(table, prepared, poses, direct, reason);
    if (!reason.empty()) return reason;
    if (verdict.seen > verdict.gapOff)
        return fmt::format("its gap was off by {:.3g} scene units at a pose, more than {:.3g}", verdict.seen,
                           verdict.gapOff);
    if (reason = refuteCells(table, prepared); !reason.empty()) return reason;
    if (direct) reason = refuteClusters(prepared, tests, direct->rounding());
    return reason.empty() ? refuteVerdicts(table, prepared) : reason;
}

} // namespace

TriedPoses posesToTry(const Table& table) {
    const std::vector<Exact> tests = exactTests(table);
    TriedPoses poses{spreadOverLimits(table.motion, 500), std::vector<Real>(500)};
    const double rounding = 1e-12 * pathSize(table.motion, tests);
    parallelFor(poses.gaps.size(), [&](std::size_t n) {
        const std::vector<double>& q = poses.values[n];
        poses.gaps[n] = gapAt(exactPose(table.motion, {q.begin(), q.end()}), tests, rounding);
    });
    return poses;
}

KernelVerdict verifyKernel(const Table& table, const PreparedTable& prepared, const TriedPoses& poses) {
    KernelVerdict verdict;
    const std::vector<Exact> tests = exactTests(table);
    if (tests.size() != prepared.testCount()) {
        verdict.reason = "the kernel has another number of tests than the table";
        return verdict;
    }
    if (tests.empty()) {
        verdict.proven = true;
        return verdict;
    }
    std::optional<FeatureFormErrors> fold;
    std::optional<DirectPose> direct;
    if (prepared.form() == KernelForm::Fold)
        fold.emplace(table, prepared, tests);
    else
        direct.emplace(table, prepared, tests);
    verdict.reason = refuteRounding(prepared, tests, fold, direct, verdict);
    verdict.gapOff += turnRounding(table.motion, pathSize(table.motion, tests), 0x1p-53);
    if (verdict.reason.empty())
        verdict.reason = refuteAnswers(table, prepared, poses, tests, direct, verdict);
    verdict.proven = verdict.reason.empty();
    return verdict;
}

} // namespace tss
