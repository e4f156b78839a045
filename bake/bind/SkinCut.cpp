#include "bake/bind/SkinCut.h"

#include "bake/base/Infinity.h"

#include <algorithm>

namespace tss {

/// The maximum flow: blocking flows along shortest augmenting paths until there is none.
class SkinCutter::Flow {
public:
    Flow(const SkinCutter& cutter, const std::vector<SkinSide>& sides)
        : arcs_(cutter.arcs_), tolerance_(cutter.tolerance_), sides_(sides), level_(sides.size()),
          next_(sides.size()) {}

    SkinCut run() {
        while (setLevels()) {
            std::fill(next_.begin(), next_.end(), 0);
            for (std::uint32_t v = 0; v < level_.size(); ++v)
                if (sides_[v] == SkinSide::Inside) augmentFrom(v);
        }
        for (const int level : level_) cut_.inside.push_back(level >= 0);
        return std::move(cut_);
    }

private:
    using Path =
        std::vector<std::pair<std::uint32_t, std::uint32_t>>; ///< vertices, and the arc taken from each

    /// Breadth-first levels: number of arcs from a source, -1: unreachable. Returns whether a sink is
    /// reachable.
    bool setLevels() {
        std::fill(level_.begin(), level_.end(), -1);
        std::vector<std::uint32_t> queue;
        for (std::uint32_t v = 0; v < level_.size(); ++v)
            if (sides_[v] == SkinSide::Inside) {
                level_[v] = 0;
                queue.push_back(v);
            }
        bool reached = false;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            const std::uint32_t v = queue[i];
            if (sides_[v] == SkinSide::Outside)
                reached = true;
            else
                for (const Arc& arc : arcs_[v])
                    if (isOpen(arc) && level_[arc.to] < 0) {
                        level_[arc.to] = level_[v] + 1;
                        queue.push_back(arc.to);
                    }
        }
        return reached;
    }

    void augmentFrom(std::uint32_t source) {
        Path path;
        for (std::uint32_t v = source;;) {
            if (sides_[v] == SkinSide::Outside) {
                v = augment(path);
                continue;
            }
            std::uint32_t& k = next_[v];
            while (k < arcs_[v].size() && !(isOpen(arcs_[v][k]) && level_[arcs_[v][k].to] == level_[v] + 1))
                ++k;
            if (k < arcs_[v].size()) {
                path.emplace_back(v, k);
                v = arcs_[v][k].to;
            } else {
                if (path.empty()) return;
                v = path.back().first;
                ++next_[v];
                path.pop_back();
            }
        }
    }

    /// Saturates an augmenting path, and cuts it off at its first saturated arc. Returns the vertex there.
    std::uint32_t augment(Path& path) {
        double most = infinity;
        for (const auto& [v, k] : path) most = std::min(most, arcs_[v][k].capacity);
        cut_.cost += most;
        std::size_t full = path.size() - 1;
        for (std::size_t i = path.size(); i-- > 0;) {
            Arc& arc = arcs_[path[i].first][path[i].second];
            arc.capacity -= most;
            arcs_[arc.to][arc.back].capacity += most;
            if (!isOpen(arc)) full = i;
        }
        const std::uint32_t v = path[full].first;
        path.resize(full);
        return v;
    }

    bool isOpen(const Arc& arc) const {
        return arc.capacity > tolerance_ && sides_[arc.to] != SkinSide::Removed;
    }

    std::vector<std::vector<Arc>> arcs_;
    double tolerance_;
    const std::vector<SkinSide>& sides_;
    std::vector<int> level_;
    std::vector<std::uint32_t> next_; ///< per vertex: the next arc to try
    SkinCut cut_;
};

SkinCutter::SkinCutter(const TriangleMesh& skin, const SkinGraph& graph, const std::vector<double>& price)
    : arcs_(graph.vertices()) {
    const SparseMatrix laplacian = skinLaplacian(skin);
    double all = 0;
    for (std::uint32_t v = 0; v < arcs_.size(); ++v)
        for (SparseMatrix::InnerIterator e(laplacian, v); e; ++e) {
            const auto u = static_cast<std::uint32_t>(e.row());
            if (u <= v) continue;
            const double dual = -e.value() * (skin.vertices[u] - skin.vertices[v]).norm(),
                         capacity = dual * (price[u] + price[v]) / 2;
            arcs_[v].push_back({u, static_cast<std::uint32_t>(arcs_[u].size()), capacity});
            arcs_[u].push_back({v, static_cast<std::uint32_t>(arcs_[v].size() - 1), capacity});
            all += capacity;
        }
    tolerance_ = 1e-13 * all;
}

SkinCut SkinCutter::cut(const std::vector<SkinSide>& sides) const {
    return Flow(*this, sides).run();
}

} // namespace tss
