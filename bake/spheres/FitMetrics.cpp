#include "bake/spheres/FitMetrics.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/spheres/SphereQuery.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tss {

namespace {

/// Bounds of the largest distance from the points of a patch to the union of the spheres.
struct Bounds {
    double lower; ///< reached at the centre
    double upper;
};

Bounds boundsOf(const SphereQuery& tree, const Patch& patch) {
    const Vec3 centre = patch.centre();
    const double radius = patch.radius();
    // A sphere that holds the ball about the patch holds the patch: no need to know the nearest one.
    const SphereQuery::Nearest nearest = tree.nearest(centre, -1.001 * radius);
    const Sphere& s = tree[nearest.sphere];
    double corner2 = 0, size = 0;
    for (const Vec3& c : patch.corners) {
        corner2 = std::max(corner2, (c - s.centre).squaredNorm());
        size = std::max(size, c.cwiseAbs().maxCoeff() + s.centre.cwiseAbs().maxCoeff());
    }
    // The distance to this sphere is convex on the patch, so it is largest at a corner; and the distance to
    // the union grows by no more than the distance from the centre.
    const double upper = std::min(std::sqrt(corner2) - s.radius, nearest.gap + radius);
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * (size + s.radius);
    return {nearest.gap - rounding, upper > 0 ? upper + rounding : upper};
}

/// The bound for one patch, halved until it is within 2 % of the largest value known.
double refined(const SphereQuery& tree, const Patch& patch, double known) {
    constexpr int budget = 20000; // probes; what is left then keeps the bound it has
    const double settled = 1e-6 * patch.radius();
    std::vector<Patch> stack{patch};
    double bound = 0;
    for (int probes = 0; !stack.empty(); ++probes) {
        const Patch top = stack.back();
        stack.pop_back();
        const Bounds here = boundsOf(tree, top);
        known = std::max(known, here.lower);
        if (here.upper <= std::max(1.02 * known, 0.0) || probes >= budget || top.radius() < settled) {
            bound = std::max(bound, here.upper);
        } else {
            for (const Patch& half : halves(top)) stack.push_back(half);
        }
    }
    return bound;
}

/// Points spread evenly over the patches by area, always the same ones: the additive recurrence of the
/// plastic number within each patch.
std::vector<Vec3> samplesOf(std::span<const Patch> patches, std::size_t count) {
    double total = 0;
    for (const Patch& patch : patches) total += patch.area();
    std::vector<Vec3> samples;
    double owed = 0.5, u = 0.5, v = 0.5;
    for (const Patch& patch : patches) {
        owed += total > 0 ? patch.area() / total * static_cast<double>(count) : 0;
        while (owed >= 1) {
            owed -= 1;
            u = std::fmod(u + 0.7548776662466927, 1.0);
            v = std::fmod(v + 0.5698402909980532, 1.0);
            const double s = u + v > 1 ? 1 - u : u, t = u + v > 1 ? 1 - v : v;
            samples.push_back(patch.corners[0] + s * (patch.corners[1] - patch.corners[0]) +
                              t * (patch.corners[2] - patch.corners[0]));
        }
    }
    return samples;
}

struct Spread {
    double mean = 0, p95 = 0;
};

Spread spread(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t at = (values.size() * 95 + 99) / 100 - 1;
    return {std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()),
            values[at]};
}

void measureCoverage(FitMetrics& metrics, std::span<const Sphere> spheres, std::span<const Patch> patches) {
    metrics.coverage = coverageBound(spheres, patches);
    const SphereQuery tree(spheres);
    const std::vector<Vec3> samples = samplesOf(patches, 20000);
    std::vector<double> distances(samples.size());
    parallelFor(samples.size(),
                [&](std::size_t i) { distances[i] = std::max(0.0, tree.nearest(samples[i], 0).gap); });
    const Spread s = spread(std::move(distances));
    metrics.coverageMean = s.mean;
    metrics.coverageP95 = s.p95;
}

void measureProtrusion(FitMetrics& metrics, const Solid& solid, std::span<const Sphere> spheres) {
    std::vector<double> bounds(spheres.size());
    parallelFor(spheres.size(),
                [&](std::size_t i) { bounds[i] = solid.protrusion(spheres[i].centre, spheres[i].radius); });
    for (const double b : bounds) metrics.protrusion = std::max(metrics.protrusion, b);
    const Spread s = spread(std::move(bounds));
    metrics.protrusionMean = s.mean;
    metrics.protrusionP95 = s.p95;
}

