#include "bake/respond/SkinStrain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace tss {
namespace {

constexpr int pressedRounds = 16;  ///< in which contacts have their say
constexpr int freeRounds = 200;    ///< at most, after them
constexpr double relaxation = 1.6; ///< of what a link gives up: neighbours give back
constexpr int halvings = 8;        ///< of the share of its motion that a triangle keeps
constexpr double pressShare = 0.5; ///< of the depth in a contact that a round takes away

std::size_t wordsFor(std::size_t bits) {
    return (bits + 63) / 64;
}

/// Visits the bits that are set, rising; a visit may set others.
void forEachBit(const std::vector<std::uint64_t>& words, const auto& visit) {
    for (std::size_t w = 0; w < words.size(); ++w) {
        std::uint64_t passed = 0;
        while (const std::uint64_t left = words[w] & ~passed) {
            const int bit = std::countr_zero(left);
            passed = (std::uint64_t{2} << bit) - 1;
            visit(static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(bit));
        }
    }
}

void setBit(std::vector<std::uint64_t>& words, std::uint32_t bit) {
    words[bit / 64] |= std::uint64_t{1} << (bit % 64);
}

} // namespace

SkinStrain::SkinStrain(const SkinWeave& weave, KernelTarget target)
    : weave_(weave), kernels_(skinKernels(target)),
      places_(weave.linkStart.empty() ? 0 : weave.linkStart.size() - 1, SkinPlace::Zero()),
      linkMarks_(wordsFor(weave.links.size())), triangleMarks_(wordsFor(weave.triangles.size())),
      linkRound_(weave.links.size(), 0), triangleRound_(weave.triangles.size(), 0),
      vertexRound_(places_.size(), 0) {}

bool SkinStrain::touch(std::uint32_t vertex) {
    if (vertexRound_[vertex] == round_) return false;
    vertexRound_[vertex] = round_;
    moved_.push_back(vertex);
    return true;
}

/// With d the edge at rest, turned, and m the difference of the displacements: the largest s in [0, 1] for
/// which |d + s m| is within the limits. s = 0 always is.
bool SkinStrain::relaxLink(std::uint32_t index, std::span<const Vec3> rest, const SkinTurn& turn,
                           std::span<Vec3> positions) const {
    const SkinLink& link = weave_.links[index];
    const double now = (positions[link.i] - positions[link.j]).squaredNorm();
    const double squared = weave_.squared[index];
    if (strain::within(now, squared)) return false;
    const double low = strain::low2 * squared, high = strain::high2 * squared;
    const std::uint32_t ends[] = {link.i, link.j};
    Vec3 d = rest[link.i] - rest[link.j];
    if (!turn.none()) d = turn.of(ends) * d;
    const Vec3 m = positions[link.i] - positions[link.j] - d;
    const double mm = m.squaredNorm(), md = m.dot(d), limit = now > high ? high : low;
    // mm s^2 + 2 md s + dd - limit = 0; too long: the root from inside, too short: the first one met from 0.
    const double root = std::sqrt(std::max(0.0, md * md - mm * (squared - limit)));
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
    SkinPlace before = weave_.normals[index];
    if (!turn.none()) before.head<3>() = turned * before.head<3>().eval();
    if (strain::lies(areaNormal(positions, t), before)) return false;
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
        (strain::lies((a + middle * da).cross(b + middle * db), before) ? s : over) = middle;
    }
    const double keep = std::max(0.0, 1 - relaxation * (1 - s));
    for (int k = 0; k < 3; ++k) positions[t[k]] = shape[k] + mean + keep * moved[k];
    return true;
}

void SkinStrain::listPresses(std::span<const SheetPlane> planes, std::span<const std::uint32_t> patch) {
    presses_.clear();
    pressStart_.assign(places_.size() + 1, 0);
    for (std::uint32_t i = 0; i < planes.size(); ++i) {
        if (!planes[i].used()) continue;
        presses_.push_back({i, cornersOf(planes[i], patch)});
        for (const std::uint32_t v : presses_.back().corners) ++pressStart_[v];
    }
    // From counts to ends, and while they are filled from the back to starts.
    std::partial_sum(pressStart_.begin(), pressStart_.end(), pressStart_.begin());
    pressOf_.resize(pressStart_.back());
    for (std::size_t i = presses_.size(); i-- > 0;)
        for (const std::uint32_t v : presses_[i].corners)
            pressOf_[--pressStart_[v]] = static_cast<std::uint32_t>(i);
}

