#include "bake/respond/SheetPatch.h"

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

namespace tss {
namespace {

/// The constraints of a block in groups that share no vertex, so that they can be taken at once, and that
/// neighbours in the list do not wait for each other's result.
template <class Constraint>
class Colours {
public:
    explicit Colours(std::size_t vertexCount) : taken_(vertexCount, 0) {}

    /// vertices(visit) visits those of the constraint.
    template <class Vertices>
    void add(const Constraint& c, const Vertices& vertices) {
        std::uint64_t used = 0;
        vertices([&](std::uint32_t v) { used |= taken_[v]; });
        const auto colour = static_cast<std::size_t>(std::countr_one(used));
        if (groups_.size() < 64) groups_.resize(64);
        if (colour == 64) return groups_.push_back({c}); // alone, it shares nothing
        vertices([&](std::uint32_t v) {
            taken_[v] |= std::uint64_t{1} << colour;
            touched_.push_back(v);
        });
        groups_[colour].push_back(c);
    }

    /// Hands out the groups, and starts anew.
    std::vector<std::vector<Constraint>> take() {
        for (const std::uint32_t v : touched_) taken_[v] = 0;
        touched_.clear();
        return std::exchange(groups_, {});
    }

private:
    std::vector<std::uint64_t> taken_; ///< colours of each vertex
    std::vector<std::uint32_t> touched_;
    std::vector<std::vector<Constraint>> groups_;
};

class Packer {
public:
    Packer(const SkinSheet& whole, const std::vector<bool>& inside) : whole_(whole), inside_(inside) {
        const auto count = static_cast<std::uint32_t>(whole.inverseMass.size());
        indexOf_.resize(count, 0);
        for (std::uint32_t v = 0; v < count; ++v) {
            if (!inside[v]) continue;
            indexOf_[v] = static_cast<std::uint32_t>(patch_.vertices.size());
            patch_.vertices.push_back(v);
            const float w = whole.inverseMass[v];
            patch_.sheet.inverseMass.push_back(w);
            patch_.sheet.mass.push_back(w > 0 ? 1 / w : 0);
        }
        past_ = static_cast<std::uint32_t>(patch_.vertices.size());
        patch_.sheet.inverseMass.push_back(0);
        patch_.sheet.mass.push_back(0);
        for (std::uint32_t v = 0; v < past_; ++v) owners_.push_back({PackedSheet::blockOf(v)});
    }

    SheetPatch pack() {
        constexpr std::uint32_t blockSize = PackedSheet::blockSize;
        const std::size_t blocks = (past_ + blockSize - 1) / blockSize;
        std::vector<std::vector<SheetEdge>> edges(blocks);
        std::vector<std::vector<SheetBend>> bends(blocks);
        for (const SheetEdge& e : whole_.edges)
            if (inside_[e.i] && inside_[e.j])
                edges[PackedSheet::blockOf(std::min(indexOf_[e.i], indexOf_[e.j]))].push_back(e);
        for (const SheetBend& b : whole_.bends) {
            bool inside = inside_[b.centre];
            for (std::uint32_t k = b.first; k < b.last; ++k) inside = inside && inside_[whole_.ring[k]];
            if (inside) bends[PackedSheet::blockOf(indexOf_[b.centre])].push_back(b);
        }
        Colours<SheetEdge> edgeColours(past_);
        Colours<SheetBend> bendColours(past_);
        for (std::size_t block = 0; block < blocks; ++block) {
            for (const SheetEdge& e : edges[block])
                edgeColours.add(e, [&](const auto& visit) { visit(indexOf_[e.i]), visit(indexOf_[e.j]); });
            for (const auto& group : edgeColours.take()) addEdges(group);
            for (const SheetBend& b : bends[block])
                bendColours.add(b, [&](const auto& visit) {
                    visit(indexOf_[b.centre]);
                    for (std::uint32_t k = b.first; k < b.last; ++k) visit(indexOf_[whole_.ring[k]]);
                });
            for (const auto& group : bendColours.take()) addBends(group);
            patch_.sheet.blocks.push_back({std::min(static_cast<std::uint32_t>(block + 1) * blockSize, past_),
                                           size(patch_.sheet.edges), size(patch_.sheet.bends),
                                           size(patch_.sheet.rims)});
            for (const SheetEdge& e : edges[block])
                for (const std::uint32_t v : {e.i, e.j}) own(block, v);
            for (const SheetBend& b : bends[block]) {
                own(block, b.centre);
                for (std::uint32_t k = b.first; k < b.last; ++k) own(block, whole_.ring[k]);
            }
        }
        listOwners();
        return std::move(patch_);
    }

private:
    template <class List>
    static std::uint32_t size(const List& list) {
        return static_cast<std::uint32_t>(list.size());
    }

