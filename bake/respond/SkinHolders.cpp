#include "bake/respond/SkinCarry.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"

#include <algorithm>
#include <map>
#include <optional>

namespace tss {
namespace {

/// In sizes of a bone: skin beyond this is not its own, beside a bone that holds still: a chin is within it
/// of its teeth. Where bones are short and the body is thick, it is within twice the depth that the bone lies
/// at.
constexpr double farDistance = 1.5;
/// Where no bone holds still, skin this far from all bones does, ever less so up to them.
constexpr double stillDistance = 0.5;
/// What is beyond a bone lies within this of its direction from the joint: cosine of 45 degrees.
constexpr double aheadCosine = 0.7;
/// In sizes of a bone: nearer to its joint its middle says nothing about where the bone goes.
constexpr double leastArm = 0.25;

/// Of the least that a bone beside it holds: what is smaller than this is a patch, no part of the body. It
/// stays where a bone that holds still is near, else goes with what is around it.
constexpr double leastPart = 0.1;

struct FrameHolder {
    SkinHolder holder;
    std::vector<std::size_t> bodies;
    std::vector<Vec3> nearest; ///< #V: where it is nearest
    Eigen::AlignedBox3d box;
    double extent = 0;         ///< diagonal of its bounds
    std::size_t moves = 0;     ///< in how many swings
    Vec3 joint = Vec3::Zero(); ///< what its own swings leave nearest to where it is; of a slide its middle
    bool twists = false;       ///< it turns about its own length, as seen from what it hangs on
};

/// The surfaces that stand for a frame: its bones, or its muscles where it has none.
FrameHolder holderOf(const SkinGround& ground, const std::vector<int>& frames, int frame) {
    const std::size_t count = ground.skin.vertices.size();
    FrameHolder made;
    made.holder.distance.assign(count, infinity);
    made.nearest = ground.skin.vertices;
    bool bones = false;
    for (std::size_t m = 0; m < frames.size(); ++m) bones |= frames[m] == frame && ground.bodies[m]->rigid();
    for (std::size_t m = 0; m < frames.size(); ++m) {
        if (frames[m] != frame || ground.bodies[m]->rigid() != bones) continue;
        made.bodies.push_back(m);
        made.box.extend(bounds(ground.bodies[m]->muscle().surface));
        parallelFor(count, [&](std::size_t v) {
            double& distance = made.holder.distance[v];
            const NearestPoint near = ground.locators[m].nearest(ground.skin.vertices[v], distance);
            if (near.triangle < 0) return;
            distance = near.distance;
            made.nearest[v] = near.point;
        });
    }
    made.extent = made.box.isEmpty() ? 0 : made.box.diagonal().norm();
    made.holder.size = made.extent;
    return made;
}

/// The nearest bone that moves in fewer swings than this one.
const FrameHolder* boneBefore(const std::vector<FrameHolder>& holders, std::size_t bone) {
    const Vec3 middle = holders[bone].box.center();
    const FrameHolder* before = nullptr;
    for (const FrameHolder& other : holders) {
        if (other.moves >= holders[bone].moves || other.box.isEmpty()) continue;
        if (!before || (other.box.center() - middle).norm() < (before->box.center() - middle).norm())
            before = &other;
    }
    return before;
}

/// How often frames move, and about what.
void setMotions(const SkinParameters& p, const std::vector<int>& frames, std::vector<FrameHolder>& holders) {
    struct Least {
        std::size_t movers = 0; ///< frames that move in its own swings, the fewest
        Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
        Vec3 right = Vec3::Zero();
    };
    std::vector<Least> least(holders.size());
    for (FrameHolder& holder : holders) holder.moves = p.swings.empty();
    for (const BoneSwing& swing : p.swings) {
        std::map<std::size_t, Pose> moved;
        for (const std::vector<Pose>& station : swing)
            for (std::size_t m = 0; m < station.size(); ++m)
                if (frames[m] >= 0 && station[m].matrix() != Pose::Identity().matrix())
                    moved[static_cast<std::size_t>(frames[m])] = station[m];
        for (const auto& [h, pose] : moved) {
            ++holders[h].moves;
            Least& own = least[h];
            if (own.movers != 0 && own.movers < moved.size()) continue;
            if (own.movers != moved.size()) own = {moved.size()};
            const Eigen::Matrix3d turn = pose.linear() - Eigen::Matrix3d::Identity();
            own.matrix += turn.transpose() * turn;
            own.right -= turn.transpose() * (pose * holders[h].box.center() - holders[h].box.center());
        }
    }
    for (std::size_t h = 0; h < holders.size(); ++h) {
        if (holders[h].box.isEmpty()) continue;
        const Vec3 middle = holders[h].box.center();
        holders[h].joint = middle;
        const double some = 1e-6 * least[h].matrix.trace();
        if (!(some > 0)) continue;
        const auto places = (least[h].matrix + some * Eigen::Matrix3d::Identity()).eval().ldlt();
        holders[h].joint += places.solve(least[h].right); // along an axis the place beside the middle
        const FrameHolder* before = boneBefore(holders, h);
        const Vec3 from = before ? Vec3(middle - before->box.center()) : Vec3::Zero();
        holders[h].twists = some * places.solve(from).norm() > aheadCosine * from.norm();
    }
}

/// The nearest to each vertex, of those that it is not apart from where there is one.
std::vector<std::size_t> nearestOf(const std::vector<FrameHolder>& holders, std::size_t count) {
    std::vector<std::size_t> nearest(count, 0);
    const auto less = [&](std::size_t v, std::size_t a, std::size_t b) {
        const bool apart = !holders[a].holder.apart.empty() && holders[a].holder.apart[v],
                   other = !holders[b].holder.apart.empty() && holders[b].holder.apart[v];
        return apart != other ? other : holders[a].holder.distance[v] < holders[b].holder.distance[v];
    };
    for (std::size_t v = 0; v < count; ++v)
        for (std::size_t h = 1; h < holders.size(); ++h)
            if (less(v, h, nearest[v])) nearest[v] = h;
    return nearest;
}

double depthOf(const SkinGround& ground, const ClosestPointQuery& skin, const FrameHolder& holder) {
    double deepest = 0;
    for (const std::size_t m : holder.bodies) {
        const std::vector<Vec3>& places = ground.bodies[m]->muscle().surface.vertices;
        std::vector<double> depth(places.size(), 0);
        parallelFor(places.size(), [&](std::size_t v) {
            const NearestPoint near = skin.nearest(places[v], infinity);
            const Vec3 normal = ground.normals[ground.skin.triangles[near.triangle][0]];
            if ((places[v] - near.point).dot(normal) < 0) depth[v] = near.distance;
        });
        for (const double d : depth) deepest = std::max(deepest, d);
    }
    return deepest;
}

/// Marks those vertices that are apart from the bone: far from it, or the straight way to it leaves the body
/// and goes in again elsewhere, as from the belly to a leg. Out alone does not count: teeth are not inside of
/// lips. far: scene units.
void markApart(const SkinGround& ground, const ClosestPointQuery& skin, double far, FrameHolder& holder) {
    constexpr double away = 1e-3; // of the way, so that it does not begin in the skin
    holder.holder.apart.assign(ground.skin.vertices.size(), 1);
    parallelFor(holder.holder.apart.size(), [&](std::size_t v) {
        if (holder.holder.distance[v] > far) return;
        const Vec3 &x = ground.skin.vertices[v], &to = holder.nearest[v];
        const Vec3 from = x + away * (to - x);
        holder.holder.apart[v] = skin.entered(from, to) >= 0;
    });
}

/// Skin that hangs together and is apart from all bones.
struct FreePart {
    std::vector<std::uint32_t> vertices;
    double area = 0;                           ///< scene units squared
    std::map<std::size_t, std::size_t> beside; ///< the holders nearest to what is around it, and to how much
    bool small = false;                        ///< no part of the body, but a patch between bones
    bool nearStill = false; ///< a bone that holds still is nearest to some of what is around it, apart or not
    Vec3 ring = Vec3::Zero(); ///< the middle of what is around it
};

struct FreeParts {
    std::vector<FreePart> parts;
    std::vector<double> held; ///< #holders: the area of the skin that is not free and nearest to each
};

FreeParts freeParts(const SkinGround& ground, std::vector<FrameHolder>& holders, bool anyStill) {
    const std::size_t count = ground.skin.vertices.size();
    const std::vector<std::size_t> plain = nearestOf(holders, count);
    const ClosestPointQuery skin(ground.skin);
    std::vector<char> isFree(count, 1);
    for (FrameHolder& h : holders) {
        const double far = anyStill ? std::max(farDistance * h.extent, 2 * depthOf(ground, skin, h))
                                    : stillDistance * h.extent;
        markApart(ground, skin, far, h);
        for (std::size_t v = 0; v < count; ++v) isFree[v] = isFree[v] && h.holder.apart[v];
    }
    const std::vector<std::size_t> nearest = nearestOf(holders, count);
    FreeParts made{{}, std::vector<double>(holders.size(), 0)};
    for (std::size_t v = 0; v < count; ++v)
        if (!isFree[v]) made.held[nearest[v]] += ground.graph.area[v];
    UnionFind sets(count);
    const auto edges = [&](const auto& visit) {
        for (std::size_t v = 0; v < count; ++v)
            for (const SkinGraph::Edge& edge : ground.graph.edges[v])
                if (isFree[v]) visit(v, edge.to);
    };
    edges([&](std::size_t v, std::size_t next) {
        if (isFree[next]) sets.join(v, next);
    });
    std::map<std::size_t, FreePart> parts;
    for (std::size_t v = 0; v < count; ++v)
        if (isFree[v]) {
            FreePart& part = parts[sets.root(v)];
            part.vertices.push_back(static_cast<std::uint32_t>(v));
            part.area += ground.graph.area[v];
        }
    edges([&](std::size_t v, std::size_t next) {
        if (isFree[next]) return;
        FreePart& part = parts[sets.root(v)];
        ++part.beside[nearest[next]];
        part.nearStill |= holders[plain[next]].moves == 0;
        part.ring += ground.skin.vertices[next];
    });
    for (auto& [root, part] : parts) {
        std::size_t around = 0;
        bool counts = part.beside.empty() || !anyStill;
        for (const auto& [h, times] : part.beside) {
            around += times;
            counts |= part.area >= leastPart * made.held[h];
        }
        part.small = !counts;
        const bool byChance = part.vertices.size() == 1; // its straight ways graze the skin beside it
        if (part.small && (byChance || !part.nearStill)) continue;
        part.ring /= static_cast<double>(std::max<std::size_t>(around, 1));
        made.parts.push_back(std::move(part));
    }
    return made;
}

/// What holds still though no bone does: the skin far from all bones.
SkinHolder stillOf(const std::vector<FrameHolder>& holders, const FreeParts& free) {
    SkinHolder still{std::vector<double>(holders[0].holder.distance.size(), 0), infinity, {}, {}};
    double longest = 0;
    for (const FrameHolder& h : holders) {
        longest = std::max(longest, 2 * stillDistance * h.extent);
        for (std::size_t v = 0; v < still.distance.size(); ++v) // at that distance as near as the bone
            still.distance[v] =
                std::max(still.distance[v], 2 * stillDistance * h.extent - h.holder.distance[v]);
    }
    for (const FreePart& part : free.parts) {
        const bool isEnd = part.beside.size() == 1 && part.area < free.held[part.beside.begin()->first];
        for (const std::uint32_t v : part.vertices) still.distance[v] = isEnd ? longest : 0;
        if (!isEnd) still.sure.insert(still.sure.end(), part.vertices.begin(), part.vertices.end());
    }
    return still;
}

/// Whether a bone's joint is in its middle.
bool isAmidst(const FrameHolder& holder) {
    return (holder.box.center() - holder.joint).norm() < leastArm * holder.extent;
}

/// How far a place lies beyond a bone that moves, seen from its joint, 1: straight, -1: straight back. Where
/// the joint is in the middle of the bone, or the bone twists, how much nearer it is to it than to the
/// nearest bone that moves in fewer swings.
double beyond(const Vec3& place, std::size_t bone, const std::vector<FrameHolder>& holders) {
    const FrameHolder& holder = holders[bone];
    const Vec3 middle = holder.box.center(), arm = middle - holder.joint, way = place - holder.joint;
    if (!holder.twists && !isAmidst(holder)) return way.dot(arm) / std::max(way.norm() * arm.norm(), 1e-300);
    const FrameHolder* before = boneBefore(holders, bone);
    const Vec3 other = before ? before->box.center() : middle;
    return other == middle ? 1 : ((place - other).norm() - (place - middle).norm()) / (middle - other).norm();
}

/// Whether it may be one of a row: its joint is in its middle, and it bends against the one before.
bool isVertebra(const FrameHolder& holder) {
    return isAmidst(holder) && !holder.twists;
}

/// The bone that a part goes on from, as a hand does from a forearm: most of what is around it belongs to
/// bones that move, and it lies beyond that one of those that move in the fewest swings.
std::optional<std::size_t> goesOnFrom(const FreePart& part, const std::vector<FrameHolder>& holders) {
    if (part.small) return std::nullopt;
    std::size_t still = 0, all = 0, moves = ~std::size_t{0};
    for (const auto& [h, times] : part.beside) {
        all += times;
        if (holders[h].moves == 0)
            still += times;
        else
            moves = std::min(moves, holders[h].moves);
    }
    std::optional<std::size_t> from;
    for (const auto& [h, times] : part.beside) {
        if (holders[h].moves != moves || (from && times <= part.beside.at(*from))) continue;
        const bool nearer = holders[h].twists || isAmidst(holders[h]);
        if (beyond(part.ring, h, holders) >= (nearer ? 0 : aheadCosine)) from = h;
    }
    return 2 * still < all ? from : std::nullopt;
}

/// Whether a part is beside a row of vertebrae, as a trunk on both sides of it, and one that holds still; of
/// two bones alike each has half of what is around it, so a third is those that move.
bool isBesideRow(const FreePart& part, const std::vector<FrameHolder>& holders) {
    std::size_t still = 0, all = 0;
    for (const auto& [h, times] : part.beside) {
        all += times;
        if (holders[h].moves == 0)
            still += times;
        else if (!isVertebra(holders[h]))
            return false;
    }
    return !part.small && still > 0 && 3 * still < 2 * all;
}

/// Gives what of such a part is clearly between two bones of the row, or beyond its ends, to the one before.
void holdBesideRow(const FreePart& part, const std::vector<Vec3>& places, std::size_t still,
                   std::vector<FrameHolder>& holders) {
    std::vector<std::size_t> row{still};
    for (const auto& [h, times] : part.beside)
        if (holders[h].moves > 0) row.push_back(h);
    std::sort(row.begin() + 1, row.end(),
              [&](std::size_t a, std::size_t b) { return holders[a].moves < holders[b].moves; });
    for (const std::uint32_t v : part.vertices)
        for (std::size_t k = 0; k < row.size(); ++k)
            if ((k == 0 || beyond(places[v], row[k], holders) >= aheadCosine) &&
                (k + 1 == row.size() || beyond(places[v], row[k + 1], holders) <= -aheadCosine))
                holders[row[k]].holder.sure.push_back(v);
}

/// Gives a part to the bone that it goes on from, or else to what holds still. One beside other bones too is
/// claimed like all other skin, but for what is clearly on one side of a row of vertebrae.
void holdPart(const FreePart& part, const std::vector<Vec3>& places, std::size_t still,
              std::vector<FrameHolder>& holders) {
    if (isBesideRow(part, holders)) return holdBesideRow(part, places, still, holders);
    const std::optional<std::size_t> from = goesOnFrom(part, holders);
    if (from && part.beside.size() > 1) return;
    std::vector<std::uint32_t>& sure = holders[from.value_or(still)].holder.sure;
    sure.insert(sure.end(), part.vertices.begin(), part.vertices.end());
}

} // namespace

std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames) {
    std::vector<FrameHolder> holders;
    const int count = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()) + 1;
    for (int f = 0; f < count; ++f) holders.push_back(holderOf(ground, frames, f));
    setMotions(parameters, frames, holders);
    bool onSkin = false; // something moves with the skin itself
    for (std::size_t m = 0; m < frames.size(); ++m)
        onSkin |= frames[m] < 0 && !ground.bodies[m]->muscle().surface.empty();
    if (onSkin) {
        holders.push_back(holderOf(ground, frames, -1));
        holders.back().holder.size = infinity;
    }
    const auto still = [&](std::size_t h) { return holders[h].moves == 0; };
    std::size_t firstStill = 0;
    while (firstStill < holders.size() && !still(firstStill)) ++firstStill;
    const bool anyStill = firstStill < holders.size();
    const FreeParts free = freeParts(ground, holders, anyStill);
    for (const FreePart& part : free.parts)
        if (anyStill && !part.beside.empty()) holdPart(part, ground.skin.vertices, firstStill, holders);
    std::vector<SkinHolder> made;
    for (const FrameHolder& h : holders) made.push_back(h.holder);
    if (!anyStill) made.push_back(stillOf(holders, free));
    return made;
}

} // namespace tss
