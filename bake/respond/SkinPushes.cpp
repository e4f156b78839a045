#include "bake/respond/SkinPushes.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Rows that ask for opposite things give way by this share of their push, so that pushes stay bounded.
constexpr float giveWay = 0.003f;
/// Each push goes beyond what it alone would need, since its neighbours push the same way: fewer sweeps.
constexpr float beyond = 1.5f;
/// In sizes of the skin: the sweeps end when no place changes by more.
constexpr float settled = 1e-7f;

} // namespace

SkinPushes::SkinPushes(const SkinFoundation& foundation)
    : foundation_(foundation), dense_(foundation.nodes, 0), stamp_(foundation.nodes, 0),
      nodes_(foundation.nodes, Move::Zero()) {
    clear();
}

/// What each new plane has of the nodes, and how nodes move by a push of 1 along it.
void SkinPushes::gather(std::span<const SkinPlane> planes) {
    const SkinFoundation& f = foundation_;
    const auto collect = [&](std::vector<Entry>& out) {
        for (const std::uint32_t n : seen_) {
            out.push_back({n, dense_[n]});
            dense_[n] = 0;
        }
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
            for (std::uint32_t e = f.start[plane.vertex[k]]; e < f.start[plane.vertex[k] + 1]; ++e)
                add(f.node[e], plane.weight[k] * f.weight[e]);
        const std::size_t first = own_.size();
        collect(own_);
        for (std::size_t i = first; i < own_.size(); ++i)
            for (std::uint32_t e = f.columnStart[own_[i].index]; e < f.columnStart[own_[i].index + 1]; ++e)
                add(f.columnNode[e], own_[i].value * f.column[e]);
        collect(column_);
        ownStart_.push_back(static_cast<std::uint32_t>(own_.size()));
        columnStart_.push_back(static_cast<std::uint32_t>(column_.size()));
    }
}

/// How much a push of 1 along each plane's normal moves the others, were their normals alike.
void SkinPushes::couple() {
    const std::size_t count = ownStart_.size() - 1;
    coupleStart_.assign(1, 0);
    coupling_.clear();
    self_.assign(count, 0);
    for (std::size_t r = 0; r < count; ++r) {
        for (std::uint32_t e = columnStart_[r]; e < columnStart_[r + 1]; ++e)
            dense_[column_[e].index] = column_[e].value;
        for (std::size_t s = 0; s < count; ++s) {
            float sum = 0;
            for (std::uint32_t e = ownStart_[s]; e < ownStart_[s + 1]; ++e)
                sum += own_[e].value * dense_[own_[e].index];
            if (s == r)
                self_[r] = sum;
            else if (sum != 0)
                coupling_.push_back({static_cast<std::uint32_t>(s), sum});
        }
        for (std::uint32_t e = columnStart_[r]; e < columnStart_[r + 1]; ++e) dense_[column_[e].index] = 0;
        coupleStart_.push_back(static_cast<std::uint32_t>(coupling_.size()));
    }
}

void SkinPushes::clear() {
    ownStart_.assign(1, 0);
    columnStart_.assign(1, 0);
    own_.clear();
    column_.clear();
    self_.clear();
}

float SkinPushes::solve(std::span<SkinPlane> planes, std::span<const Move> base, int sweeps) {
    if (planes.size() > self_.size()) {
        gather(planes);
        couple();
    }
    short_.resize(planes.size());
    for (std::size_t r = 0; r < planes.size(); ++r) {
        Eigen::Vector3f now = Eigen::Vector3f::Zero();
        for (int k = 0; k < planes[r].vertices; ++k)
            now += planes[r].weight[k] * base[planes[r].vertex[k]].head<3>();
        short_[r] = planes[r].level - planes[r].normal.dot(now);
    }
    const auto spread = [&](std::size_t r, float change) {
        short_[r] -= self_[r] * change;
        for (std::uint32_t e = coupleStart_[r]; e < coupleStart_[r + 1]; ++e) {
            const Entry& other = coupling_[e];
            short_[other.index] -= other.value * planes[r].normal.dot(planes[other.index].normal) * change;
        }
    };
    for (std::size_t r = 0; r < planes.size(); ++r)
        if (planes[r].push > 0) spread(r, planes[r].push);
    float largest = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        largest = 0;
        for (std::size_t k = 0; k < planes.size(); ++k) {
            const std::size_t r = sweep % 2 == 0 ? k : planes.size() - 1 - k; // no end is always the last
            if (!(self_[r] > 0)) continue;                                    // nothing there can give way
            float& push = planes[r].push;
            const float stiff = self_[r] * (1 + giveWay);
            const float next =
                std::max(0.0f, push + beyond * (short_[r] - giveWay * self_[r] * push) / stiff);
            const float change = next - push;
            if (change == 0) continue;
            push = next;
            spread(r, change);
            largest = std::max(largest, std::abs(change) * self_[r]);
        }
        if (largest <= settled) break;
    }
    return largest;
}

std::size_t SkinPushes::apply(std::span<const SkinPlane> planes, std::span<Move> places) {
    std::size_t pushing = 0;
    ++round_;
    for (std::size_t r = 0; r < planes.size(); ++r) {
        if (!(planes[r].push > 0)) continue;
        ++pushing;
        Move along = Move::Zero();
        along.head<3>() = planes[r].push * planes[r].normal;
        for (std::uint32_t e = columnStart_[r]; e < columnStart_[r + 1]; ++e) {
            const std::uint32_t n = column_[e].index;
            if (stamp_[n] != round_) {
                stamp_[n] = round_;
                seen_.push_back(n);
                nodes_[n].setZero();
            }
            nodes_[n] += column_[e].value * along;
        }
    }
    std::sort(seen_.begin(), seen_.end());
    for (const std::uint32_t n : seen_)
        for (std::uint32_t e = foundation_.nodeStart[n]; e < foundation_.nodeStart[n + 1]; ++e)
            places[foundation_.nodeVertex[e]] += foundation_.nodeWeight[e] * nodes_[n];
    seen_.clear();
    return pushing;
}

} // namespace tss
