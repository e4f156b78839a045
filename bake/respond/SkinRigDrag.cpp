#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <limits>

namespace tss::rig {
namespace {

constexpr int dragSweeps = 150;
constexpr double dragTolerance = 5e-7; ///< change of a displacement in a sweep, in sizes of the skin

} // namespace

/// At one node after the other, outwards from activation 0: each is nearly a multiple of the one before.
void addDrag(const SkinRig& rig, const SheetPatch& patch, SkinMuscle& muscle) {
    SkinDrag& drag = muscle.drag;
    drag.vertices = patch.vertices;
    const std::size_t count = patch.vertices.size();
    drag.moves.assign(drag.nodes.size() * count, Move::Zero());
    std::vector<std::uint32_t> indexOf(rig.rest.size(), 0);
    for (std::uint32_t i = 0; i < count; ++i) indexOf[patch.vertices[i]] = i;

    const float tolerance = static_cast<float>(dragTolerance * rig.size);
    std::vector<SheetPlane> none;
    std::vector<Move> reference(count);
    const auto solveFrom = [&](std::size_t begin, std::size_t end, std::size_t step) {
        SkinSolver solver(patch.sheet);
        double before = 0;
        for (std::size_t n = begin; n != end; n += step) {
            const double a = drag.nodes[n];
            std::fill(reference.begin(), reference.end(), Move::Zero());
            const TrackPlace place = locate(muscle.skin.nodes, a);
            for (std::size_t i = 0; i < muscle.carried.size(); ++i) {
                const SkinCarry& c = muscle.carried[i];
                const Vec3 d = trackPosition(muscle.skin, place, i) - rig.rest[c.vertex];
                reference[indexOf[c.vertex]].head<3>() += c.pull * d.cast<float>();
            }
            if (before != 0) solver.scale(static_cast<float>(a / before));
            solver.solve(reference, none, dragSweeps, tolerance);
            std::copy(solver.displacements().begin(), solver.displacements().end(),
                      drag.moves.begin() + static_cast<std::ptrdiff_t>(n * count));
            before = a;
        }
    };
    const auto above = std::upper_bound(drag.nodes.begin(), drag.nodes.end(), 0.0) - drag.nodes.begin();
    solveFrom(static_cast<std::size_t>(above), drag.nodes.size(), 1);
    auto below = static_cast<std::size_t>(above);
    if (below > 0 && drag.nodes[below - 1] == 0) --below;
    solveFrom(below - 1, std::numeric_limits<std::size_t>::max(), std::numeric_limits<std::size_t>::max());
}

} // namespace tss::rig
