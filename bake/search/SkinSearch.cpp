#include "bake/search/SkinSearch.h"

#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/geometry/TriangleDistance.h"
#include "bake/motion/PoseBlend.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tss {
namespace {

using Box = Eigen::AlignedBox3d;

/// The moving spheres of one muscle, and the skin carried by it.
struct MuscleSweep {
    MuscleTrack spheres;
    std::vector<double> radii;  ///< #nodes blocks of #spheres
    std::vector<double> shares; ///< #spheres: of the motion of the insertion's bone
    Eigen::Vector4d side;       ///< Muscle::side
    MuscleTrack skin;           ///< where it carries each skin vertex; no points when skin is sought at rest
};

MuscleSweep makeSweep(const SkinSearchMuscle& muscle, const TriangleMesh& skin, SkinPath path) {
    const Muscle& m = muscle.deformer->muscle();
    const std::vector<double> nodes = activationNodes(m.activationLower, m.activationUpper);
    std::vector<MusclePoint> points;
    for (const Sphere& s : muscle.spheres) points.push_back(muscle.deformer->bind(s.centre));
    MuscleSweep sweep{makeTrack(*muscle.deformer, points, nodes), {}, {}, m.side, {}};
    for (const Sphere& s : muscle.spheres) sweep.shares.push_back(muscle.deformer->insertionShare(s.centre));
    for (std::size_t i = 0; i < sweep.spheres.thicknesses.size(); ++i)
        sweep.radii.push_back(sweep.spheres.thicknesses[i] * muscle.spheres[i % points.size()].radius);
    points.clear();
    if (path == SkinPath::Carried)
        for (const Vec3& v : skin.vertices) points.push_back(muscle.deformer->bind(v));
    sweep.skin = makeTrack(*muscle.deformer, points, nodes);
    return sweep;
}

/// Two boxes are farther apart than that, by more than rounding.
bool apart(const Box& a, const Box& b, double distance) {
    return a.squaredExteriorDistance(b) > (1 + 1e-9) * distance * distance;
}

/// Some activation brings muscle sphere j within `near` (radius of the skin sphere + travel) of the path of
/// skin vertex v. The path at an activation is the segment from its rest place to where it is carried; over a
/// stretch of activations the moving end is boxed in by the segment's own motion. swept: what the sphere
/// sweeps; path: what the vertex does.
bool reaches(const MuscleSweep& sweep, std::size_t j, const Box& swept, const Vec3& rest, std::size_t v,
             const Box& path, double near) {
    if (apart(swept, path, near + path.diagonal().norm())) return false;
    const std::size_t nodes = sweep.spheres.nodes.size(), stride = sweep.spheres.points;
    const bool carried = sweep.skin.points > 0;
    for (std::size_t n = 0; n < nodes; ++n) {
        const std::size_t m = std::min(n + 1, nodes - 1);
        const Vec3 &a = sweep.spheres.positions[n * stride + j], &b = sweep.spheres.positions[m * stride + j];
        double distance = near + std::max(sweep.radii[n * stride + j], sweep.radii[m * stride + j]);
        double squared = 0;
        if (carried) {
            const Vec3& from = sweep.skin.positions[n * sweep.skin.points + v];
            const Vec3& to = sweep.skin.positions[m * sweep.skin.points + v];
            // Over the stretch the path's end moves by |to - from|: it stays that near to the first path.
            distance += (to - from).norm();
            squared = squaredDistanceOfSegments(a, b, rest, from);
        } else {
            squared = (rest - closestOnSegment(rest, a, b)).squaredNorm();
        }
        if (squared <= distance * distance) return true;
    }
    return false;
}

int insertionOf(const SkinSearchOptions& options, std::size_t m) {
    return options.insertions.empty() ? -1 : options.insertions[m];
}

/// Where a skin vertex is, seen from the bone of muscle m, at each station of each swing; rest where it does
/// not move against it. share: between two bones, from what the muscle moves with there, round its side.
using SwungPaths = std::vector<std::vector<Vec3>>;

SwungPaths swungPaths(const SkinSearchOptions& options, std::size_t m, double share,
                      const Eigen::Vector4d& side, const Vec3& x, std::size_t v) {
    SwungPaths paths;
    for (const BoneSwing& swing : options.swings) {
        std::vector<Vec3> path{x};
        bool moves = false;
        for (const std::vector<Pose>& station : swing) {
            PoseBlend blend;
            bool carried = false;
            for (std::size_t k = 0; k < options.shares.size(); ++k)
                if (options.shares[k][v] > 0 && station[k].matrix() != Pose::Identity().matrix()) {
                    blend.add(options.shares[k][v], DualPose(station[k]));
                    carried = true;
                }
            const Vec3 y = carried ? blend.pose() * x : x;
            const Pose& origin = station[m];
            const int insertion = insertionOf(options, m);
            const Pose own = insertion < 0 ? origin : blendBetween(origin, station[insertion], share, side);
            path.push_back(own.inverse() * y);
            moves = moves || path.back() != x;
        }
        if (moves) paths.push_back(std::move(path));
    }
    return paths;
}

constexpr double stepSlack = 0.1; ///< of a step between stations: how far the true path may leave the chord

/// Between two bones paths are seen from so many places along the muscle, each for the spheres next to it.
constexpr int spanStops = 9;

int stopOf(double share) {
    return static_cast<int>(std::lround(share * (spanStops - 1)));
}

/// How far a vertex may be elsewhere, seen from half way to the next stop.
double betweenStops(const SkinSearchOptions& options, std::size_t m, int stop, const Eigen::Vector4d& way,
                    const Vec3& x, std::size_t v, const SwungPaths& paths) {
    if (insertionOf(options, m) < 0 || paths.empty()) return 0;
    const double side = stop + 1 < spanStops ? 0.5 : -0.5;
    const SwungPaths beside = swungPaths(options, m, (stop + side) / (spanStops - 1), way, x, v);
    double most = 0;
    for (std::size_t k = 0; k < std::min(paths.size(), beside.size()); ++k)
        for (std::size_t s = 0; s < paths[k].size(); ++s)
            most = std::max(most, (paths[k][s] - beside[k][s]).norm());
    return (1 + stepSlack) * most;
}

/// The same while the bones swing. carried: how far muscle j's own contraction may carry the vertex
/// meanwhile.
bool reachesSwung(const MuscleSweep& sweep, std::size_t j, const Box& swept, const SwungPaths& paths,
                  double near, double carried) {
    const std::size_t nodes = sweep.spheres.nodes.size(), stride = sweep.spheres.points;
    for (const std::vector<Vec3>& path : paths)
        for (std::size_t s = 0; s + 1 < path.size(); ++s) {
            const double room = near + carried + stepSlack * (path[s + 1] - path[s]).norm();
            if (apart(swept, Box(path[s]).extend(path[s + 1]), room)) continue;
            for (std::size_t n = 0; n < nodes; ++n) {
                const std::size_t m = std::min(n + 1, nodes - 1);
                const double distance =
                    room + std::max(sweep.radii[n * stride + j], sweep.radii[m * stride + j]);
                if (squaredDistanceOfSegments(sweep.spheres.positions[n * stride + j],
                                              sweep.spheres.positions[m * stride + j], path[s],
                                              path[s + 1]) <= distance * distance)
                    return true;
            }
        }
    return false;
}

/// Everything that a muscle sphere sweeps.
Box sweptBox(const MuscleSweep& sweep, std::size_t j) {
    Box box;
    for (std::size_t n = 0; n < sweep.spheres.nodes.size(); ++n) {
        const std::size_t at = n * sweep.spheres.points + j;
        const Vec3 r = Vec3::Constant(sweep.radii[at]);
        box.extend(sweep.spheres.positions[at] - r);
        box.extend(sweep.spheres.positions[at] + r);
    }
    return box;
}

/// What the path of a skin vertex sweeps.
Box pathBox(const MuscleSweep& sweep, const Vec3& rest, std::size_t v) {
    Box box(rest);
    for (std::size_t n = 0; n < sweep.spheres.nodes.size() && sweep.skin.points > 0; ++n)
        box.extend(sweep.skin.positions[n * sweep.skin.points + v]);
    return box;
}

std::vector<SpherePair> pairsOfMuscle(const MuscleSweep& sweep, const SphereSet& spheres,
                                      const TriangleMesh& skin, const std::vector<double>& radii,
                                      const SkinSearchOptions& options, std::size_t muscle, int stop) {
    const std::span<const double> stray =
        options.stray.empty() ? std::span<const double>() : std::span<const double>(options.stray[muscle]);
    const auto near = [&](std::uint32_t v) {
        return radii[v] + options.travel + (stray.empty() ? 0 : stray[v]);
    };
    // Skin boxes in rising order of their lower x, so that a sphere looks only at a window of them.
    std::vector<Box> paths(skin.vertices.size()), boxes(skin.vertices.size());
    std::vector<SwungPaths> swung(skin.vertices.size());
    std::vector<double> carried(skin.vertices.size(), 0);
    double widest = 0;
    for (std::size_t v = 0; v < boxes.size(); ++v) {
        boxes[v] = paths[v] = pathBox(sweep, skin.vertices[v], v);
        carried[v] =
            std::max((boxes[v].max() - skin.vertices[v]).norm(), (boxes[v].min() - skin.vertices[v]).norm());
        swung[v] = swungPaths(options, muscle, static_cast<double>(stop) / (spanStops - 1), sweep.side,
                              skin.vertices[v], v);
        carried[v] += betweenStops(options, muscle, stop, sweep.side, skin.vertices[v], v, swung[v]);
        double slack = 0;
        for (const std::vector<Vec3>& path : swung[v])
            for (std::size_t s = 0; s + 1 < path.size(); ++s) {
                boxes[v].extend(path[s + 1]);
                slack = std::max(slack, carried[v] + stepSlack * (path[s + 1] - path[s]).norm());
            }
        const Vec3 grow = Vec3::Constant(near(static_cast<std::uint32_t>(v)) + slack);
        boxes[v].min() -= grow;
        boxes[v].max() += grow;
        widest = std::max(widest, boxes[v].sizes()[0]);
    }
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t l, std::uint32_t r) {
        return std::pair(boxes[l].min()[0], l) < std::pair(boxes[r].min()[0], r);
    });

    std::vector<std::vector<SpherePair>> found(spheres.size());
    parallelFor(spheres.size(), [&](std::size_t j) {
        if (insertionOf(options, muscle) >= 0 && stopOf(sweep.shares[j]) != stop) return;
        const Box swept = sweptBox(sweep, j);
        auto it = std::lower_bound(order.begin(), order.end(), swept.min()[0] - widest,
                                   [&](std::uint32_t v, double x) { return boxes[v].min()[0] < x; });
        for (; it != order.end() && boxes[*it].min()[0] <= swept.max()[0]; ++it) {
            const std::uint32_t v = *it;
            if (!boxes[v].intersects(swept)) continue;
            if (reaches(sweep, j, swept, skin.vertices[v], v, paths[v], near(v)) ||
                reachesSwung(sweep, j, swept, swung[v], near(v), carried[v]))
                found[j].push_back({v, static_cast<std::uint32_t>(j)});
        }
    });
    std::vector<SpherePair> pairs;
    for (const auto& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
    return pairs;
}

} // namespace

