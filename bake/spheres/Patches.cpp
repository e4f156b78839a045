#include "bake/spheres/Patches.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/spheres/MedialBall.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

namespace tss {

double Patch::radius() const {
    const Vec3 c = centre();
    return std::sqrt(std::max(
        {(corners[0] - c).squaredNorm(), (corners[1] - c).squaredNorm(), (corners[2] - c).squaredNorm()}));
}

double Patch::area() const {
    return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
}

std::array<Patch, 2> halves(const Patch& patch) {
    const std::array<Corners, 2> both = halves(patch.corners);
    return {Patch{both[0], patch.normal, patch.region}, Patch{both[1], patch.normal, patch.region}};
}

namespace {

Vec3 normalOf(const Vec3& a, const Vec3& b, const Vec3& c) {
    if (!hasZeroArea(a, b, c)) return (b - a).cross(c - a).stableNormalized();
    const Vec3 ab = b - a, ac = c - a, along = ab.squaredNorm() > ac.squaredNorm() ? ab : ac;
    const double length = along.stableNorm();
    return length > 0 ? Vec3(Vec3(along / length).unitOrthogonal()) : Vec3::UnitX();
}

} // namespace

std::vector<Patch> patchesOf(const TriangleMesh& mesh) {
    std::vector<Patch> patches;
    patches.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
        patches.push_back({{a, b, c}, normalOf(a, b, c)});
    }
    return patches;
}

Bvh treeOfCentres(std::span<const Patch> patches) {
    std::vector<Eigen::AlignedBox3d> centres;
    centres.reserve(patches.size());
    for (const Patch& patch : patches) centres.emplace_back(patch.centre());
    return buildBvh(centres, 8);
}

bool covers(const Sphere& sphere, const Patch& patch) {
    const double r = sphere.radius * (1 - 1e-12), r2 = r * r;
    return (patch.corners[0] - sphere.centre).squaredNorm() <= r2 &&
           (patch.corners[1] - sphere.centre).squaredNorm() <= r2 &&
           (patch.corners[2] - sphere.centre).squaredNorm() <= r2;
}

namespace {

/// An estimate of how many patches splitting will make, from random descents.
struct PatchEstimate {
    double mean = 0;
    double lower = 0; ///< hardly fewer: three standard errors below the trimmed mean
    double leastProtrusion = std::numeric_limits<double>::infinity(); ///< of the spheres seen, scene units
};

/// Finds the sphere of a patch, or that the patch must be split.
class Fitter {
public:
    Fitter(const Solid& solid, const PatchOptions& options) : solid_(solid), options_(options) {}

    /// The ball of a patch, where it covers the patch and the patch is small enough beside it; else nothing.
    /// expected: the radius of the balls about the patch that it was halved from, or 0; updated where nothing
    /// is returned.
    std::optional<MedialBall> fit(const Patch& patch, double& expected) {
        const double radius = patch.radius();
        // Far larger than the balls there allow: split without trying a ball.
        if (expected > 0 && radius > 1.5 * largestPatch(expected, options_.protrusion)) return {};
        const MedialBall ball =
            medialBall(solid_, patch.centre(), patch.normal, options_.protrusion, options_.slackFactor,
                       expected > 0 ? 1.1 * expected : 4 * radius, known_, options_.neighbour);
        leastProtrusion_ = std::min(leastProtrusion_, ball.protrusion());
        if (radius <= largestPatch(ball.sphere.radius, ball.protrusion()) && covers(ball.sphere, patch))
            return ball;
        expected = std::max(ball.sphere.radius, ball.unconstrained);
        return {};
    }

    double leastProtrusion() const { return leastProtrusion_; }

private:
    /// The radius up to which a patch is small enough beside a ball.
    double largestPatch(double ballRadius, double protrusion) const {
        return protrusion > 0 ? options_.sizeFactor * std::sqrt(2 * ballRadius * protrusion) : 0;
    }

