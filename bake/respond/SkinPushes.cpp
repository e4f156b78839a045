#include "bake/respond/SkinPushes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tss {
namespace {

/// Rows that ask for opposite things give way by this share of their push, so that pushes stay bounded.
constexpr float giveWay = 0.003f;
/// Sweeps that find out what pushes, and steps of conjugate gradients that then find out how much, in turn.
constexpr int sweepsBetween = 3, stepsBetween = 8;
/// Of what is lacking at the planes around: how far a push may move any place. Planes that ask for opposite
/// things would push without bounds.
constexpr float mostPush = 15;
/// A step against the limits of the pushes is halved until it helps, down to this share of it.
constexpr float leastStep = 0.1f;

} // namespace

SkinPushes::SkinPushes(const SkinFoundation& foundation)
    : foundation_(foundation), dense_(foundation.nodes, 0), stamp_(foundation.nodes, 0),
      lastOwner_(foundation.nodes, none), nodes_(foundation.nodes, Move::Zero()) {
    clear();
}

/// What each new plane has of the nodes, and how nodes move by a push of 1 along it.
void SkinPushes::gather(std::span<const SkinPlane> planes) {
    const SkinFoundation& f = foundation_;
    const auto collect = [&](Lists<SkinEntry>& out) {
        for (const std::uint32_t n : seen_) {
            out.push_back({n, dense_[n]});
            dense_[n] = 0;
        }
        out.endList();
        seen_.clear();
        ++round_;
    };
    const auto add = [&](std::uint32_t n, float value) {
        if (stamp_[n] != round_) {
            stamp_[n] = round_;
            seen_.push_back(n);
        }
        dense_[n] += value;
    };
    ++round_;
    for (const SkinPlane& plane : planes.subspan(self_.size())) {
        for (int k = 0; k < plane.vertices; ++k)
            for (const auto& [node, weight] : f.weights[plane.vertex[k]])
                // What has no column cannot be pushed; seen without it the problem stays symmetric.
                if (!f.columns[node].empty()) add(node, plane.weight[k] * weight);
        collect(own_);
        for (const SkinEntry& own : own_[own_.size() - 1])
            for (const auto& [node, move] : f.columns[own.index]) add(node, own.value * move);
        collect(column_);
    }
}

/// How much a push of 1 along each new plane's normal moves those before it, and they it, were their normals
/// alike. Only planes that have some of the nodes that it moves.
void SkinPushes::couple() {
    const std::size_t count = own_.size();
    sums_.resize(count, 0);
    summed_.resize(count, 0);
    std::vector<std::uint32_t> met;
    for (std::uint32_t r = static_cast<std::uint32_t>(self_.size()); r < count; ++r) {
        for (const auto& [node, value] : own_[r]) {
            owners_.push_back({r, value, lastOwner_[node]});
            lastOwner_[node] = static_cast<std::uint32_t>(owners_.size()) - 1;
        }
        float peak = 0;
        for (const auto& [node, move] : column_[r]) {
            peak = std::max(peak, std::abs(move));
            for (std::uint32_t o = lastOwner_[node]; o != none; o = owners_[o].before) {
                const Owner& owner = owners_[o];
                if (!summed_[owner.plane]) met.push_back(owner.plane);
                summed_[owner.plane] = 1;
                sums_[owner.plane] += move * owner.value;
            }
        }
        peak_.push_back(peak);
        std::sort(met.begin(), met.end());
        for (const std::uint32_t s : met) {
            if (s < r && sums_[s] != 0) before_.push_back({s, sums_[s]});
            if (s < r) sums_[s] = 0;
            summed_[s] = 0;
        }
        met.clear();
        self_.push_back(std::exchange(sums_[r], 0));
        before_.endList();
    }
    // Those behind each plane.
    std::vector<std::uint32_t> start(count + 1, 0);
    for (const SkinEntry& entry : before_.items()) ++start[entry.index + 1];
    for (std::size_t r = 0; r < count; ++r) start[r + 1] += start[r];
    std::vector<SkinEntry> behind(before_.items().size());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::uint32_t r = 0; r < count; ++r)
        for (const auto& [plane, value] : before_[r]) behind[next[plane]++] = {r, value};
    coupleStart_.assign(1, 0);
    coupling_.clear();
    fours_.clear();
    for (std::uint32_t r = 0; r < count; ++r) {
        const auto take = [&](const SkinEntry& entry) {
            const std::uint32_t first = entry.index / 4 * 4;
            if (fours_.size() == coupleStart_.back() || fours_.back() != first) {
                fours_.push_back(first);
                coupling_.push_back(Four::Zero());
            }
            coupling_.back()[entry.index - first] = entry.value;
        };
        std::ranges::for_each(before_[r], take);
        std::for_each(behind.begin() + start[r], behind.begin() + start[r + 1], take);
        coupleStart_.push_back(static_cast<std::uint32_t>(coupling_.size()));
    }
}

