#include "bake/respond/SkinCut.h"

#include "bake/base/Infinity.h"

#include <algorithm>

namespace tss {

/// Pushes flow along shortest ways until none is left.
class SkinCutter::Flow {
public:
    Flow(const SkinCutter& cutter, const std::vector<SkinSide>& sides)
        : arcs_(cutter.arcs_), none_(cutter.none_), sides_(sides), level_(sides.size()), next_(sides.size()) {
    }

    SkinCut run() {
        while (setLevels()) {
            std::fill(next_.begin(), next_.end(), 0);
            for (std::uint32_t v = 0; v < level_.size(); ++v)
                if (sides_[v] == SkinSide::Inside) pushFrom(v);
        }
        for (const int level : level_) made_.inside.push_back(level >= 0);
        return std::move(made_);
    }

private:
    using Way = std::vector<std::pair<std::uint32_t, std::uint32_t>>; ///< vertices and the arcs taken there

    /// How many arcs each vertex is from the inside, -1: none leads there. Returns whether the outside can be
    /// reached.
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

    void pushFrom(std::uint32_t source) {
        Way way;
        for (std::uint32_t v = source;;) {
            if (sides_[v] == SkinSide::Outside) {
                v = pushAlong(way);
                continue;
            }
            std::uint32_t& k = next_[v];
            while (k < arcs_[v].size() && !(isOpen(arcs_[v][k]) && level_[arcs_[v][k].to] == level_[v] + 1))
                ++k;
            if (k < arcs_[v].size()) {
                way.emplace_back(v, k);
                v = arcs_[v][k].to;
            } else {
                if (way.empty()) return;
                v = way.back().first;
                ++next_[v];
                way.pop_back();
            }
        }
    }

    /// Fills a way, and shortens it to where it is full first: returns that vertex.
    std::uint32_t pushAlong(Way& way) {
        double most = infinity;
        for (const auto& [v, k] : way) most = std::min(most, arcs_[v][k].room);
        made_.cost += most;
        std::size_t full = way.size() - 1;
        for (std::size_t i = way.size(); i-- > 0;) {
            Arc& arc = arcs_[way[i].first][way[i].second];
            arc.room -= most;
            arcs_[arc.to][arc.back].room += most;
            if (!isOpen(arc)) full = i;
        }
        const std::uint32_t v = way[full].first;
        way.resize(full);
        return v;
    }

    bool isOpen(const Arc& arc) const { return arc.room > none_ && sides_[arc.to] != SkinSide::Removed; }

    std::vector<std::vector<Arc>> arcs_;
    double none_;
    const std::vector<SkinSide>& sides_;
    std::vector<int> level_;
    std::vector<std::uint32_t> next_; ///< of each vertex: the arc to try next
    SkinCut made_;
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
                         room = dual * (price[u] + price[v]) / 2;
            arcs_[v].push_back({u, static_cast<std::uint32_t>(arcs_[u].size()), room});
            arcs_[u].push_back({v, static_cast<std::uint32_t>(arcs_[v].size() - 1), room});
            all += room;
        }
    none_ = 1e-13 * all;
}

SkinCut SkinCutter::cut(const std::vector<SkinSide>& sides) const {
    return Flow(*this, sides).run();
}

} // namespace tss
