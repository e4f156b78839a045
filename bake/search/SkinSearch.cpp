#include "bake/search/SkinSearch.h"

#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/geometry/Bvh.h"
#include "bake/geometry/TriangleDistance.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

using Box = Eigen::AlignedBox3d;

/// Two boxes are farther apart than that, by more than rounding.
bool apart(const Box& a, const Box& b, double distance) {
    return a.squaredExteriorDistance(b) > (1 + 1e-9) * distance * distance;
}

/// The spheres of a muscle or bone that move alike, with the muscle's own frame: all of them, or, over
/// several bones, those whose place along these is next to `share`.
struct SphereGroup {
    double share = 0;
    std::vector<std::uint32_t> spheres;
    Bvh tree; ///< over what each of them sweeps
};

/// From one bone to the next spheres are taken together that are next to one of so many places.
constexpr int spanSteps = 8;

/// The moving spheres of one muscle, and the skin that they were found to reach.
struct MuscleSweep {
    MuscleTrack spheres;
    std::vector<double> radii; ///< #nodes blocks of #spheres
    std::vector<Box> swept;    ///< #spheres: everything that each sweeps
    std::vector<SphereGroup> groups;
    std::vector<Eigen::Vector4d> sides;   ///< Muscle::sides
    std::vector<int> chain;               ///< as in SkinSearchOptions
    std::vector<double> carried;          ///< #V: how far its contraction carries a vertex, at most
    std::vector<std::vector<bool>> found; ///< #V of #spheres, or of none
};

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

std::vector<SphereGroup> groupsOf(const MuscleSweep& sweep, const SkinSearchMuscle& muscle) {
    const std::size_t steps = spanSteps * sweep.chain.size();
    std::vector<SphereGroup> groups(steps + 1);
    for (std::size_t stop = 1; stop <= steps; ++stop)
        groups[stop].share = static_cast<double>(stop) / static_cast<double>(steps);
    for (std::uint32_t j = 0; j < muscle.spheres.size(); ++j) {
        const double share = steps == 0 ? 0 : muscle.deformer->chainShare(muscle.spheres[j].centre);
        groups[static_cast<std::size_t>(std::lround(share * static_cast<double>(steps)))].spheres.push_back(
            j);
    }
    for (SphereGroup& group : groups) {
        std::vector<Box> boxes;
        for (const std::uint32_t j : group.spheres) boxes.push_back(sweep.swept[j]);
        group.tree = buildBvh(boxes);
    }
    return groups;
}

MuscleSweep makeSweep(const SkinSearchMuscle& muscle, std::vector<int> chain, std::size_t vertices) {
    std::vector<MusclePoint> points;
    for (const Sphere& s : muscle.spheres) points.push_back(muscle.deformer->bind(s.centre));
    const Muscle& m = muscle.deformer->muscle();
    MuscleSweep sweep;
    sweep.spheres =
        makeTrack(*muscle.deformer, points, activationNodes(m.activationLower, m.activationUpper));
    for (std::size_t i = 0; i < sweep.spheres.thicknesses.size(); ++i)
        sweep.radii.push_back(sweep.spheres.thicknesses[i] * muscle.spheres[i % points.size()].radius);
    for (std::size_t j = 0; j < points.size(); ++j) sweep.swept.push_back(sweptBox(sweep, j));
    sweep.sides = m.sides;
    sweep.chain = std::move(chain);
    sweep.groups = groupsOf(sweep, muscle);
    sweep.carried.resize(vertices, 0);
    sweep.found.resize(vertices);
    return sweep;
}

/// Calls reaches(j) for the spheres of a group that may come within `near` of a box and are not found yet to
/// reach vertex v; those for which it says true are.
template <class Reaches>
void findNear(MuscleSweep& sweep, const SphereGroup& group, std::size_t v, const Box& box, double near,
              Reaches&& reaches) {
    visitBall(group.tree, box.center(), 0.5 * box.diagonal().norm() + (1 + 1e-9) * near,
              [&](std::uint32_t item) {
                  const std::uint32_t j = group.spheres[item];
                  std::vector<bool>& found = sweep.found[v];
                  if ((!found.empty() && found[j]) || apart(sweep.swept[j], box, near) || !reaches(j)) return;
                  if (found.empty()) found.resize(sweep.swept.size(), false);
                  found[j] = true;
              });
}