void SkinPushes::clear() {
    for (const SkinEntry& entry : own_.items()) lastOwner_[entry.index] = none;
    owners_.clear();
    own_.clear();
    column_.clear();
    self_.clear();
    peak_.clear();
    before_.clear();
}

/// What each plane still lacks, and how much of it a push of each other one gives: the matrix of the problem.
void SkinPushes::prepare(std::span<SkinPlane> planes, std::span<const Move> base, float deepest) {
    const std::size_t count = planes.size(), whole = (count + 3) / 4 * 4;
    asked_.assign(whole, 0);
    for (std::vector<float>& normals : normals_) normals.assign(whole, 0);
    for (std::size_t r = 0; r < count; ++r) {
        Eigen::Vector3f now = Eigen::Vector3f::Zero();
        for (int k = 0; k < planes[r].vertices; ++k)
            now += planes[r].weight[k] * base[planes[r].vertex[k]].head<3>();
        asked_[r] = planes[r].level - planes[r].normal.dot(now);
        for (int k = 0; k < 3; ++k) normals_[k][r] = planes[r].normal[k];
    }
    lack_ = asked_;
    matrix_.resize(coupling_.size());
    most_.resize(count);
    for (std::size_t r = 0; r < count; ++r) {
        const Eigen::Vector3f& normal = planes[r].normal;
        Four asked = Four::Constant(std::max(asked_[r], 0.0f));
        for (std::uint32_t e = coupleStart_[r]; e < coupleStart_[r + 1]; ++e) {
            const std::uint32_t first = fours_[e];
            const Four facing = normal[0] * four(normals_[0], first) +
                                (normal[1] * four(normals_[1], first) + normal[2] * four(normals_[2], first));
            matrix_[e] = coupling_[e] * facing;
            asked = asked.max((coupling_[e] != 0).select(four(asked_, first), Four::Zero()));
        }
        // No push moves any place by more than a few times what is lacking around its own, which may give way
        // less than those beside it; a plane that was turned where pushes had thrown the skin asks for more
        // than anything lacked.
        most_[r] =
            self_[r] > 0 ? mostPush * std::min(asked.maxCoeff(), deepest) / std::max(self_[r], peak_[r]) : 0;
    }
    for (std::size_t r = 0; r < count; ++r) {
        planes[r].push = std::min(planes[r].push, most_[r]);
        if (planes[r].push > 0) spread(r, planes[r].push);
    }
}

/// Adds to each plane what `factor` of the row of one of them in the matrix gives it.
void SkinPushes::addRow(std::size_t r, float factor, std::vector<float>& sums) const {
    sums[r] += (1 + giveWay) * self_[r] * factor;
    float* sum = sums.data();
    const Four* matrix = matrix_.data();
    const std::uint32_t* fours = fours_.data();
    for (std::uint32_t e = coupleStart_[r], end = coupleStart_[r + 1]; e < end; ++e)
        Eigen::Map<Four>(sum + fours[e]) += matrix[e] * factor;
}

/// Takes from what the planes lack what a change of one push gives them.
void SkinPushes::spread(std::size_t r, float change) {
    addRow(r, -change, lack_);
}

/// One push after the other, to what its plane lacks. Returns the largest change of a place.
float SkinPushes::sweep(std::span<SkinPlane> planes, bool backwards) {
    float largest = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const std::size_t r = backwards ? planes.size() - 1 - k : k; // no end is always the last
        if (!(self_[r] > 0)) continue;                               // nothing there can give way
        const float next = std::clamp(planes[r].push + lack_[r] / ((1 + giveWay) * self_[r]), 0.0f, most_[r]);
        largest = std::max(largest, std::abs(next - planes[r].push) * self_[r]);
        setPush(planes[r], r, next);
    }
    return largest;
}

/// What all planes would be given, were each push changed by its part of way_.
void SkinPushes::answer() {
    answer_.assign(asked_.size(), 0);
    for (std::size_t r = 0; r < way_.size(); ++r)
        if (way_[r] != 0) addRow(r, way_[r], answer_);
}

