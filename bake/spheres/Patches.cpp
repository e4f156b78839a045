#include "bake/spheres/Patches.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/spheres/MedialBall.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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

bool covers(const Sphere& sphere, const Patch& patch) {
    const double r = sphere.radius * (1 - 1e-12), r2 = r * r;
    return (patch.corners[0] - sphere.centre).squaredNorm() <= r2 &&
           (patch.corners[1] - sphere.centre).squaredNorm() <= r2 &&
           (patch.corners[2] - sphere.centre).squaredNorm() <= r2;
}

namespace {

/// What the threads share.
struct Shared {
    Shared(const PatchOptions& options, const Progress& progress)
        : options(options), poll(progress, "patches") {}

    const PatchOptions& options;
    Poll poll;
    std::atomic<std::size_t> splits{0};
};

/// Splits one patch as far as needed.
class Splitter {
public:
    Splitter(const Solid& solid, Shared& shared) : solid_(solid), options_(shared.options), shared_(shared) {}

    void add(const Patch& patch, double radiusExpected) {
        if (shared_.poll.stopped()) throw InputError("stopped before the spheres were made");
        const double radius = patch.radius();
        // Not worth a ball of its own while far larger than the balls about it allow.
        if (radiusExpected > 0 && radius > 1.5 * largest(radiusExpected, options_.protrusion))
            return split(patch, radiusExpected);
        const MedialBall ball =
            medialBall(solid_, patch.centre(), patch.normal, options_.protrusion, options_.slackFactor,
                       radiusExpected > 0 ? 1.1 * radiusExpected : 4 * radius, known_, options_.neighbour);
        finest_ = std::min(finest_, ball.protrusion());
        if (radius <= largest(ball.sphere.radius, ball.protrusion()) && covers(ball.sphere, patch)) {
            result.patches.push_back(patch);
            result.candidates.push_back(ball.sphere);
            result.inner.push_back(ball.inner);
        } else {
            split(patch, std::max(ball.sphere.radius, ball.free));
        }
    }

    FittedPatches result;

private:
    double largest(double ballRadius, double protrusion) const {
        return protrusion > 0 ? options_.sizeFactor * std::sqrt(2 * ballRadius * protrusion) : 0;
    }

    void split(const Patch& patch, double radiusExpected) {
        // From the size of a mesh down to the rounding of its coordinates are at most about 110 halvings.
        constexpr int mostDeep = 128;
        if (shared_.splits.fetch_add(1, std::memory_order_relaxed) >= options_.mostPatches ||
            depth_ >= mostDeep)
            refuse();
        ++depth_;
        for (const Patch& half : halves(patch)) add(half, radiusExpected);
        --depth_;
    }

    [[noreturn]] void refuse() const {
        if (options_.neighbour && finest_ < 0.5 * options_.protrusion)
            throw RestTooClose(fmt::format(
                "the meshes are {:.4g} scene units apart at rest: spheres that are apart there too may stick "
                "out by no more than {:.4g} and take more than {} patches: expected a rest pose "
                "with more clearance, or meshes that overlap where they are meant to",
                options_.neighbour->clearance, std::max(finest_, 0.0), options_.mostPatches));
        throw TooFine(
            fmt::format("a tolerance of about {:.4g} takes more than {} patches of a mesh {:.4g} in size: "
                        "expected a coarser one",
                        options_.protrusion, options_.mostPatches, solid_.diagonal()));
    }

    const Solid& solid_;
    const PatchOptions& options_;
    Shared& shared_;
    int depth_ = 0;
    double finest_ = std::numeric_limits<double>::infinity(); ///< the least that a sphere may stick out
    KnownInside known_;
};

} // namespace

FittedPatches fitPatches(const Solid& solid, std::span<const Patch> patches, const PatchOptions& options,
                         const Progress& progress) {
    constexpr std::size_t block = 64;
    const std::size_t blocks = (patches.size() + block - 1) / block;
    std::vector<FittedPatches> parts(blocks);
    Shared shared(options, progress);
    parallelFor(blocks, [&](std::size_t b) {
        Splitter splitter(solid, shared);
        for (std::size_t i = b * block; i < std::min(patches.size(), (b + 1) * block); ++i)
            splitter.add(patches[i], 0);
        parts[b] = std::move(splitter.result);
    });
    report(progress, "patches", 1);
    FittedPatches all;
    for (FittedPatches& part : parts) {
        all.patches.insert(all.patches.end(), part.patches.begin(), part.patches.end());
        all.candidates.insert(all.candidates.end(), part.candidates.begin(), part.candidates.end());
        all.inner.insert(all.inner.end(), part.inner.begin(), part.inner.end());
        part = {};
    }
    return all;
}

} // namespace tss
