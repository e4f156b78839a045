#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss::rig {
namespace {

constexpr double attachReach = 0.3; ///< share of the fibre around its moving end over which it is attached
constexpr int spreadRounds = 8;
constexpr double leastCloseness = 0.01;
constexpr int dragSweeps = 150;
constexpr double dragTolerance = 5e-7; ///< change of a displacement in a sweep, in sizes of the skin

/// 1 at 0, 0 from 1 on, smooth.
double falloff(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

} // namespace

namespace {

/// Averages values over the skin: folds and edges of the muscle would tear at neighbours otherwise.
void spread(std::vector<double>& values, const Rings& rings) {
    std::vector<double> next;
    for (int round = 0; round < spreadRounds; ++round) {
        next = values;
        for (std::size_t v = 0; v < values.size(); ++v) {
            if (rings.ring[v].empty()) continue;
            double sum = 0;
            for (const std::uint32_t w : rings.ring[v]) sum += values[w];
            next[v] = (values[v] + sum / static_cast<double>(rings.ring[v].size())) / 2;
        }
        values.swap(next);
    }
}

} // namespace

std::vector<Closeness> closeness(const TriangleMesh& skin, const std::vector<Vec3>& normals,
                                 const Rings& rings, const MuscleDeformer& muscle, double reach) {
    if (!(reach > 0)) return {}; // a table without spheres: the muscle meets nothing of the skin
    Eigen::AlignedBox3d box = bounds(muscle.muscle().surface);
    box.min().array() -= reach;
    box.max().array() += reach;
    const double movingEnd = muscle.muscle().anchor < 0.5 ? 1 : 0;
    std::vector<double> close(skin.vertices.size(), 0), attach(skin.vertices.size(), 0);
    for (std::uint32_t v = 0; v < skin.vertices.size(); ++v) {
        if (!box.contains(skin.vertices[v])) continue;
        const MusclePoint point = muscle.bind(skin.vertices[v]);
        close[v] =
            falloff((point.height / reach - 0.25) / 0.75) * std::max(0.0, point.normal.dot(normals[v]));
        attach[v] = close[v] * falloff(std::abs(point.s - movingEnd) / attachReach);
    }
    spread(close, rings);
    spread(attach, rings);
    std::vector<Closeness> result;
    for (std::uint32_t v = 0; v < skin.vertices.size(); ++v)
        if (close[v] > leastCloseness)
            result.push_back({v, muscle.bind(skin.vertices[v]), close[v] - leastCloseness, attach[v]});
    return result;
}

/// At one node after the other, outwards from activation 0: each is nearly a multiple of the one before.
void addDrag(const SkinRig& rig, const SheetPatch& patch, SkinMuscle& muscle) {
    SkinDrag& drag = muscle.drag;
    drag.vertices = patch.vertices;
    const std::size_t count = patch.vertices.size();
    drag.moves.assign(drag.nodes.size() * count, Move::Zero());
    std::vector<std::uint32_t> indexOf(rig.rest.size(), 0);
    for (std::uint32_t i = 0; i < count; ++i) indexOf[patch.vertices[i]] = i;

    const float tolerance = static_cast<float>(dragTolerance * rig.size);
    std::vector<SheetPlane> none;
    std::vector<Move> reference(count);
    const auto solveFrom = [&](std::size_t begin, std::size_t end, std::size_t step) {
        SkinSolver solver(patch.sheet);
        double before = 0;
        for (std::size_t n = begin; n != end; n += step) {
            const double a = drag.nodes[n];
            std::fill(reference.begin(), reference.end(), Move::Zero());
            const TrackPlace place = locate(muscle.skin.nodes, a);
            for (std::size_t i = 0; i < muscle.carried.size(); ++i) {
                const SkinCarry& c = muscle.carried[i];
                const Vec3 d = trackPosition(muscle.skin, place, i) - rig.rest[c.vertex];
                reference[indexOf[c.vertex]].head<3>() += c.pull * d.cast<float>();
            }
            if (before != 0) solver.scale(static_cast<float>(a / before));
            solver.solve(reference, none, dragSweeps, tolerance);
            std::copy(solver.displacements().begin(), solver.displacements().end(),
                      drag.moves.begin() + static_cast<std::ptrdiff_t>(n * count));
            before = a;
        }
    };
    const auto above = std::upper_bound(drag.nodes.begin(), drag.nodes.end(), 0.0) - drag.nodes.begin();
    solveFrom(static_cast<std::size_t>(above), drag.nodes.size(), 1);
    auto below = static_cast<std::size_t>(above);
    if (below > 0 && drag.nodes[below - 1] == 0) --below;
    solveFrom(below - 1, std::numeric_limits<std::size_t>::max(), std::numeric_limits<std::size_t>::max());
}

} // namespace tss::rig