/// Of the contacts of what moved in this round, and what they move in turn.
void SkinStrain::press(std::span<const SheetPlane> planes, std::span<const Vec3> rest,
                       std::span<const Move> without, const SkinTurn& turn, std::span<Vec3> positions) {
    pressMarks_.assign(wordsFor(presses_.size()), 0);
    const auto mark = [&](std::uint32_t v) {
        for (std::uint32_t k = pressStart_[v]; k < pressStart_[v + 1]; ++k) setBit(pressMarks_, pressOf_[k]);
    };
    for (const std::uint32_t v : moved_) mark(v);
    forEachBit(pressMarks_, [&](std::uint32_t i) {
        const Press& press = presses_[i];
        const std::array<std::uint32_t, 3>& corners = press.corners;
        const SheetPlane& p = planes[press.plane];
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
        if (gap >= 0 || !(weights > 0)) return;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = corners[k];
            if (p.weight[k] == 0) continue;
            positions[v] -= (pressShare * gap * static_cast<double>(p.weight[k]) / weights) * normal;
            if (touch(v)) mark(v);
        }
    });
}

/// Marks what the first round has to look at: what is beyond its limits, to begin with.
void SkinStrain::survey(const SkinTurn& turn, std::span<const Vec3> positions) {
    for (std::size_t v = 0; v < places_.size(); ++v) places_[v].head<3>() = positions[v];
    std::fill(linkMarks_.begin(), linkMarks_.end(), 0);
    std::fill(triangleMarks_.begin(), triangleMarks_.end(), 0);
    kernels_.links(weave_, places_.data(), linkMarks_.data());
    if (turn.none())
        kernels_.triangles(weave_, places_.data(), triangleMarks_.data());
    else // what they are compared with has turned
        for (std::uint32_t e = 0; e < weave_.triangles.size(); ++e) setBit(triangleMarks_, e);
}

/// And what comes beyond them when a vertex moves.
void SkinStrain::markAround(std::uint32_t v) {
    for (std::uint32_t k = weave_.linkStart[v]; k < weave_.linkStart[v + 1]; ++k)
        setBit(linkMarks_, weave_.linkOf[k]);
    for (std::uint32_t k = weave_.triangleStart[v]; k < weave_.triangleStart[v + 1]; ++k)
        setBit(triangleMarks_, weave_.triangleOf[k]);
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
    survey(turn, positions);
    std::size_t beyond = 0;
    for (int round = 0; round < pressedRounds + freeRounds; ++round) {
        round_ = static_cast<std::uint32_t>(round + 1);
        moved_.clear();
        beyond = 0;
        const auto moved = [&](std::uint32_t v) {
            touch(v);
            if (round == 0) markAround(v);
        };
        const auto link = [&](std::uint32_t e) {
            if (!relaxLink(e, rest, turn, positions)) return;
            ++beyond;
            moved(weave_.links[e].i);
            moved(weave_.links[e].j);
        };
        const auto triangle = [&](std::uint32_t e) {
            if (!relaxTriangle(e, rest, turn, positions)) return;
            ++beyond;
            for (int k = 0; k < 3; ++k) moved(static_cast<std::uint32_t>(weave_.triangles[e][k]));
        };
        if (round == 0) {
            forEachBit(linkMarks_, link);
            forEachBit(triangleMarks_, triangle);
        } else {
            for (const std::uint32_t e : links_) link(e);
            for (const std::uint32_t e : triangles_) triangle(e);
        }
        if (moved_.empty()) break;
        if (round == 0) listPresses(planes, patch);
        if (round < pressedRounds) press(planes, rest, without, turn, positions);
        gather();
    }
    return beyond;
}

} // namespace tss