    void addEdges(const std::vector<SheetEdge>& group) {
        for (std::size_t begin = 0; begin < group.size(); begin += 8) {
            EdgePack pack{};
            for (std::size_t lane = 0; lane < 8; ++lane) {
                pack.i[lane] = pack.j[lane] = laneStart(past_);
                if (begin + lane >= group.size()) continue;
                const SheetEdge& e = group[begin + lane];
                Move::Map(pack.direction[EdgePack::slot(lane)]) = e.direction;
                pack.compliance[lane] = e.compliance;
                pack.inverse[lane] = e.inverse;
                pack.i[lane] = laneStart(indexOf_[e.i]);
                pack.j[lane] = laneStart(indexOf_[e.j]);
            }
            patch_.sheet.edges.push_back(pack);
        }
    }

    /// Constraints of the block move this vertex of the whole sheet.
    void own(std::size_t block, std::uint32_t vertex) {
        std::vector<std::uint32_t>& owners = owners_[indexOf_[vertex]];
        const auto b = static_cast<std::uint32_t>(block);
        if (std::find(owners.begin(), owners.end(), b) == owners.end()) owners.push_back(b);
    }

    void listOwners() {
        PackedSheet& sheet = patch_.sheet;
        std::vector<std::vector<std::uint32_t>> halo(sheet.blocks.size());
        for (std::uint32_t v = 0; v < past_; ++v)
            for (const std::uint32_t block : owners_[v])
                if (block != PackedSheet::blockOf(v)) halo[block].push_back(v);
        append(owners_, sheet.owners);
        append(halo, sheet.halo);
    }

    static void append(const std::vector<std::vector<std::uint32_t>>& from, SheetLists& to) {
        for (const std::vector<std::uint32_t>& list : from) {
            to.at.insert(to.at.end(), list.begin(), list.end());
            to.start.push_back(size(to.at));
        }
    }

    bool isPlain(const SheetBend& b) const {
        const float share = whole_.ringShare[b.first];
        return std::all_of(whole_.ringShare.begin() + b.first, whole_.ringShare.begin() + b.last,
                           [&](float s) { return s == share; });
    }

    void addBends(const std::vector<SheetBend>& group) {
        std::map<std::uint32_t, std::vector<SheetBend>> bySize;
        for (const SheetBend& b : group) {
            if (isPlain(b)) {
                bySize[b.last - b.first].push_back(b);
                continue;
            }
            RimBend rim{indexOf_[b.centre], {}, {}, b.compliance, b.inverse};
            for (const std::uint32_t k : {0u, 1u}) {
                rim.neighbour[k] = indexOf_[whole_.ring[b.first + k]];
                rim.share[k] = whole_.ringShare[b.first + k];
            }
            patch_.sheet.rims.push_back(rim);
        }
        for (const auto& [ringSize, bends] : bySize)
            for (std::size_t begin = 0; begin < bends.size(); begin += 2) addPair(ringSize, bends, begin);
    }

    void addPair(std::uint32_t ringSize, const std::vector<SheetBend>& bends, std::size_t begin) {
        BendPack pack{{}, {}, {laneStart(past_), laneStart(past_)}, size(patch_.sheet.ring), ringSize};
        for (std::uint32_t k = 0; k < ringSize; ++k)
            for (const std::size_t b : {begin, begin + 1})
                patch_.sheet.ring.push_back(
                    laneStart(b < bends.size() ? indexOf_[whole_.ring[bends[b].first + k]] : past_));
        for (std::size_t b = 0; b < 2 && begin + b < bends.size(); ++b) {
            const SheetBend& bend = bends[begin + b];
            pack.centre[b] = laneStart(indexOf_[bend.centre]);
            for (std::size_t k = 0; k < 3; ++k) {
                pack.compliance[4 * b + k] = bend.compliance;
                pack.inverse[4 * b + k] = bend.inverse;
            }
        }
        patch_.sheet.bends.push_back(pack);
    }

    const SkinSheet& whole_;
    const std::vector<bool>& inside_;
    std::vector<std::uint32_t> indexOf_;
    std::uint32_t past_ = 0;
    std::vector<std::vector<std::uint32_t>> owners_; ///< of each vertex
    SheetPatch patch_;
};

} // namespace

SheetPatch patchOf(const SkinSheet& whole, const std::vector<bool>& inside) {
    return Packer(whole, inside).pack();
}

} // namespace tss
