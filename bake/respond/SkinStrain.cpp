#include "bake/respond/SkinStrain.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {
namespace {

constexpr int pressedRounds = 16;   ///< in which contacts have their say
constexpr int freeRounds = 200;     ///< at most, after them
constexpr double leastCosine = 0.1; ///< of a triangle's normal with itself at rest
constexpr double relaxation = 1.6;  ///< of what a link gives up: neighbours give back
constexpr int halvings = 8;         ///< of the share of its motion that a triangle keeps
constexpr double pressShare = 0.5;  ///< of the depth in a contact that a round takes away

void index(std::size_t vertices, std::size_t count, int corners, const auto& corner,
           std::vector<std::uint32_t>& start, std::vector<std::uint32_t>& of) {
    start.assign(vertices + 1, 0);
    for (std::size_t e = 0; e < count; ++e)
        for (int k = 0; k < corners; ++k) ++start[corner(e, k) + 1];
    for (std::size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
    of.resize(start.back());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::size_t e = 0; e < count; ++e)
        for (int k = 0; k < corners; ++k) of[next[corner(e, k)]++] = static_cast<std::uint32_t>(e);
}

inline Vec3 areaNormal(std::span<const Vec3> x, const Tri& t) {
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

} // namespace

SkinWeave makeWeave(const std::vector<Vec3>& rest, const std::vector<Tri>& triangles,
                    const std::vector<float>& inverseMass) {
    SkinWeave weave;
    std::map<std::pair<int, int>, bool> edges;
    for (const Tri& t : triangles) {
        if (!(inverseMass[t[0]] > 0) && !(inverseMass[t[1]] > 0) && !(inverseMass[t[2]] > 0)) continue;
        for (int k = 0; k < 3; ++k) edges[std::minmax(t[k], t[(k + 1) % 3])] = true;
        const Vec3 normal = areaNormal(rest, t);
        if (!(normal.squaredNorm() > 0)) continue;
        weave.triangles.push_back(t);
        weave.normals.push_back(normal);
    }
    for (const auto& [edge, used] : edges) {
        const auto [i, j] = edge;
        const double squared = (rest[i] - rest[j]).squaredNorm();
        const float mass = inverseMass[i] + inverseMass[j];
        if (!(squared > 0) || !(mass > 0)) continue;
        weave.links.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), squared,
                               inverseMass[i] / mass, inverseMass[j] / mass});
    }
    index(
        rest.size(), weave.links.size(), 2,
        [&](std::size_t e, int k) { return k == 0 ? weave.links[e].i : weave.links[e].j; }, weave.linkStart,
        weave.linkOf);
    index(
        rest.size(), weave.triangles.size(), 3,
        [&](std::size_t e, int k) { return static_cast<std::uint32_t>(weave.triangles[e][k]); },
        weave.triangleStart, weave.triangleOf);
    return weave;
}

SkinStrain::SkinStrain(const SkinWeave& weave)
    : weave_(weave), linkRound_(weave.links.size(), 0), triangleRound_(weave.triangles.size(), 0),
      vertexRound_(weave.linkStart.empty() ? 0 : weave.linkStart.size() - 1, 0) {}

void SkinStrain::touch(std::uint32_t vertex) {
    if (vertexRound_[vertex] == round_) return;
    vertexRound_[vertex] = round_;
    moved_.push_back(vertex);
}

/// With d the edge at rest, turned, and m the difference of the displacements: the largest s in [0, 1] for
/// which |d + s m| is within the limits. s = 0 always is.
bool SkinStrain::relaxLink(const SkinLink& link, std::span<const Vec3> rest, const SkinTurn& turn,
                           std::span<Vec3> positions) const {
    constexpr double low2 = shortestEdge * shortestEdge, high2 = longestEdge * longestEdge;
    constexpr double allowed2 = (1 - slack) * (1 - slack), beyond2 = (1 + slack) * (1 + slack);
    const double now = (positions[link.i] - positions[link.j]).squaredNorm();
    if (now >= allowed2 * low2 * link.squared && now <= beyond2 * high2 * link.squared) return false;
    const double low = low2 * link.squared, high = high2 * link.squared;
    const std::uint32_t ends[] = {link.i, link.j};
    Vec3 d = rest[link.i] - rest[link.j];
    if (!turn.none()) d = turn.of(ends) * d;
    const Vec3 m = positions[link.i] - positions[link.j] - d;
    const double mm = m.squaredNorm(), md = m.dot(d), limit = now > high ? high : low;
    // mm s^2 + 2 md s + dd - limit = 0; too long: the root from inside, too short: the first one met from 0.
    const double root = std::sqrt(std::max(0.0, md * md - mm * (link.squared - limit)));
    const double s = std::clamp(now > high ? (root - md) / mm : (-md - root) / mm, 0.0, 1.0);
    const Vec3 give = std::min(1.0, relaxation * (1 - s)) * m;
    positions[link.i] -= static_cast<double>(link.shareI) * give;
    positions[link.j] += static_cast<double>(link.shareJ) * give;
    return true;
}

