#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <tuple>

namespace tss::rig {
namespace {

constexpr double carryReach = 6;    ///< in thicknesses: height at which a muscle lets go of the skin
constexpr double grownDepth = 0.25; ///< in thicknesses: depth in a muscle from which skin is grown into it
constexpr double attachReach = 0.3; ///< share of the fibre around its moving end over which it is attached
constexpr double carryStrain = 0.3; ///< how much the fall-off of what a muscle carries may stretch the skin
constexpr double mostCarried =
    0.97; ///< share of all muscles together in a vertex's move, unless it lags too far
constexpr double allCarried = 0.999; ///< the same however far it would lag
constexpr double lag = 0.25;         ///< in thicknesses: how far what is carried may stay behind
constexpr double leastPull = 0.01;
constexpr double nearestReach = 2; ///< in thicknesses: how much farther a bone is that has no hold any more
constexpr int spreadRounds = 8;

/// 1 at 0, 0 from 1 on, smooth.
double falloff(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

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

/// The share of a move that leaves no more than the lag behind.
double shareOf(double move, double thickness) {
    return move > 0 ? std::clamp(1 - lag * thickness / move, mostCarried, allCarried) : mostCarried;
}

/// A skin over one muscle: what the muscle does to a vertex.
class Carrier {
public:
    Carrier(const TriangleMesh& skin, const MuscleDeformer& muscle, std::vector<Pose> swings)
        : skin_(skin), muscle_(muscle),
          swings_(std::move(swings)), ends_{muscle.state(muscle.muscle().activationLower),
                                            muscle.state(muscle.muscle().activationUpper)},
          points_(skin.vertices.size()), farthest_(skin.vertices.size(), -1) {}

    const MusclePoint& point(std::uint32_t v) {
        if (farthest_[v] < 0) bind(v);
        return points_[v];
    }

    /// How far the muscle, or its bone, would move a vertex that only it holds.
    double farthest(std::uint32_t v) {
        if (farthest_[v] < 0) bind(v);
        return farthest_[v];
    }

    /// How far its contraction alone would.
    double contracted(std::uint32_t v) {
        double most = 0;
        for (const MuscleState& end : ends_)
            most = std::max(most, (muscle_.map(point(v), end) - skin_.vertices[v]).norm());
        return most;
    }

private:
    void bind(std::uint32_t v) {
        const Vec3& x = skin_.vertices[v];
        points_[v] = muscle_.bind(x);
        farthest_[v] = 0;
        farthest_[v] = contracted(v);
        for (const Pose& swing : swings_) farthest_[v] = std::max(farthest_[v], (swing * x - x).norm());
    }

    const TriangleMesh& skin_;
    const MuscleDeformer& muscle_;
    std::vector<Pose> swings_;
    MuscleState ends_[2];
    std::vector<MusclePoint> points_;
    std::vector<double> farthest_; ///< -1: not known yet
};

/// What one muscle would do to the skin, were there no other.
struct Hold {
    Carrier carrier;
    std::vector<double> pull;   ///< #V share of the muscle's move that the vertex makes
    std::vector<double> grown;  ///< #V the same, of what is grown into the muscle, or held by a bone, alone
    std::vector<double> height; ///< #V over a bone, infinite away from it; empty: a muscle that contracts
};

/// Raises values so that they fall along the skin no faster than what is moved by as much may be stretched.
/// move(v): how far a vertex may be moved. What counts is the least of it on the way from where the value
/// stands: a bone that swings takes along what lies about its root, however far its swing would carry what
/// lies beyond.
/// tether: #V, empty: none; what is tethered does not give way.
template <class Move>
void limitSlope(std::vector<double>& values, const TriangleMesh& skin, const Rings& rings,
                const std::vector<double>& tether, const Move& move) {
    struct Front {
        double value, moved;
        std::uint32_t vertex;
        bool operator<(const Front& o) const {
            return std::tie(value, moved, vertex) < std::tie(o.value, o.moved, o.vertex);
        }
    };
    std::priority_queue<Front> queue;
    for (std::uint32_t v = 0; v < values.size(); ++v)
        if (values[v] > leastPull) queue.push({values[v], move(v), v});
    while (!queue.empty()) {
        const auto [value, before, v] = queue.top();
        queue.pop();
        if (value < values[v]) continue;
        const double moved = std::min(before, move(v));
        if (!(moved > 0)) continue;
        for (const std::uint32_t w : rings.ring[v]) {
            const double free = tether.empty() ? 1 : 1 - tether[w];
            const double least =
                free * (value - carryStrain / moved * (skin.vertices[v] - skin.vertices[w]).norm());
            if (least <= std::max(values[w], leastPull)) continue;
            queue.push({values[w] = least, moved, w});
        }
    }
}

Hold holdOf(const TriangleMesh& skin, const std::vector<Vec3>& normals, const Rings& rings,
            const MuscleDeformer& muscle, const SkinParameters& p, std::size_t index, double thickness) {
    const std::size_t count = skin.vertices.size();
    std::vector<Pose> swings;
    for (const BoneSwing& swing : p.swings)
        for (const std::vector<Pose>& station : swing)
            if (station[index].matrix() != Pose::Identity().matrix()) swings.push_back(station[index]);
    Hold hold{Carrier(skin, muscle, std::move(swings)),
              std::vector<double>(count, 0),
              std::vector<double>(count, 0),
              {}};
    const double reach = carryReach * thickness;
    const double carry = index < p.carry.size() ? p.carry[index] : 1;
    if (!(reach > 0) || !(carry > 0)) return hold; // a table without spheres: the muscle meets nothing
    Eigen::AlignedBox3d box = bounds(muscle.muscle().surface);
    box.min().array() -= reach;
    box.max().array() += reach;
    const bool rigid = muscle.muscle().activationLower == 0 && muscle.muscle().activationUpper == 0;
    const double movingEnd = muscle.muscle().anchor < 0.5 ? 1 : 0;
    if (rigid) hold.height.assign(count, std::numeric_limits<double>::infinity());
    std::vector<double> close(count, 0), attach(count, 0);
    for (std::uint32_t v = 0; v < count; ++v) {
        if (!box.contains(skin.vertices[v])) continue;
        const MusclePoint& point = hold.carrier.point(v);
        if (rigid) hold.height[v] = point.height;
        // Away from the muscle only what faces as it does; what touches it, whichever way.
        const double facing =
            std::max(point.normal.dot(normals[v]), falloff(std::max(0.0, point.height) / thickness));
        close[v] = falloff((point.height / reach - 0.25) / 0.75) * std::max(0.0, facing);
        attach[v] = close[v];
        if (!p.attach.empty())
            attach[v] *= p.attach[v];
        else if (!rigid) // what does not contract has no end that moves
            attach[v] *= falloff(std::abs(point.s - movingEnd) / attachReach);
        hold.grown[v] = carry * falloff(1 + point.height / (grownDepth * thickness));
    }
    spread(close, rings);
    if (p.attach.empty()) spread(attach, rings);
    for (std::uint32_t v = 0; v < count; ++v) {
        const double stiffness = p.fascia * close[v] + p.attachment * attach[v];
        hold.pull[v] = stiffness / (1 + stiffness);
        // What does not contract has nothing that skin would slide over: it swings as a whole.
        if (rigid && close[v] > leastPull) {
            hold.pull[v] = std::max(hold.pull[v], close[v] * shareOf(hold.carrier.farthest(v), thickness));
            hold.grown[v] = std::max(hold.grown[v], carry * close[v]);
        }
        hold.pull[v] *= carry;
    }
    return hold;
}

/// How far another muscle moves any vertex that it pulls at, where it pulls at skin that is grown into this
/// one.
double farthestBeside(const Hold& hold, Hold& other) {
    double most = 0;
    bool meets = false;
    for (std::uint32_t v = 0; v < hold.grown.size(); ++v) {
        if (!(other.pull[v] > leastPull)) continue;
        meets = meets || hold.grown[v] > leastPull;
        most = std::max(most, other.carrier.farthest(v));
    }
    return meets ? most : 0;
}

/// Skin between bones is held by the nearest: what lies beyond another one does not reach it.
void ownNearest(std::vector<Hold>& holds, std::size_t count, double thickness) {
    for (std::uint32_t v = 0; v < count; ++v) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Hold& hold : holds)
            if (!hold.height.empty()) nearest = std::min(nearest, hold.height[v]);
        if (!std::isfinite(nearest)) continue;
        for (Hold& hold : holds) {
            if (hold.height.empty()) continue;
            const double own = falloff((hold.height[v] - nearest) / (nearestReach * thickness));
            hold.pull[v] *= own;
            hold.grown[v] *= own;
        }
    }
}

} // namespace