double skinThickness(const TriangleMesh& skin) {
    double sum = 0;
    for (const Tri& t : skin.triangles)
        for (int k = 0; k < 3; ++k) sum += (skin.vertices[t[k]] - skin.vertices[t[(k + 1) % 3]]).norm();
    return skin.triangles.empty() ? 0 : sum / (6.0 * static_cast<double>(skin.triangles.size()));
}

namespace {

void checkOptions(const TriangleMesh& skin, const std::vector<SkinSearchMuscle>& muscles,
                  const SkinSearchOptions& options) {
    if (!(options.travel >= 0) || !std::isfinite(options.travel))
        throw InputError("the travel of a skin must be a finite length of at least 0");
    if (!(options.thickness >= 0) || !std::isfinite(options.thickness))
        throw InputError("the thickness of a skin must be a finite length of at least 0");
    for (const auto* lists : {&options.stray, &options.shares}) {
        if (!lists->empty() && lists->size() != muscles.size())
            throw InputError("stray and shares of a skin need one list a muscle");
        for (const std::vector<double>& list : *lists)
            if (list.size() != skin.vertices.size())
                throw InputError("stray and shares of a skin need one value a vertex");
    }
    if (!options.insertions.empty() && options.insertions.size() != muscles.size())
        throw InputError("the search under a skin needs one insertion a muscle");
    for (const BoneSwing& swing : options.swings)
        for (const std::vector<Pose>& station : swing)
            if (station.size() != muscles.size())
                throw InputError("the swings of the bones under a skin need one pose a muscle");
}

/// The negative gaps of pairs that overlap at rest.
std::vector<double> gapsAtRest(const SphereSet& skin, const SphereSet& muscles,
                               const std::vector<SpherePair>& pairs) {
    std::vector<double> gaps;
    for (const SpherePair& p : pairs) {
        const Sphere &a = skin[p.a], &b = muscles[p.b];
        gaps.push_back(std::min(0.0, (a.centre - b.centre).norm() - a.radius - b.radius));
    }
    return gaps;
}

} // namespace

