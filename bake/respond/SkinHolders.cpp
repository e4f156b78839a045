#include "bake/respond/SkinHolders.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"

#include <algorithm>
#include <map>
#include <set>

namespace tss {
namespace {

/// In sizes of a bone: skin beyond this is not its own, beside a bone that holds still: a chin is within it
/// of its teeth.
constexpr double farDistance = 1.5;
/// Where no bone holds still, skin this far from all bones does, ever less so up to them.
constexpr double stillDistance = 0.5;

struct FrameHolder {
    SkinHolder holder;
    std::vector<Vec3> nearest; ///< #V: where it is nearest
    double extent = 0;         ///< diagonal of its bounds
    bool moves = false;
};

/// The surfaces that stand for a frame: its bones, or its muscles where it has none.
FrameHolder holderOf(const SkinGround& ground, const std::vector<int>& frames, int frame) {
    const std::size_t count = ground.skin.vertices.size();
    FrameHolder made{{std::vector<double>(count, infinity), 0, {}}, ground.skin.vertices};
    Eigen::AlignedBox3d box;
    bool bones = false;
    for (std::size_t m = 0; m < frames.size(); ++m) bones |= frames[m] == frame && ground.bodies[m]->rigid();
    for (std::size_t m = 0; m < frames.size(); ++m) {
        if (frames[m] != frame || ground.bodies[m]->rigid() != bones) continue;
        box.extend(bounds(ground.bodies[m]->muscle().surface));
        parallelFor(count, [&](std::size_t v) {
            double& distance = made.holder.distance[v];
            const NearestPoint near = ground.locators[m].nearest(ground.skin.vertices[v], distance);
            if (near.triangle < 0) return;
            distance = near.distance;
            made.nearest[v] = near.point;
        });
    }
    made.extent = box.isEmpty() ? 0 : box.diagonal().norm();
    made.holder.size = made.extent;
    return made;
}

/// Frames that move somewhere along the swings.
void setMoving(const SkinParameters& p, const std::vector<int>& frames, std::vector<FrameHolder>& holders) {
    for (FrameHolder& holder : holders) holder.moves = p.swings.empty();
    for (const BoneSwing& swing : p.swings)
        for (const std::vector<Pose>& station : swing)
            for (std::size_t m = 0; m < station.size(); ++m)
                if (frames[m] >= 0 && station[m].matrix() != Pose::Identity().matrix())
                    holders[static_cast<std::size_t>(frames[m])].moves = true;
}

/// The nearest to each vertex.
std::vector<std::size_t> nearestOf(const std::vector<FrameHolder>& holders, std::size_t count) {
    std::vector<std::size_t> nearest(count, 0);
    for (std::size_t v = 0; v < count; ++v)
        for (std::size_t h = 1; h < holders.size(); ++h)
            if (holders[h].holder.distance[v] < holders[nearest[v]].holder.distance[v]) nearest[v] = h;
    return nearest;
}

/// Whether the skin is wound inwards: bones are inside.
bool isInverted(const SkinGround& ground, const std::vector<FrameHolder>& holders,
                const std::vector<std::size_t>& nearest) {
    double sum = 0;
    for (std::size_t v = 0; v < nearest.size(); ++v) {
        const Vec3 way = ground.skin.vertices[v] - holders[nearest[v]].nearest[v];
        sum += ground.graph.area[v] * way.normalized().dot(ground.normals[v]);
    }
    return sum < 0;
}

/// Leaves those vertices marked that are apart from the bone too: far from it, or the straight way to it
/// leaves the body and goes in again elsewhere, as from the belly to a leg. Out alone does not count: teeth
/// are not inside of lips. far: in sizes of the bone.
void markApart(const SkinGround& ground, const ClosestPointQuery& skin, bool inverted,
               const FrameHolder& holder, double far, std::vector<char>& apart) {
    constexpr double away = 1e-3; // of the way, so that it does not begin in the skin
    parallelFor(apart.size(), [&](std::size_t v) {
        if (!apart[v] || holder.holder.distance[v] > far * holder.extent) return;
        const Vec3 &x = ground.skin.vertices[v], &to = holder.nearest[v];
        const Vec3 from = x + away * (to - x);
        apart[v] = (inverted ? skin.entered(to, from) : skin.entered(from, to)) >= 0;
    });
}

/// Skin that hangs together and is apart from all bones.
struct FreePart {
    std::vector<std::uint32_t> vertices;
    double area = 0;              ///< scene units squared
    std::set<std::size_t> beside; ///< the holders nearest to what is around it
};

struct FreeParts {
    std::vector<FreePart> parts;
    std::vector<double> held; ///< #holders: the area of the skin that is not free and nearest to each
};

/// far: in sizes of a bone.
FreeParts freeParts(const SkinGround& ground, const std::vector<FrameHolder>& holders, double far) {
    const std::size_t count = ground.skin.vertices.size();
    const std::vector<std::size_t> nearest = nearestOf(holders, count);
    const bool inverted = isInverted(ground, holders, nearest);
    const ClosestPointQuery skin(ground.skin);
    std::vector<char> isFree(count, 1);
    for (const FrameHolder& h : holders) markApart(ground, skin, inverted, h, far, isFree);
    FreeParts made{{}, std::vector<double>(holders.size(), 0)};
    for (std::size_t v = 0; v < count; ++v)
        if (!isFree[v]) made.held[nearest[v]] += ground.graph.area[v];
    UnionFind sets(count);
    const auto edges = [&](const auto& visit) {
        for (std::size_t v = 0; v < count; ++v)
            for (auto e = ground.graph.start[v]; e < ground.graph.start[v + 1]; ++e)
                if (isFree[v]) visit(v, ground.graph.neighbour[e]);
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
        if (!isFree[next]) parts[sets.root(v)].beside.insert(nearest[next]);
    });
    for (auto& [root, part] : parts) made.parts.push_back(std::move(part));
    return made;
}

/// What holds still though no bone does: the skin far from all bones.
SkinHolder stillOf(const std::vector<FrameHolder>& holders, const FreeParts& free) {
    SkinHolder still{std::vector<double>(holders[0].holder.distance.size(), 0), infinity, {}};
    double longest = 0;
    for (const FrameHolder& h : holders) {
        longest = std::max(longest, stillDistance * h.extent);
        for (std::size_t v = 0; v < still.distance.size(); ++v)
            still.distance[v] = std::max(still.distance[v], stillDistance * h.extent - h.holder.distance[v]);
    }
    for (const FreePart& part : free.parts) {
        const bool isEnd = part.beside.size() == 1 && part.area < free.held[*part.beside.begin()];
        for (const std::uint32_t v : part.vertices) still.distance[v] = isEnd ? longest : 0;
        if (!isEnd) still.sure.insert(still.sure.end(), part.vertices.begin(), part.vertices.end());
    }
    return still;
}

} // namespace