    const Solid& solid_;
    const PatchOptions& options_;
    double leastProtrusion_ = std::numeric_limits<double>::infinity();
    KnownInside known_;
};

// From the size of a mesh down to the rounding of its coordinates are at most about 110 halvings.
constexpr int mostDeep = 128;

/// Descends into halves chosen at random; a patch that is done at depth d counts 2^d (D. Knuth, "Estimating
/// the efficiency of backtrack programs", 1975). The mean is unbiased, however few descents there are.
PatchEstimate estimatePatches(const Solid& solid, std::span<const Patch> patches, const PatchOptions& options,
                              std::size_t descents) {
    std::vector<double> upTo; // cumulated: patches are chosen in proportion to their squared radius
    double total = 0;
    for (const Patch& patch : patches)
        upTo.push_back(total += std::max(std::pow(patch.radius(), 2), std::numeric_limits<double>::min()));
    std::mt19937_64 random(1);
    Fitter fitter(solid, options);
    std::vector<double> counts;
    for (std::size_t k = 0; k < descents; ++k) {
        const double chosen = total * (double(k) + double(random() >> 11) * 0x1p-53) / double(descents);
        const auto at = std::min<std::size_t>(
            std::upper_bound(upTo.begin(), upTo.end(), chosen) - upTo.begin(), patches.size() - 1);
        Patch patch = patches[at];
        double count = total / (upTo[at] - (at ? upTo[at - 1] : 0)), expected = 0;
        for (int depth = 0; depth < mostDeep && !fitter.fit(patch, expected); ++depth, count *= 2)
            patch = halves(patch)[random() & 1];
        counts.push_back(count);
    }
    const double n = double(descents), mean = std::accumulate(counts.begin(), counts.end(), 0.0) / n;
    // A few deep descents can dominate the mean, which is then uncertain: the lower bound counts each as no
    // more than the 15/16 quantile.
    const auto most = counts.begin() + 15 * descents / 16;
    std::nth_element(counts.begin(), most, counts.end());
    double low = 0, squares = 0;
    for (const double count : counts) {
        low += std::min(count, *most) / n;
        squares += std::pow(std::min(count, *most), 2) / n;
    }
    return {mean, low - 3 * std::sqrt(std::max(0.0, squares - low * low) / n), fitter.leastProtrusion()};
}

/// Counts the patches of all threads against the limit.
class PatchLimit {
public:
    PatchLimit(const Solid& solid, std::span<const Patch> patches, const PatchOptions& options,
               const Progress& progress)
        : solid(solid), options(options), poll(progress, "patches"), patches_(patches) {}

    /// Counts one split more. Makes the estimate once, early, so that far too many are refused soon.
    void countSplit() {
        const std::size_t early = options.mostPatches / 200, count = ++splits_;
        if (count == early + 1 && estimate().lower > double(options.mostPatches)) tooMany_ = true;
        if (tooMany_ || count > options.mostPatches) refuse();
    }

    [[noreturn]] void refuse() {
        const PatchEstimate& seen = estimate();
        const double most = double(options.mostPatches), takes = std::max(seen.mean, most);
        if (options.neighbour && seen.leastProtrusion < 0.5 * options.protrusion) {
            // Their number grows with the inverse of the clearance; a tenth of the most is made in minutes.
            const double clearance = options.neighbour->clearance;
            throw RestTooClose(
                fmt::format("the meshes are {:.4g} scene units apart at rest: spheres that are apart there "
                            "too need a tolerance of {:.2g} and take about {:.2g} patches, more than {}: "
                            "expected a clearance of at least {:.2g} there, meshes that overlap where they "
                            "are meant to, or --at-rest collide, with which there may be contact at rest",
                            clearance, std::max(seen.leastProtrusion, 0.0), takes, options.mostPatches,
                            10 * clearance * takes / most));
        }
        throw TooFine(fmt::format("a tolerance of about {:.4g} takes about {:.2g} patches, more than {}, of "
                                  "a mesh {:.4g} in size: expected a coarser one",
                                  options.protrusion, takes, options.mostPatches, solid.diagonal()));
    }