SkinTable searchSkin(const TriangleMesh& skin, const std::vector<SkinSearchMuscle>& muscles,
                     const SkinSearchOptions& options, const Progress& progress) {
    checkOptions(skin, muscles, options);
    const double thickness = options.thickness > 0 ? options.thickness : skinThickness(skin);
    const std::vector<double> radii(skin.vertices.size(), thickness);

    SphereSet skinSpheres, muscleSpheres;
    for (const Vec3& v : skin.vertices) skinSpheres.push_back({v, thickness});
    std::vector<std::uint32_t> muscleOf;
    std::vector<SpherePair> pairs;
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        if (!report(progress, "skin", static_cast<double>(m) / static_cast<double>(muscles.size())))
            throw InputError("stopped before the table was complete");
        const MuscleSweep sweep = makeSweep(muscles[m], skin, options.path);
        const auto first = static_cast<std::uint32_t>(muscleSpheres.size());
        for (int stop = 0; stop < (insertionOf(options, m) < 0 ? 1 : spanStops); ++stop)
            for (SpherePair p : pairsOfMuscle(sweep, muscles[m].spheres, skin, radii, options, m, stop))
                pairs.push_back({p.a, p.b + first});
        muscleSpheres.insert(muscleSpheres.end(), muscles[m].spheres.begin(), muscles[m].spheres.end());
        muscleOf.resize(muscleSpheres.size(), static_cast<std::uint32_t>(m));
    }
    std::sort(pairs.begin(), pairs.end());

    SkinTable result;
    std::vector<std::uint32_t> usedB;
    result.table = makeTable(skinSpheres, muscleSpheres, pairs, gapsAtRest(skinSpheres, muscleSpheres, pairs),
                             Motion{}, &result.skinVertices, &usedB);
    // Bones and muscles that move at once may bring together what no one of them does: nothing is proven.
    result.table.certified = false;
    result.table.method =
        options.path == SkinPath::AtRest ? "skin/explored/at-rest" : "skin/explored/carried";
    for (const std::uint32_t b : usedB) result.muscleOf.push_back(muscleOf[b]);
    result.travel = options.travel;

    result.table.record.spheresA = skinSpheres.size();
    result.table.record.spheresB = muscleSpheres.size();
    result.table.record.candidatePairs = pairs.size();
    return result;
}

} // namespace tss