std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames) {
    std::vector<FrameHolder> holders;
    const int count = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()) + 1;
    for (int f = 0; f < count; ++f) holders.push_back(holderOf(ground, frames, f));
    setMoving(parameters, frames, holders);
    bool onSkin = false; // something moves with the skin itself
    for (std::size_t m = 0; m < frames.size(); ++m)
        onSkin |= frames[m] < 0 && !ground.bodies[m]->muscle().surface.empty();
    if (onSkin) {
        holders.push_back(holderOf(ground, frames, -1));
        holders.back().holder.size = infinity;
    }
    const auto still = [&](std::size_t h) { return !holders[h].moves; };
    std::size_t firstStill = 0;
    while (firstStill < holders.size() && !still(firstStill)) ++firstStill;
    const bool anyStill = firstStill < holders.size();
    const FreeParts free = freeParts(ground, holders, anyStill ? farDistance : stillDistance);
    for (const FreePart& part : free.parts)
        if (anyStill &&
            (part.beside.size() > 1 || std::any_of(part.beside.begin(), part.beside.end(), still))) {
            std::vector<std::uint32_t>& sure = holders[firstStill].holder.sure;
            sure.insert(sure.end(), part.vertices.begin(), part.vertices.end());
        }
    std::vector<SkinHolder> made;
    for (const FrameHolder& h : holders) made.push_back(h.holder);
    if (!anyStill) made.push_back(stillOf(holders, free));
    return made;
}

} // namespace tss
