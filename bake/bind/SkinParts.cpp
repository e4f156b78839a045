#include "bake/bind/SkinParts.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"

#include <algorithm>
#include <map>
#include <optional>

namespace tss {
namespace {

/// In diagonals of a bone: skin farther away is not the bone's, if there is a bone that never moves. A chin
/// is nearer to its teeth than that. For short bones deep in a thick body the limit is twice their depth.
constexpr double farDistance = 1.5;
/// In diagonals of a bone: if all bones move, skin farther than this from all of them stays at rest; nearer,
/// ever less so.
constexpr double stillDistance = 0.5;
/// In diagonals of a bone: with its joint nearer to its centre than this, the direction from joint to centre
/// means nothing.
constexpr double leastArm = 0.25;

/// The nearest influence to each vertex, preferring those that it is not excluded from.
std::vector<std::size_t> nearestOf(const std::vector<FrameInfluence>& influences, std::size_t count) {
    std::vector<std::size_t> nearest(count, 0);
    const auto less = [&](std::size_t v, std::size_t a, std::size_t b) {
        const bool excludedA =
                       !influences[a].influence.excluded.empty() && influences[a].influence.excluded[v],
                   excludedB =
                       !influences[b].influence.excluded.empty() && influences[b].influence.excluded[v];
        return excludedA != excludedB
                   ? excludedB
                   : influences[a].influence.distance[v] < influences[b].influence.distance[v];
    };
    for (std::size_t v = 0; v < count; ++v)
        for (std::size_t h = 1; h < influences.size(); ++h)
            if (less(v, h, nearest[v])) nearest[v] = h;
    return nearest;
}

/// Depth of the deepest vertex of a frame's bodies below the skin, scene units.
double depthOf(const SkinAnatomy& anatomy, const ClosestPointQuery& skin, const FrameInfluence& frame) {
    double deepest = 0;
    for (const std::size_t m : frame.bodies) {
        const std::vector<Vec3>& places = anatomy.bodies[m]->muscle().surface.vertices;
        std::vector<double> depth(places.size(), 0);
        parallelFor(places.size(), [&](std::size_t v) {
            const NearestPoint near = skin.nearest(places[v], infinity);
            const Vec3 normal = anatomy.normals[anatomy.skin.triangles[near.triangle][0]];
            if ((places[v] - near.point).dot(normal) < 0) depth[v] = near.distance;
        });
        for (const double d : depth) deepest = std::max(deepest, d);
    }
    return deepest;
}

/// Whether the straight line from a vertex to the nearest point of the bone re-enters the body, as from the
/// belly to a leg. Leaving it alone does not count: teeth are outside of the lips.
bool isOccluded(const SkinAnatomy& anatomy, const ClosestPointQuery& skin, const FrameInfluence& frame,
                std::size_t v) {
    constexpr double away = 1e-3; // of the line, so that it does not start on the skin itself
    const Vec3 &x = anatomy.skin.vertices[v], &to = frame.nearest[v];
    return skin.entered(x + away * (to - x), to) >= 0;
}

/// Excludes vertices from the bone that are farther away than `far` (scene units), or occluded.
void markExcluded(const SkinAnatomy& anatomy, const ClosestPointQuery& skin, double far,
                  FrameInfluence& frame) {
    frame.influence.excluded.assign(anatomy.skin.vertices.size(), 1);
    parallelFor(frame.influence.excluded.size(), [&](std::size_t v) {
        frame.influence.excluded[v] =
            frame.influence.distance[v] > far || isOccluded(anatomy, skin, frame, v);
    });
}

/// A connected part of the skin whose vertices are excluded from all bones.
struct FreePart {
    std::vector<std::uint32_t> vertices;
    double area = 0; ///< scene units squared
    /// Influences nearest to the vertices around the part, with the number of edges that lead there.
    std::map<std::size_t, std::size_t> neighbours;
    Vec3 rimCentre = Vec3::Zero(); ///< mean position of the vertices around it
    Eigen::AlignedBox3d box;       ///< bounds of its vertices
    Eigen::AlignedBox3d rimBox;    ///< bounds of the vertices around it
};

struct FreeParts {
    std::vector<FreePart> parts;
    std::vector<double> ownedArea; ///< #influences: area outside of all parts that each is nearest to
};

/// The share of a part's neighbours that are bones that move.
double movingShare(const FreePart& part, const std::vector<FrameInfluence>& influences) {
    double moving = 0, all = 0;
    for (const auto& [h, times] : part.neighbours) {
        all += static_cast<double>(times);
        if (influences[h].moves > 0) moving += static_cast<double>(times);
    }
    return moving / std::max(all, 1.0);
}

/// Finds the parts, and excludes their vertices from the bones. A hollow, a part within the bounds of its rim
/// such as a mouth, is left out.
FreeParts freeParts(const SkinAnatomy& anatomy, const ClosestPointQuery& skin,
                    std::vector<FrameInfluence>& influences, bool anyStill) {
    const std::size_t count = anatomy.skin.vertices.size();
    std::vector<char> isFree(count, 1);
    for (FrameInfluence& h : influences) {
        const double far = anyStill ? std::max(farDistance * h.extent, 2 * depthOf(anatomy, skin, h))
                                    : stillDistance * h.extent;
        markExcluded(anatomy, skin, far, h);
        for (std::size_t v = 0; v < count; ++v) isFree[v] = isFree[v] && h.influence.excluded[v];
    }
    const std::vector<std::size_t> nearest = nearestOf(influences, count);
    FreeParts made{{}, std::vector<double>(influences.size(), 0)};
    for (std::size_t v = 0; v < count; ++v)
        if (!isFree[v]) made.ownedArea[nearest[v]] += anatomy.graph.area[v];
    UnionFind sets(count);
    const auto edges = [&](const auto& visit) {
        for (std::size_t v = 0; v < count; ++v)
            for (const SkinGraph::Edge& edge : anatomy.graph.edges[v])
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
            part.area += anatomy.graph.area[v];
            part.box.extend(anatomy.skin.vertices[v]);
        }
    edges([&](std::size_t v, std::size_t next) {
        if (isFree[next]) return;
        FreePart& part = parts[sets.root(v)];
        ++part.neighbours[nearest[next]];
        part.rimCentre += anatomy.skin.vertices[next];
        part.rimBox.extend(anatomy.skin.vertices[next]);
    });
    for (auto& [root, part] : parts) {
        std::size_t around = 0;
        for (const auto& [h, times] : part.neighbours) around += times;
        if (around > 0) {
            if (part.box.diagonal().norm() <= part.rimBox.diagonal().norm()) continue; // a hollow
            part.rimCentre /= static_cast<double>(around);
        }
        made.parts.push_back(std::move(part));
    }
    return made;
}

void append(std::vector<std::uint32_t>& list, const std::vector<std::uint32_t>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

/// The influence that never moves, if all bones move: on skin far from all bones.
SkinInfluence restInfluence(const std::vector<FrameInfluence>& influences, const FreeParts& free) {
    SkinInfluence still{std::vector<double>(influences[0].influence.distance.size(), 0), infinity, {}, {}};
    double longest = 0;
    for (const FrameInfluence& h : influences) {
        longest = std::max(longest, 2 * stillDistance * h.extent);
        for (std::size_t v = 0; v < still.distance.size();
             ++v) // so that at stillDistance both are equally near
            still.distance[v] =
                std::max(still.distance[v], 2 * stillDistance * h.extent - h.influence.distance[v]);
    }
    for (const FreePart& part : free.parts) {
        const bool isEnd =
            part.neighbours.size() == 1 && part.area < free.ownedArea[part.neighbours.begin()->first];
        for (const std::uint32_t v : part.vertices) still.distance[v] = isEnd ? longest : 0;
        if (!isEnd) append(still.certain, part.vertices);
    }
    return still;
}

/// Whether a bone's joint is near the bone's centre.
bool hasCentralJoint(const FrameInfluence& frame) {
    return (frame.box.center() - frame.joint).norm() < leastArm * frame.extent;
}

/// How well a place continues a moving bone, in [-1, 1]: the cosine of the angle, seen from the joint,
/// between the directions to the place and to the bone's centre. For a bone with a central joint, or one that
/// twists: by how much the place is nearer to it than to its parent, as a share of the distance between the
/// two.
double continuation(const Vec3& place, std::size_t bone, const std::vector<FrameInfluence>& influences) {
    const FrameInfluence& frame = influences[bone];
    const Vec3 middle = frame.box.center(), arm = middle - frame.joint, way = place - frame.joint;
    if (!frame.twists && !hasCentralJoint(frame))
        return way.dot(arm) / std::max(way.norm() * arm.norm(), 1e-300);
    const FrameInfluence* parent = parentBone(influences, bone);
    const Vec3 other = parent ? parent->box.center() : middle;
    return other == middle ? 1 : ((place - other).norm() - (place - middle).norm()) / (middle - other).norm();
}

/// Whether a bone may be a vertebra of a row: its joint is central, and it bends rather than twists.
bool isVertebra(const FrameInfluence& frame) {
    return hasCentralJoint(frame) && !frame.twists;
}

/// The bone that a part continues, as a hand does a forearm: moving bones have most of its neighbourhood, and
/// of those nearest to the root of the hierarchy this is the one with most of it that the part lies beyond.
std::optional<std::size_t> continuedBone(const FreePart& part,
                                         const std::vector<FrameInfluence>& influences) {
    std::size_t moves = ~std::size_t{0};
    for (const auto& [h, times] : part.neighbours)
        if (influences[h].moves > 0) moves = std::min(moves, influences[h].moves);
    std::optional<std::size_t> from;
    for (const auto& [h, times] : part.neighbours) {
        if (influences[h].moves != moves || (from && times <= part.neighbours.at(*from))) continue;
        const bool byDistance = influences[h].twists || hasCentralJoint(influences[h]);
        if (continuation(part.rimCentre, h, influences) >= (byDistance ? 0 : aheadCosine)) from = h;
    }
    return movingShare(part, influences) > 0.5 ? from : std::nullopt;
}

/// Whether a part, such as a trunk, borders on vertebrae and on bones that never move, the vertebrae having
/// more than a third of its neighbourhood: of two like bones each has half of it.
bool isBesideVertebrae(const FreePart& part, const std::vector<FrameInfluence>& influences) {
    for (const auto& [h, times] : part.neighbours)
        if (influences[h].moves > 0 && !isVertebra(influences[h])) return false;
    const double moving = movingShare(part, influences);
    return moving < 1 && 3 * moving > 1;
}

/// Assigns vertices of such a part that are clearly between two bones of the row, or beyond its ends, to the
/// one before them in the hierarchy.
void assignBesideVertebrae(const FreePart& part, const std::vector<Vec3>& places, std::size_t still,
                           const std::vector<FrameInfluence>& influences, std::vector<SkinInfluence>& made) {
    std::vector<std::size_t> row{still};
    for (const auto& [h, times] : part.neighbours)
        if (influences[h].moves > 0) row.push_back(h);
    std::sort(row.begin() + 1, row.end(),
              [&](std::size_t a, std::size_t b) { return influences[a].moves < influences[b].moves; });
    for (const std::uint32_t v : part.vertices)
        for (std::size_t k = 0; k < row.size(); ++k)
            if ((k == 0 || continuation(places[v], row[k], influences) >= aheadCosine) &&
                (k + 1 == row.size() || continuation(places[v], row[k + 1], influences) <= -aheadCosine))
                made[row[k]].certain.push_back(v);
}

/// Assigns a part to the bone that it continues, or else to an influence that never moves, if it may be
/// attached to one of these, or else to the nearest that it may be attached to. If it continues one and has
/// other neighbours too, it is left to be claimed like all other skin.
void assignPart(const FreePart& part, std::size_t still, const std::vector<std::size_t>& owners,
                const std::vector<FrameInfluence>& influences, std::vector<SkinInfluence>& made) {
    const std::optional<std::size_t> from = continuedBone(part, influences);
    if (from && part.neighbours.size() > 1) return;
    const auto resting =
        std::ranges::find_if(owners, [&](std::size_t h) { return influences[h].moves == 0; });
    const std::size_t other = resting != owners.end() ? *resting : owners.empty() ? still : owners.front();
    append(made[from.value_or(other)].certain, part.vertices);
}

} // namespace

std::vector<SkinInfluence> assignParts(const SkinAnatomy& anatomy, std::vector<FrameInfluence> influences,
                                       std::vector<MovedGroup> groups) {
    std::size_t still = 0;
    while (still < influences.size() && influences[still].moves > 0) ++still;
    const bool anyStill = still < influences.size();
    const FreeParts free = freeParts(anatomy, ClosestPointQuery(anatomy.skin), influences, anyStill);
    std::vector<SkinInfluence> made;
    for (const FrameInfluence& h : influences) made.push_back(h.influence);
    if (!anyStill) made.push_back(restInfluence(influences, free));
    for (MovedGroup& group : groups) group.moved.resize(made.size(), 0);
    const SkinSides sides(anatomy, made, groups);
    for (const FreePart& part : free.parts) {
        if (!anyStill || part.neighbours.empty()) continue;
        if (isBesideVertebrae(part, influences)) {
            assignBesideVertebrae(part, anatomy.skin.vertices, still, influences, made);
            continue;
        }
        const std::vector<std::size_t> owners = sides.ownersOf(part.vertices);
        if (owners.size() == 1)
            append(made[owners.front()].certain, part.vertices);
        else
            assignPart(part, still, owners, influences, made);
    }
    sides.assignCertain(made);
    return made;
}

} // namespace tss