/// Conjugate gradients over those that push: fills step_, by which they would lack nothing. Returns how many
/// steps it took.
int SkinPushes::findStep(std::span<const SkinPlane> planes, int steps) {
    const std::size_t count = planes.size();
    step_.assign(count, 0);
    way_.assign(count, 0);
    left_.assign(count, 0);
    float size = 0;
    for (std::size_t r = 0; r < count; ++r) {
        if (!inside(planes, r)) continue;
        left_[r] = lack_[r];
        way_[r] = left_[r] / self_[r];
        size += left_[r] * way_[r];
    }
    const float enough = 1e-8f * size;
    int taken = 0;
    for (; taken < steps && size > enough; ++taken) {
        answer();
        float curve = 0;
        float least = 0; // of the curvature, were nothing cut off the columns
        for (std::size_t r = 0; r < count; ++r) {
            curve += way_[r] * answer_[r];
            least += giveWay * self_[r] * way_[r] * way_[r];
        }
        if (!(curve > least)) break;
        const float reach = size / curve;
        float next = 0;
        for (std::size_t r = 0; r < count; ++r) {
            if (!inside(planes, r)) continue;
            step_[r] += reach * way_[r];
            left_[r] -= reach * answer_[r];
            next += left_[r] * left_[r] / self_[r];
        }
        for (std::size_t r = 0; r < count; ++r)
            if (inside(planes, r)) way_[r] = left_[r] / self_[r] + next / size * way_[r];
        size = next;
    }
    return taken;
}

void SkinPushes::setPush(SkinPlane& plane, std::size_t r, float push) {
    const float change = push - plane.push;
    if (change == 0) return;
    plane.push = push;
    spread(r, change);
}

/// Goes as much of step_ as helps.
void SkinPushes::goStep(std::span<SkinPlane> planes) {
    const std::size_t count = planes.size();
    const float before = energy(planes);
    way_.resize(count);
    for (std::size_t r = 0; r < count; ++r) way_[r] = planes[r].push; // from where it goes
    for (float share = 1; share > leastStep; share /= 2) {
        for (std::size_t r = 0; r < count; ++r)
            setPush(planes[r], r,
                    step_[r] == 0 ? way_[r] : std::clamp(way_[r] + share * step_[r], 0.0f, most_[r]));
        if (!(energy(planes) > before)) return;
    }
    for (std::size_t r = 0; r < count; ++r) setPush(planes[r], r, way_[r]);
}

/// What the pushes make as small as they can, up to a factor.
float SkinPushes::energy(std::span<const SkinPlane> planes) const {
    float sum = 0;
    for (std::size_t r = 0; r < planes.size(); ++r) sum -= planes[r].push * (asked_[r] + lack_[r]);
    return sum;
}

void SkinPushes::solve(std::span<SkinPlane> planes, std::span<const Move> base, float deepest, int sweeps) {
    if (planes.size() > self_.size()) {
        gather(planes);
        couple();
    }
    prepare(planes, base, deepest);
    for (int done = 0; done < sweeps;) {
        float largest = 0;
        for (int k = 0; k < sweepsBetween && done < sweeps; ++k, ++done) largest = sweep(planes, k % 2 != 0);
        if (largest <= settled) break;
        // What lies between opposite pushes is settled in a few steps, for which sweeps would take thousands.
        const int steps = findStep(planes, std::min(stepsBetween, sweeps - done));
        if (steps > 0) goStep(planes);
        done += steps;
    }
}

std::size_t SkinPushes::apply(std::span<const SkinPlane> planes, std::span<Move> places,
                              std::span<char> blocks) {
    std::size_t pushing = 0;
    ++round_;
    for (std::size_t r = 0; r < planes.size(); ++r) {
        if (!(planes[r].push > 0)) continue;
        ++pushing;
        Move along = Move::Zero();
        along.head<3>() = planes[r].push * planes[r].normal;
        for (const auto& [n, value] : column_[r]) {
            if (stamp_[n] != round_) {
                stamp_[n] = round_;
                seen_.push_back(n);
                nodes_[n].setZero();
            }
            nodes_[n] += value * along;
        }
    }
    std::sort(seen_.begin(), seen_.end());
    for (const std::uint32_t n : seen_) {
        const Move move = nodes_[n];
        for (const auto& [vertex, weight] : foundation_.vertices[n]) {
            places[vertex] += weight * move;
            blocks[vertex / SkinRig::block] = 1;
        }
    }
    seen_.clear();
    return pushing;
}

} // namespace tss