/// The same with the largest s for which the triangle is not turned over.
bool SkinStrain::relaxTriangle(std::uint32_t index, std::span<const Vec3> rest, const SkinTurn& turn,
                               std::span<Vec3> positions) const {
    const Tri& t = weave_.triangles[index];
    const std::uint32_t corners[] = {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                                     static_cast<std::uint32_t>(t[2])};
    const Eigen::Quaterniond turned = turn.of(corners);
    Vec3 before = weave_.normals[index];
    if (!turn.none()) before = turned * before;
    const auto lies = [&](const Vec3& now) {
        const double along = now.dot(before);
        return along > 0 &&
               along * along >= leastCosine * leastCosine * now.squaredNorm() * before.squaredNorm();
    };
    if (lies(areaNormal(positions, t))) return false;
    Vec3 mean = Vec3::Zero(), shape[3], moved[3];
    for (int k = 0; k < 3; ++k) {
        shape[k] = turned * rest[t[k]];
        mean += (positions[t[k]] - shape[k]) / 3;
    }
    for (int k = 0; k < 3; ++k) moved[k] = positions[t[k]] - shape[k] - mean;
    const Vec3 a = shape[1] - shape[0], b = shape[2] - shape[0], da = moved[1] - moved[0],
               db = moved[2] - moved[0];
    double s = 0, over = 1;
    for (int i = 0; i < halvings; ++i) {
        const double middle = (s + over) / 2;
        (lies((a + middle * da).cross(b + middle * db)) ? s : over) = middle;
    }
    const double keep = std::max(0.0, 1 - relaxation * (1 - s));
    for (int k = 0; k < 3; ++k) positions[t[k]] = shape[k] + mean + keep * moved[k];
    return true;
}

void SkinStrain::press(std::span<const SheetPlane> planes, std::span<const std::uint32_t> patch,
                       std::span<const Vec3> rest, std::span<const Move> without, const SkinTurn& turn,
                       std::span<Vec3> positions) {
    for (const SheetPlane& p : planes) {
        if (!p.used()) continue;
        const std::array<std::uint32_t, 3> corners = cornersOf(p, patch);
        bool near = false;
        for (const std::uint32_t v : corners) near = near || vertexRound_[v] == round_;
        if (!near) continue;
        const Vec3 normal = turn.of(corners) * p.normal.head<3>().cast<double>();
        // As deep as the solve has left it it may stay: else it would jump out as soon as an edge nearby is
        // beyond its limits.
        double gap = p.compliance * p.multiplier - p.bound, weights = 0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = corners[k];
            gap += static_cast<double>(p.weight[k]) *
                   normal.dot(positions[v] - rest[v] - without[v].head<3>().cast<double>());
            weights += static_cast<double>(p.weight[k] * p.weight[k]);
        }
        if (gap >= 0 || !(weights > 0)) continue;
        for (int k = 0; k < 3; ++k) {
            if (p.weight[k] == 0) continue;
            positions[corners[k]] -= (pressShare * gap * static_cast<double>(p.weight[k]) / weights) * normal;
            touch(corners[k]);
        }
    }
}

/// What meets at a vertex that moved in this round is looked at in the next.
void SkinStrain::gather() {
    links_.clear();
    triangles_.clear();
    for (const std::uint32_t v : moved_) {
        for (std::uint32_t k = weave_.linkStart[v]; k < weave_.linkStart[v + 1]; ++k) {
            const std::uint32_t e = weave_.linkOf[k];
            if (linkRound_[e] == round_) continue;
            linkRound_[e] = round_;
            links_.push_back(e);
        }
        for (std::uint32_t k = weave_.triangleStart[v]; k < weave_.triangleStart[v + 1]; ++k) {
            const std::uint32_t e = weave_.triangleOf[k];
            if (triangleRound_[e] == round_) continue;
            triangleRound_[e] = round_;
            triangles_.push_back(e);
        }
    }
}

std::size_t SkinStrain::relax(std::span<const Vec3> rest, std::span<const SheetPlane> planes,
                              std::span<const std::uint32_t> patch, std::span<const Move> without,
                              const SkinTurn& turn, std::span<Vec3> positions) {
    std::fill(vertexRound_.begin(), vertexRound_.end(), 0);
    std::fill(linkRound_.begin(), linkRound_.end(), 0);
    std::fill(triangleRound_.begin(), triangleRound_.end(), 0);
    std::size_t beyond = 0;
    for (int round = 0; round < pressedRounds + freeRounds; ++round) {
        round_ = static_cast<std::uint32_t>(round + 1);
        moved_.clear();
        beyond = 0;
        const auto link = [&](std::uint32_t e) {
            if (!relaxLink(weave_.links[e], rest, turn, positions)) return;
            ++beyond;
            touch(weave_.links[e].i);
            touch(weave_.links[e].j);
        };
        const auto triangle = [&](std::uint32_t e) {
            if (!relaxTriangle(e, rest, turn, positions)) return;
            ++beyond;
            for (int k = 0; k < 3; ++k) touch(static_cast<std::uint32_t>(weave_.triangles[e][k]));
        };
        if (round == 0) {
            for (std::uint32_t e = 0; e < weave_.links.size(); ++e) link(e);
            for (std::uint32_t e = 0; e < weave_.triangles.size(); ++e) triangle(e);
        } else {
            for (const std::uint32_t e : links_) link(e);
            for (const std::uint32_t e : triangles_) triangle(e);
        }
        if (moved_.empty()) break;
        if (round < pressedRounds) press(planes, patch, rest, without, turn, positions);
        gather();
    }
    return beyond;
}

} // namespace tss