    const Solid& solid;
    const PatchOptions& options;
    Poll poll;

private:
    const PatchEstimate& estimate() {
        std::call_once(estimated_, [&] {
            const std::size_t descents = std::clamp<std::size_t>(options.mostPatches / 10'000, 64, 1024);
            estimate_ = estimatePatches(solid, patches_, options, descents);
        });
        return estimate_;
    }

    std::span<const Patch> patches_;
    std::atomic<std::size_t> splits_{0};
    std::atomic<bool> tooMany_{false};
    std::once_flag estimated_;
    PatchEstimate estimate_;
};

/// Splits one patch as far as needed.
class Splitter {
public:
    explicit Splitter(PatchLimit& limit) : limit_(limit), fitter_(limit.solid, limit.options) {}

    void add(const Patch& patch, double expected) {
        if (limit_.poll.stopped()) throw InputError("stopped before the spheres were made");
        if (const auto ball = fitter_.fit(patch, expected)) {
            result.patches.push_back(patch);
            result.candidates.push_back(ball->sphere);
            result.inner.push_back(ball->inner);
            return;
        }
        limit_.countSplit();
        if (depth_ >= mostDeep) limit_.refuse();
        ++depth_;
        for (const Patch& half : halves(patch)) add(half, expected);
        --depth_;
    }

    FittedPatches result;

private:
    PatchLimit& limit_;
    Fitter fitter_;
    int depth_ = 0;
};

void append(FittedPatches& all, const FittedPatches& more) {
    all.patches.insert(all.patches.end(), more.patches.begin(), more.patches.end());
    all.candidates.insert(all.candidates.end(), more.candidates.begin(), more.candidates.end());
    all.inner.insert(all.inner.end(), more.inner.begin(), more.inner.end());
}

/// Fits those of the patches whose numbers are given.
FittedPatches fitSome(PatchLimit& limit, std::span<const Patch> patches,
                      std::span<const std::uint32_t> numbers) {
    constexpr std::size_t block = 64;
    const std::size_t blocks = (numbers.size() + block - 1) / block;
    std::vector<FittedPatches> parts(blocks);
    parallelFor(blocks, [&](std::size_t b) {
        Splitter splitter(limit);
        for (std::size_t i = b * block; i < std::min(numbers.size(), (b + 1) * block); ++i)
            splitter.add(patches[numbers[i]], 0);
        parts[b] = std::move(splitter.result);
    });
    FittedPatches all;
    for (FittedPatches& part : parts) append(all, std::exchange(part, {}));
    return all;
}

} // namespace

FittedPatches fitPatches(const Solid& solid, std::span<const Patch> patches, const PatchOptions& options,
                         const Progress& progress) {
    PatchLimit limit(solid, patches, options, progress);
    std::vector<std::uint32_t> all = indicesOf(patches.size());
    FittedPatches fitted = fitSome(limit, patches, all);
    report(progress, "patches", 1);
    return fitted;
}

FittedPatches fitPatchesSparsely(const Solid& solid, std::span<const Patch> patches,
                                 const PatchOptions& options, const Progress& progress) {
    constexpr int enough = 16;
    PatchLimit limit(solid, patches, options, progress);
    const Bvh tree = treeOfCentres(patches);
    std::vector<int> covered(patches.size(), 0); // by so many candidates
    std::vector<char> fit(patches.size(), 0);
    FittedPatches fitted;
    const auto round = [&](std::size_t first, std::size_t step) {
        std::vector<std::uint32_t> numbers;
        for (std::size_t i = first; i < patches.size(); i += step)
            if (covered[i] < enough) numbers.push_back(std::uint32_t(i));
        for (const std::uint32_t i : numbers) fit[i] = 1;
        const FittedPatches more = fitSome(limit, patches, numbers);
        for (const Sphere& ball : more.candidates)
            visitBall(tree, ball.centre, ball.radius,
                      [&](std::uint32_t i) { covered[i] += covers(ball, patches[i]); });
        append(fitted, more);
    };
    round(0, 64); // every 64th patch, then those halfway between them, and so on
    for (std::size_t step = 64; step > 1; step /= 2) round(step / 2, step);
    // The others are covered, and have no ball of their own.
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (fit[i]) continue;
        fitted.patches.push_back(patches[i]);
        fitted.candidates.push_back({patches[i].centre(), 0});
        fitted.inner.push_back(-infinity);
    }
    report(progress, "patches", 1);
    return fitted;
}

} // namespace tss