/// Some activation brings muscle sphere j within `near` (radius of the skin sphere + travel) of the path of a
/// skin vertex at `rest`. The path at an activation is the segment from there to where it is carried, at the
/// muscle's nodes; over a stretch of activations the moving end is boxed in by the segment's own motion.
bool reaches(const MuscleSweep& sweep, std::size_t j, const Vec3& rest, std::span<const Vec3> carried,
             double near) {
    const std::size_t nodes = sweep.spheres.nodes.size(), stride = sweep.spheres.points;
    for (std::size_t n = 0; n < nodes; ++n) {
        const std::size_t m = std::min(n + 1, nodes - 1);
        const Vec3 &a = sweep.spheres.positions[n * stride + j], &b = sweep.spheres.positions[m * stride + j];
        double distance = near + std::max(sweep.radii[n * stride + j], sweep.radii[m * stride + j]);
        // Over the stretch the path's end moves by |to - from|: it stays that near to the first path.
        if (!carried.empty()) distance += (carried[m] - carried[n]).norm();
        const double squared = carried.empty() ? (rest - closestOnSegment(rest, a, b)).squaredNorm()
                                               : squaredDistanceOfSegments(a, b, rest, carried[n]);
        if (squared <= distance * distance) return true;
    }
    return false;
}

/// Some activation brings muscle sphere j within `near` of a segment.
bool reaches(const MuscleSweep& sweep, std::size_t j, const Vec3& from, const Vec3& to, double near) {
    const std::size_t nodes = sweep.spheres.nodes.size(), stride = sweep.spheres.points;
    for (std::size_t n = 0; n < nodes; ++n) {
        const std::size_t m = std::min(n + 1, nodes - 1);
        const double distance = near + std::max(sweep.radii[n * stride + j], sweep.radii[m * stride + j]);
        if (squaredDistanceOfSegments(sweep.spheres.positions[n * stride + j],
                                      sweep.spheres.positions[m * stride + j], from,
                                      to) <= distance * distance)
            return true;
    }
    return false;
}

/// What is found while muscle m goes through its activations with all bones at rest.
void searchRange(MuscleSweep& sweep, const MuscleDeformer& muscle, const TriangleMesh& skin, SkinPath path,
                 const std::vector<double>& near) {
    std::vector<MusclePoint> points;
    if (path == SkinPath::Carried)
        for (const Vec3& v : skin.vertices) points.push_back(muscle.bind(v));
    const MuscleTrack track = makeTrack(muscle, points, sweep.spheres.nodes);
    parallelFor(skin.vertices.size(), [&](std::size_t v) {
        const Vec3& rest = skin.vertices[v];
        std::vector<Vec3> carried;
        for (std::size_t at = v; at < track.positions.size(); at += track.points)
            carried.push_back(track.positions[at]);
        Box box(rest);
        for (const Vec3& x : carried) box.extend(x);
        sweep.carried[v] = std::max((box.max() - rest).norm(), (box.min() - rest).norm());
        for (const SphereGroup& group : sweep.groups)
            findNear(sweep, group, v, box, near[v] + box.diagonal().norm(),
                     [&](std::size_t j) { return reaches(sweep, j, rest, carried, near[v]); });
    });
}

/// Where the skin is at rest and at each station of a swing, #stations + 1 of #V.
std::vector<std::vector<Vec3>> swungPlaces(const TriangleMesh& skin, const BoneSwing& swing,
                                           const std::vector<std::vector<double>>& shares) {
    std::vector<std::vector<Vec3>> places(swing.size() + 1, skin.vertices);
    for (std::size_t s = 0; s < swing.size(); ++s) {
        std::vector<DualPose> motions;
        std::vector<bool> moves;
        for (const Pose& pose : swing[s]) {
            motions.emplace_back(pose);
            moves.push_back(pose.matrix() != Pose::Identity().matrix());
        }
        parallelFor(skin.vertices.size(), [&](std::size_t v) {
            PoseBlend blend;
            bool carried = false;
            for (std::size_t k = 0; k < shares.size(); ++k)
                if (shares[k][v] > 0 && moves[k]) {
                    blend.add(shares[k][v], motions[k]);
                    carried = true;
                }
            if (carried) places[s + 1][v] = blend.pose() * skin.vertices[v];
        });
    }
    return places;
}