std::vector<std::vector<Carried>>
carriedSkin(const TriangleMesh& skin, const std::vector<Vec3>& normals, const Rings& rings,
            const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
            const SkinParameters& parameters, double thickness) {
    const std::size_t count = skin.vertices.size();
    std::vector<Hold> holds;
    for (std::size_t m = 0; m < muscles.size(); ++m)
        holds.push_back(holdOf(skin, normals, rings, *muscles[m], parameters, m, thickness));

    ownNearest(holds, count, thickness);

    // What is grown into one muscle is not pulled out of it by the others: their pull fades towards it.
    std::vector<double> grown(count, 0);
    for (Hold& hold : holds) {
        if (hold.height.empty()) { // a bone's own hold falls off as it is
            double most = 0;
            for (Hold& other : holds) most = std::max(most, farthestBeside(hold, other));
            limitSlope(hold.grown, skin, rings, parameters.tether, [&](std::uint32_t) { return most; });
        }
        for (std::uint32_t v = 0; v < count; ++v) grown[v] += hold.grown[v];
    }
    std::vector<double> total(count, 0);
    for (Hold& hold : holds) {
        limitSlope(hold.pull, skin, rings, parameters.tether,
                   [&](std::uint32_t v) { return hold.carrier.farthest(v); });
        for (std::uint32_t v = 0; v < count; ++v) {
            hold.pull[v] *= std::max(0.0, 1 - (grown[v] - hold.grown[v]));
            hold.pull[v] = std::max(hold.pull[v], hold.grown[v]);
        }
        spread(hold.pull, rings);
        for (std::uint32_t v = 0; v < count; ++v) total[v] += hold.pull[v];
    }
    std::vector<std::vector<Carried>> result(muscles.size());
    for (std::size_t m = 0; m < muscles.size(); ++m)
        for (std::uint32_t v = 0; v < count; ++v) {
            const double part = holds[m].pull[v] / std::max(1.0, total[v]);
            if (!(part > leastPull)) continue;
            Carrier& carrier = holds[m].carrier;
            const double pull =
                shareOf(carrier.farthest(v), thickness) * (part - leastPull) / (1 - leastPull);
            result[m].push_back({v, carrier.point(v), pull, carrier.contracted(v)});
        }
    return result;
}

} // namespace tss::rig
