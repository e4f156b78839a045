#include "bake/respond/SkinPushes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tss {
namespace {

/// Regularisation: this share of each diagonal element is added to it, so that the pushes of contradicting
/// planes stay bounded.
constexpr float regularisation = 0.003f;

} // namespace

SkinPushes::SkinPushes(const SkinRig& rig)
    : rig_(rig), nodePlanes_(rig.foundation.nodes), sums_(rig.foundation.nodes, 0), couplings_(0, 0),
      nodes_(rig.foundation.nodes, Move::Zero()), reached_(rig.blocks(), 0),
      displaced_(rig.places.size(), 0) {}

/// Computes weights_ and column_ of the new planes.
void SkinPushes::addColumns(std::span<const SkinPlane> planes) {
    const SkinFoundation& f = rig_.foundation;
    const auto takeInto = [&](Lists<SkinEntry>& out) {
        sums_.take([&](std::uint32_t node, float sum) { out.push_back({node, sum}); });
        out.endList();
    };
    for (const SkinPlane& plane : planes.subspan(self_.size())) {
        for (int k = 0; k < plane.vertices; ++k)
            for (const auto& [node, weight] : f.weights[plane.vertex[k]])
                // A node without a column cannot be pushed. Leaving out its weight keeps the matrix
                // symmetric.
                if (!f.columns[node].empty()) sums_[node] += plane.weight[k] * weight;
        takeInto(weights_);
        for (const SkinEntry& weight : weights_[weights_.size() - 1])
            for (const auto& [node, move] : f.columns[weight.index]) sums_[node] += weight.value * move;
        takeInto(column_);
    }
}

/// Computes the couplings of the new planes with all others that constrain a node they move.
void SkinPushes::addCouplings() {
    const std::size_t count = weights_.size();
    couplings_.resize(count);
    rows_.resize(std::max(rows_.size(), count));
    const auto couple = [&](std::uint32_t r, std::uint32_t s, float coupling) {
        std::vector<Block>& row = rows_[r];
        if (row.empty() || row.back().first != s / 4 * 4) row.emplace_back().first = s / 4 * 4;
        row.back().coupling[s % 4] = coupling;
    };
    for (std::uint32_t r = static_cast<std::uint32_t>(self_.size()); r < count; ++r) {
        for (const auto& [node, weight] : weights_[r]) nodePlanes_[node].push_back({r, weight});
        for (const auto& [node, move] : column_[r])
            for (const auto& [plane, weight] : nodePlanes_[node]) couplings_[plane] += move * weight;
        self_.push_back(couplings_.at(r));
        std::ranges::sort(couplings_.places());
        couplings_.take([&](std::uint32_t s, float sum) {
            if (s >= r || sum == 0) return;
            couple(r, s, sum);
            couple(s, r, sum);
        });
    }
}

void SkinPushes::clear() {
    for (const SkinEntry& entry : weights_.items()) nodePlanes_[entry.index].clear();
    for (std::size_t r = 0; r < self_.size(); ++r) rows_[r].clear();
    weights_.clear();
    column_.clear();
    self_.clear();
}

/// Sets up the problem for the planes' current normals and levels: matrix and residual.
void SkinPushes::prepare(std::span<SkinPlane> planes, std::span<const Move> base) {
    const std::size_t count = planes.size(), whole = (count + 3) / 4 * 4;
    lack_.assign(whole, 0);
    for (std::vector<float>& normals : normals_) normals.assign(whole, 0);
    for (std::size_t r = 0; r < count; ++r) {
        Eigen::Vector3f now = Eigen::Vector3f::Zero();
        for (int k = 0; k < planes[r].vertices; ++k)
            now += planes[r].weight[k] * base[planes[r].vertex[k]].head<3>();
        lack_[r] = planes[r].level - planes[r].normal.dot(now);
        for (int k = 0; k < 3; ++k) normals_[k][r] = planes[r].normal[k];
    }
    for (std::size_t r = 0; r < count; ++r) {
        const Eigen::Vector3f& normal = planes[r].normal;
        for (Block& block : rows_[r]) {
            const auto along = [&](int k) { return normal[k] * Four::Map(normals_[k].data() + block.first); };
            block.matrix = block.coupling * (along(0) + (along(1) + along(2)));
        }
    }
    for (std::size_t r = 0; r < count; ++r)
        if (planes[r].push > 0) addPush(r, planes[r].push);
}

/// Updates the residual for a change of one push.
void SkinPushes::addPush(std::size_t r, float change) {
    lack_[r] -= (1 + regularisation) * self_[r] * change;
    for (const Block& block : rows_[r]) Four::Map(lack_.data() + block.first) -= block.matrix * change;
}

/// One sweep of projected Gauss-Seidel. Returns the largest displacement that a change of push makes.
float SkinPushes::sweep(std::span<SkinPlane> planes, bool backwards) {
    float largest = 0;
    for (std::size_t k = 0; k < planes.size(); ++k) {
        const std::size_t r =
            backwards ? planes.size() - 1 - k : k; // alternating, so that neither end is favoured
        if (!(self_[r] > 0)) continue;             // no vertex of it can move
        const float next = std::max(planes[r].push + lack_[r] / ((1 + regularisation) * self_[r]), 0.0f);
        const float change = next - planes[r].push;
        if (change == 0) continue;
        largest = std::max(largest, std::abs(change) * self_[r]);
        planes[r].push = next;
        addPush(r, change);
    }
    return largest;
}

void SkinPushes::solve(std::span<SkinPlane> planes, std::span<const Move> base, int sweeps) {
    if (planes.size() > self_.size()) {
        addColumns(planes);
        addCouplings();
    }
    prepare(planes, base);
    for (int done = 0; done < sweeps && sweep(planes, done % 2 != 0) > settled;) ++done;
}

std::size_t SkinPushes::apply(std::span<const SkinPlane> planes, SkinScene& scene) {
    std::size_t pushing = 0;
    nodes_.take([](std::uint32_t, const Move&) {});
    for (std::size_t r = 0; r < planes.size(); ++r) {
        if (!(planes[r].push > 0)) continue;
        ++pushing;
        Move along = Move::Zero();
        along.head<3>() = planes[r].push * planes[r].normal;
        for (const auto& [node, value] : column_[r]) nodes_[node] += value * along;
    }
    displace(scene);
    return pushing;
}

void SkinPushes::undo(SkinScene& scene) {
    for (std::size_t b = 0; b < reached_.size(); ++b) {
        if (!std::exchange(reached_[b], 0)) continue;
        const auto [first, last] = rig_.verticesOf(b);
        std::copy(scene.carried.begin() + first, scene.carried.begin() + last, scene.skin.begin() + first);
        std::fill(displaced_.begin() + first, displaced_.begin() + last, 0);
    }
}

void SkinPushes::displace(SkinScene& scene) {
    undo(scene);
    for (const std::uint32_t node : nodes_.places())
        for (const std::uint32_t b : rig_.nodeBlocks[node]) reached_[b] = 1;
    float farthest = 0;
    for (std::size_t b = 0; b < reached_.size(); ++b) {
        if (reached_[b] == 0) continue;
        const auto [first, last] = rig_.verticesOf(b);
        for (auto v = first; v < last; ++v) {
            const Move carried = scene.carried[v];
            Move place = carried;
            for (const auto& [node, weight] : rig_.foundation.weights[v]) place += weight * nodes_.at(node);
            const float squared = (place - carried).squaredNorm();
            displaced_[v] = squared > settled * settled;
            farthest = std::max(farthest, squared);
            scene.skin[v] = place;
        }
    }
    farthest_ = std::sqrt(farthest);
}

} // namespace tss