/// From the skin's frame to that of a place along the bones of muscle m, at rest and at each station.
std::vector<Pose> viewsOf(const MuscleSweep& sweep, std::size_t m, double share, const BoneSwing& swing) {
    std::vector<Pose> views{Pose::Identity()};
    for (const std::vector<Pose>& station : swing)
        views.push_back(
            (station[m] * ChainBlend(chainMotion(station, m, sweep.chain), sweep.sides).at(share)).inverse());
    return views;
}

constexpr double stepSlack = 0.1; ///< of a step between stations: how far the true path may leave the chord

/// What a group of muscle m's spheres meets while the bones swing.
void searchSwing(MuscleSweep& sweep, std::size_t m, const SphereGroup& group, const BoneSwing& swing,
                 const std::vector<std::vector<Vec3>>& places, const std::vector<double>& near) {
    if (group.spheres.empty()) return;
    const std::vector<Pose> views = viewsOf(sweep, m, group.share, swing);
    std::vector<Pose> beside; // seen from half way to the next group
    const double half = 0.5 / static_cast<double>(spanSteps * std::max<std::size_t>(sweep.chain.size(), 1));
    if (!sweep.chain.empty())
        beside = viewsOf(sweep, m, group.share + (group.share < 1 ? half : -half), swing);
    parallelFor(near.size(), [&](std::size_t v) {
        std::vector<Vec3> path;
        double most = 0;
        for (std::size_t s = 0; s < views.size(); ++s) {
            path.push_back(views[s] * places[s][v]);
            if (!beside.empty()) most = std::max(most, (path[s] - beside[s] * places[s][v]).norm());
        }
        for (std::size_t s = 0; s + 1 < path.size(); ++s) {
            if (path[s] == path[s + 1]) continue;
            const double room = near[v] + sweep.carried[v] + (1 + stepSlack) * most +
                                stepSlack * (path[s + 1] - path[s]).norm();
            findNear(sweep, group, v, Box(path[s]).extend(path[s + 1]), room,
                     [&](std::size_t j) { return reaches(sweep, j, path[s], path[s + 1], room); });
        }
    });
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
    if (!options.chains.empty() && options.chains.size() != muscles.size())
        throw InputError("the search under a skin needs one chain of bones a muscle");
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
    const double steps = static_cast<double>(muscles.size() + options.swings.size());
    const auto step = [&](std::size_t k) {
        if (!report(progress, "skin", static_cast<double>(k) / steps))
            throw InputError("stopped before the table was complete");
    };
    std::vector<MuscleSweep> sweeps;
    std::vector<std::vector<double>> near; // #muscles of #V
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        step(m);
        near.emplace_back(skin.vertices.size(), thickness + options.travel);
        for (std::size_t v = 0; v < near[m].size() && !options.stray.empty(); ++v)
            near[m][v] += options.stray[m][v];
        sweeps.push_back(makeSweep(muscles[m],
                                   options.chains.empty() ? std::vector<int>() : options.chains[m],
                                   skin.vertices.size()));
        searchRange(sweeps[m], *muscles[m].deformer, skin, options.path, near[m]);
    }
    for (std::size_t k = 0; k < options.swings.size(); ++k) {
        step(muscles.size() + k);
        const auto places = swungPlaces(skin, options.swings[k], options.shares);
        for (std::size_t m = 0; m < muscles.size(); ++m)
            for (const SphereGroup& group : sweeps[m].groups)
                searchSwing(sweeps[m], m, group, options.swings[k], places, near[m]);
    }

    SphereSet skinSpheres, muscleSpheres;
    for (const Vec3& v : skin.vertices) skinSpheres.push_back({v, thickness});
    std::vector<std::uint32_t> muscleOf;
    std::vector<SpherePair> pairs;
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        const auto first = static_cast<std::uint32_t>(muscleSpheres.size());
        for (std::uint32_t v = 0; v < skin.vertices.size(); ++v)
            for (std::uint32_t j = 0; j < sweeps[m].found[v].size(); ++j)
                if (sweeps[m].found[v][j]) pairs.push_back({v, j + first});
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