/// Whether points of a box are inside a solid: cells of a grid that its boundary does not come into are so as
/// a whole, and are asked once.
class InsideGrid {
public:
    InsideGrid(const Solid& solid, const Eigen::AlignedBox3d& box)
        : solid_(solid), box_(box), cells_(perAxis * perAxis * perAxis) {
        const Vec3 size = box.sizes() / perAxis;
        parallelFor(cells_.size(), [&](std::size_t i) {
            const Vec3 place(double(i % perAxis), double(i / perAxis % perAxis),
                             double(i / (perAxis * perAxis)));
            const Vec3 centre = box.min() + (place.array() + 0.5).matrix().cwiseProduct(size);
            if (!solid.boundary().comesWithin(centre, 0.5 * (1 + 1e-9) * size.norm()))
                cells_[i] = solid.inside(centre) ? Cell::Inside : Cell::Outside;
        });
    }

    /// share: where in the box the point is, [0, 1) along each axis.
    bool inside(const Vec3& share) const {
        const auto at = [&](int axis) { return static_cast<std::size_t>(share[axis] * double(perAxis)); };
        const Cell cell = cells_[at(0) + perAxis * (at(1) + perAxis * at(2))];
        return cell == Cell::Boundary ? solid_.inside(box_.min() + share.cwiseProduct(box_.sizes()))
                                      : cell == Cell::Inside;
    }

private:
    enum class Cell : char { Boundary, Inside, Outside };
    static constexpr std::size_t perAxis = 16;

    const Solid& solid_;
    const Eigen::AlignedBox3d& box_;
    std::vector<Cell> cells_;
};

} // namespace

double measureVolumeRatio(const Solid& solid, std::span<const Sphere> spheres) {
    constexpr std::size_t count = 1 << 16;
    Eigen::AlignedBox3d box = bounds(solid.mesh());
    for (const Sphere& s : spheres) {
        box.extend(s.centre + Vec3::Constant(s.radius));
        box.extend(s.centre - Vec3::Constant(s.radius));
    }
    const SphereQuery tree(spheres);
    const InsideGrid body(solid, box);
    std::vector<char> inSpheres(count), inBody(count);
    parallelFor(count, [&](std::size_t i) {
        const double k = static_cast<double>(i) + 0.5;
        const Vec3 u(std::fmod(k * 0.8191725133961645, 1.0), std::fmod(k * 0.6710436067037893, 1.0),
                     std::fmod(k * 0.5497004779019703, 1.0));
        inSpheres[i] = tree.contains(box.min() + u.cwiseProduct(box.sizes()));
        inBody[i] = body.inside(u);
    });
    const double each = box.volume() / static_cast<double>(count);
    const double sphereVolume = each * static_cast<double>(std::count(inSpheres.begin(), inSpheres.end(), 1));
    const double bodyVolume = each * static_cast<double>(std::count(inBody.begin(), inBody.end(), 1));
    return bodyVolume > 0 ? sphereVolume / bodyVolume : 0;
}

double coverageBound(std::span<const Sphere> spheres, std::span<const Patch> patches) {
    if (patches.empty()) return 0;
    if (spheres.empty()) return infinity;
    const SphereQuery tree(spheres);
    std::vector<Bounds> first(patches.size());
    parallelFor(patches.size(), [&](std::size_t i) { first[i] = boundsOf(tree, patches[i]); });
    double known = 0;
    for (const Bounds& b : first) known = std::max(known, b.lower);
    std::vector<double> bounds(patches.size());
    parallelFor(patches.size(), [&](std::size_t i) {
        bounds[i] = first[i].upper <= 1.02 * known ? first[i].upper : refined(tree, patches[i], known);
    });
    double bound = 0;
    for (const double b : bounds) bound = std::max(bound, b);
    return bound;
}

FitMetrics measureFit(const Solid& solid, std::span<const Sphere> spheres, std::span<const Patch> zone) {
    FitMetrics metrics;
    if (spheres.empty()) {
        metrics.coverage = metrics.coverageMean = metrics.coverageP95 = zone.empty() ? 0 : infinity;
        return metrics;
    }
    measureCoverage(metrics, spheres, zone);
    measureProtrusion(metrics, solid, spheres);
    return metrics;
}

FitMetrics measureFit(const Solid& solid, std::span<const Sphere> spheres) {
    FitMetrics metrics = measureFit(solid, spheres, patchesOf(solid.mesh()));
    metrics.volumeRatio = measureVolumeRatio(solid, spheres);
    return metrics;
}

} // namespace tss
