#include "bake/respond/SkinParts.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"
#include "bake/respond/SkinSides.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {
namespace {

/// In sizes of a bone: skin beyond this is not its own, beside a bone that holds still: a chin is within it
/// of its teeth. Where bones are short and the body is thick, it is within twice the depth that the bone lies
/// at.
constexpr double farDistance = 1.5;
/// Where no bone holds still, skin this far from all bones does, ever less so up to them.
constexpr double stillDistance = 0.5;
/// In sizes of a bone: nearer to its joint its middle says nothing about where the bone goes.
constexpr double leastArm = 0.25;

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

/// Whether the straight way from a vertex to the bone leaves the body and goes in again elsewhere, as from
/// the belly to a leg. Out alone does not count: teeth are not inside of lips.
bool isBarred(const SkinGround& ground, const ClosestPointQuery& skin, const FrameHolder& holder,
              std::size_t v) {
    constexpr double away = 1e-3; // of the way, so that it does not begin in the skin
    const Vec3 &x = ground.skin.vertices[v], &to = holder.nearest[v];
    return skin.entered(x + away * (to - x), to) >= 0;
}

/// Marks those vertices that are apart from the bone: far from it, or the way is barred. far: scene units.
void markApart(const SkinGround& ground, const ClosestPointQuery& skin, double far, FrameHolder& holder) {
    holder.holder.apart.assign(ground.skin.vertices.size(), 1);
    parallelFor(holder.holder.apart.size(), [&](std::size_t v) {
        holder.holder.apart[v] = holder.holder.distance[v] > far || isBarred(ground, skin, holder, v);
    });
}

/// Skin that hangs together and is apart from all bones.
struct FreePart {
    std::vector<std::uint32_t> vertices;
    double area = 0;                           ///< scene units squared
    std::map<std::size_t, std::size_t> beside; ///< the holders nearest to what is around it, and to how much
    Vec3 ring = Vec3::Zero();                  ///< the middle of what is around it
    Eigen::AlignedBox3d box, around;           ///< its bounds, and those of what is around it
};

struct FreeParts {
    std::vector<FreePart> parts;
    std::vector<double> held; ///< #holders: the area of the skin that is not free and nearest to each
};

/// The share of what is around a part that belongs to bones that move.
double movingShare(const FreePart& part, const std::vector<FrameHolder>& holders) {
    double moving = 0, all = 0;
    for (const auto& [h, times] : part.beside) {
        all += static_cast<double>(times);
        if (holders[h].moves > 0) moving += static_cast<double>(times);
    }
    return moving / std::max(all, 1.0);
}

/// A hollow, as in a mouth, is no part of the body.
FreeParts freeParts(const SkinGround& ground, const ClosestPointQuery& skin,
                    std::vector<FrameHolder>& holders, bool anyStill) {
    const std::size_t count = ground.skin.vertices.size();
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
            part.box.extend(ground.skin.vertices[v]);
        }
    edges([&](std::size_t v, std::size_t next) {
        if (isFree[next]) return;
        FreePart& part = parts[sets.root(v)];
        ++part.beside[nearest[next]];
        part.ring += ground.skin.vertices[next];
        part.around.extend(ground.skin.vertices[next]);
    });
    for (auto& [root, part] : parts) {
        std::size_t around = 0;
        for (const auto& [h, times] : part.beside) around += times;
        if (around > 0) {
            if (part.box.diagonal().norm() <= part.around.diagonal().norm()) continue; // a hollow
            part.ring /= static_cast<double>(around);
        }
        made.parts.push_back(std::move(part));
    }
    return made;
}

void append(std::vector<std::uint32_t>& list, const std::vector<std::uint32_t>& more) {
    list.insert(list.end(), more.begin(), more.end());
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
        if (!isEnd) append(still.sure, part.vertices);
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
    std::size_t moves = ~std::size_t{0};
    for (const auto& [h, times] : part.beside)
        if (holders[h].moves > 0) moves = std::min(moves, holders[h].moves);
    std::optional<std::size_t> from;
    for (const auto& [h, times] : part.beside) {
        if (holders[h].moves != moves || (from && times <= part.beside.at(*from))) continue;
        const bool nearer = holders[h].twists || isAmidst(holders[h]);
        if (beyond(part.ring, h, holders) >= (nearer ? 0 : aheadCosine)) from = h;
    }
    return movingShare(part, holders) > 0.5 ? from : std::nullopt;
}

/// Whether a part is beside a row of vertebrae, as a trunk on both sides of it, and one that holds still; of
/// two bones alike each has half of what is around it, so a third is those that move.
bool isBesideRow(const FreePart& part, const std::vector<FrameHolder>& holders) {
    for (const auto& [h, times] : part.beside)
        if (holders[h].moves > 0 && !isVertebra(holders[h])) return false;
    const double moving = movingShare(part, holders);
    return moving < 1 && 3 * moving > 1;
}

/// Gives what of such a part is clearly between two bones of the row, or beyond its ends, to the one before.
void holdBesideRow(const FreePart& part, const std::vector<Vec3>& places, std::size_t still,
                   const std::vector<FrameHolder>& holders, std::vector<SkinHolder>& made) {
    std::vector<std::size_t> row{still};
    for (const auto& [h, times] : part.beside)
        if (holders[h].moves > 0) row.push_back(h);
    std::sort(row.begin() + 1, row.end(),
              [&](std::size_t a, std::size_t b) { return holders[a].moves < holders[b].moves; });
    for (const std::uint32_t v : part.vertices)
        for (std::size_t k = 0; k < row.size(); ++k)
            if ((k == 0 || beyond(places[v], row[k], holders) >= aheadCosine) &&
                (k + 1 == row.size() || beyond(places[v], row[k + 1], holders) <= -aheadCosine))
                made[row[k]].sure.push_back(v);
}

/// Gives a part to the bone that it goes on from, or else to what holds still. One beside other bones too is
/// claimed like all other skin.
void holdPart(const FreePart& part, std::size_t still, const std::vector<FrameHolder>& holders,
              std::vector<SkinHolder>& made) {
    const std::optional<std::size_t> from = goesOnFrom(part, holders);
    if (from && part.beside.size() > 1) return;
    append(made[from.value_or(still)].sure, part.vertices);
}

} // namespace

std::vector<SkinHolder> holdParts(const SkinGround& ground, std::vector<FrameHolder> holders,
                                  std::vector<std::vector<char>> moved) {
    std::size_t still = 0;
    while (still < holders.size() && holders[still].moves > 0) ++still;
    const bool anyStill = still < holders.size();
    const FreeParts free = freeParts(ground, ClosestPointQuery(ground.skin), holders, anyStill);
    std::vector<SkinHolder> made;
    for (const FrameHolder& h : holders) made.push_back(h.holder);
    if (!anyStill) made.push_back(stillOf(holders, free));
    for (std::vector<char>& group : moved) group.resize(made.size(), 0);
    const SkinSides sides(ground, made, moved);
    for (const FreePart& part : free.parts) {
        if (!anyStill || part.beside.empty()) continue;
        if (isBesideRow(part, holders))
            holdBesideRow(part, ground.skin.vertices, still, holders, made);
        else if (const std::optional<std::size_t> owner = sides.ownerOf(part.vertices))
            append(made[*owner].sure, part.vertices);
        else
            holdPart(part, still, holders, made);
    }
    sides.hold(made);
    return made;
}

} // namespace tss
