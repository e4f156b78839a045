#include "bake/respond/SkinSolver.h"

namespace tss {

SheetPatch patchOf(const SkinSheet& whole, const std::vector<bool>& isInside) {
    const std::size_t count = whole.inverseMass.size();
    SheetPatch patch;
    std::vector<std::uint32_t> indexOf(count, 0);
    for (std::uint32_t v = 0; v < count; ++v) {
        if (!isInside[v]) continue;
        indexOf[v] = static_cast<std::uint32_t>(patch.vertices.size());
        patch.vertices.push_back(v);
        patch.sheet.inverseMass.push_back(whole.inverseMass[v]);
    }
    for (SheetEdge e : whole.edges) {
        if (!isInside[e.i] || !isInside[e.j]) continue;
        e.i = indexOf[e.i];
        e.j = indexOf[e.j];
        patch.sheet.edges.push_back(e);
    }
    for (SheetBend b : whole.bends) {
        bool inside = isInside[b.centre];
        for (std::uint32_t k = b.first; k < b.last; ++k) inside = inside && isInside[whole.ring[k]];
        if (!inside) continue;
        const auto first = static_cast<std::uint32_t>(patch.sheet.ring.size());
        for (std::uint32_t k = b.first; k < b.last; ++k) {
            patch.sheet.ring.push_back(indexOf[whole.ring[k]]);
            patch.sheet.ringShare.push_back(whole.ringShare[k]);
            patch.sheet.ringMass.push_back(whole.ringMass[k]);
        }
        b.centre = indexOf[b.centre];
        b.first = first;
        b.last = static_cast<std::uint32_t>(patch.sheet.ring.size());
        patch.sheet.bends.push_back(b);
    }
    return patch;
}

} // namespace tss
