#include "bake/check/EarlyContact.h"

#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/motion/Motion.h"
#include "bake/pipeline/FillPair.h"
#include "bake/search/SampledSearch.h"
#include "bake/table/Query.h"
#include "bake/table/Table.h"

namespace tss {

namespace {

/// The distance of the surfaces, scene units, no more than `most`; 0 where it is less than a thousandth of
/// that.
double clearance(const MeshQuery& a, const MeshQuery& b, const Pose& bToA, double most) {
    const double distance = std::min(a.distanceTo(b, bToA, most), most);
    return distance < most / 1000 ? 0 : distance;
}

/// The share of the lengths that are below the limit.
double shareBelow(const std::vector<double>& lengths, double limit) {
    if (lengths.empty()) return 0;
    const auto below = std::ranges::count_if(lengths, [&](double l) { return l < limit; });
    return static_cast<double>(below) / static_cast<double>(lengths.size());
}

/// A pair's table, and the same as it is asked at run time.
struct AskedTable {
    const Table& plain;
    const PreparedTable& prepared;

    /// As the plain query says, which looks at all tests where none touches: there the prepared table tells.
    bool reports(const std::vector<double>& q) const {
        if (withinLimits(plain.motion, q) && !prepared.hit(q.data())) return false;
        return touches(plain, pose(plain.motion, q));
    }
};

/// Whether contact is reported at one of the first steps from rest in a direction: at 1/1024 to 1/128 of the
/// range of each DOF. direction: -1, 0 or 1 for each DOF. Nothing where the steps leave the limits.
std::optional<bool> isBlocked(const AskedTable& table, const Motion& motion, const std::vector<double>& rest,
                              const std::vector<int>& direction) {
    for (const double step : {1.0 / 1024, 1.0 / 512, 1.0 / 256, 1.0 / 128}) {
        std::vector<double> q = rest;
        for (std::size_t k = 0; k < q.size(); ++k)
            q[k] += step * direction[k] * (motion.dofs[k].upper - motion.dofs[k].lower);
        if (!withinLimits(motion, q, 0)) return std::nullopt;
        if (table.reports(q)) return true;
    }
    return false;
}

/// Whether every small step from rest within the limits is reported as contact. Tries all combinations of
/// directions of the DOFs; with many DOFs one DOF at a time.
bool isHeldAtRest(const AskedTable& table, const Motion& motion, const std::vector<double>& rest) {
    constexpr std::size_t most = 5; // DOFs: 242 directions
    const std::size_t dofs = rest.size();
    std::vector<std::vector<int>> directions;
    if (dofs <= most) {
        std::size_t count = 1;
        for (std::size_t k = 0; k < dofs; ++k) count *= 3;
        for (std::size_t number = 0; number < count; ++number) {
            std::vector<int> direction;
            for (std::size_t k = 0, digits = number; k < dofs; ++k, digits /= 3)
                direction.push_back(static_cast<int>(digits % 3) - 1);
            directions.push_back(std::move(direction));
        }
    } else {
        for (std::size_t k = 0; k < dofs; ++k)
            for (const int sign : {-1, 1}) directions.emplace_back(dofs, 0)[k] = sign;
    }
    bool any = false;
    for (const std::vector<int>& direction : directions) {
        if (std::ranges::all_of(direction, [](int sign) { return sign == 0; })) continue;
        const std::optional<bool> blocked = isBlocked(table, motion, rest, direction);
        if (blocked == false) return false;
        any |= blocked.has_value();
    }
    return any;
}

/// About a hundred poses spread over Q. Over three DOFs and more they are random: a grid of so few would
/// consist of the corners of Q, which are all the same pose for joints that turn all the way round.
std::vector<std::vector<double>> spreadPoses(const Motion& motion) {
    constexpr std::size_t count = 100;
    return motion.dofCount() < 3 ? exploredPoses(motion, count, 1) : randomPoses(motion, count, 1);
}

} // namespace

std::optional<EarlyContact> measureEarlyContact(const SceneModel& scene, const Pair& pair) {
    if (!pair.table) return std::nullopt;
    return measureEarlyContact(scene, pair, PreparedTable(*pair.table));
}

std::optional<EarlyContact> measureEarlyContact(const SceneModel& scene, const Pair& pair,
                                                const PreparedTable& prepared) {
    const TriangleMesh &meshA = scene.bodies[pair.bodyA].mesh, &meshB = scene.bodies[pair.bodyB].mesh;
    if (!pair.table || meshA.empty() || meshB.empty()) return std::nullopt;
    const double early = earlyOfTable(*pair.table).value_or(0), epsilon = pair.table->epsilon;
    if (!(early > 0)) return std::nullopt;
    const Motion motion = pairMotion(scene, pair);
    const MeshQuery a(meshA), b(meshB);
    EarlyContact result;
    const double size = std::min(diagonal(meshA), diagonal(meshB));
    const std::vector<double> rest = restValues(motion);
    result.atRest = clearanceAtRest(meshA, meshB, motion);
    result.close = result.atRest < std::max(size, early) / 1000;
    const AskedTable table{*pair.table, prepared};
    const bool contact = table.reports(rest);
    result.restReported = !result.close && contact;
    result.held = !contact && isHeldAtRest(table, motion, rest);

    const std::vector<std::vector<double>> poses = spreadPoses(motion);
    std::vector<double> distances(poses.size(), early);
    std::vector<char> reported(poses.size());
    parallelFor(poses.size(), [&](std::size_t i) {
        reported[i] = table.reports(poses[i]);
        // Where no contact is reported, and none can be missed, the surfaces are apart: their distance is
        // only needed later.
        if (reported[i] || pair.table->boundMiss != 0)
            distances[i] = clearance(a, b, pose(motion, poses[i]), early);
    });
    std::vector<double> free, wrong; // distances: of the free poses, and of those reported nevertheless
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (distances[i] > 0) free.push_back(distances[i]);
        if (distances[i] > 0 && reported[i]) wrong.push_back(distances[i]);
    }
    result.poses = static_cast<int>(poses.size());
    result.freePoses = static_cast<int>(free.size());
    if (!free.empty()) result.share = static_cast<double>(wrong.size()) / static_cast<double>(free.size());
    if (!result.coarse()) return result;

    // With it the spheres of both bodies take at most six tenths of the clearance that the joint has where
    // contact is reported though nothing touches.
    const double play = std::min(wrong.empty() ? early : median(wrong), result.close ? early : result.atRest);
    const double proposed = roundedDownToDigit(0.3 * play), now = (early - epsilon) / 2;
    if (proposed >= 0.9 * now) return result;
    result.tolerance = proposed;
    const double then = 2 * proposed + epsilon;
    parallelFor(poses.size(), [&](std::size_t i) {
        if (distances[i] >= early && !a.apart(b, pose(motion, poses[i]), then)) distances[i] = 0.5 * then;
    });
    std::erase(distances, 0.0);
    result.shareThen = shareBelow(distances, then);
    return result;
}

} // namespace tss
