#pragma once
#include "bake/motion/MotionBound.h"
#include "tests/search/Scenes.h"

#include <vector>

/// Chains of all kinds of DOFs, and cells of their values, that bounds of motion are held against.
namespace cells {

using namespace tss;

inline Motion randomChain(scenes::Random& random, int dofs) {
    Motion motion;
    for (int k = 0; k < dofs; ++k) switch (random.below(3)) {
        case 0:
            motion.dofs.push_back(joints::turn(random.inBox(2), random.direction(), -4, 4));
            break;
        case 1:
            motion.dofs.push_back(joints::slide(random.in(0.1, 3) * random.direction(), -2, 2));
            break;
        default:
            motion.dofs.push_back(
                scenes::path(random, 2 + random.below(6), random.in(0, 0.5), random.in(0, 3)));
        }
    motion.base.translation() = random.inBox(1);
    return motion;
}

inline Cell randomCell(scenes::Random& random, const Motion& motion) {
    Cell cell;
    const double size = std::pow(10.0, random.in(-3, 0));
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        const Dof& dof = motion.dofs[k];
        const double width = random.below(8) ? size * (dof.upper - dof.lower) * random.in(0.1, 1) : 0;
        cell.lower[k] = random.in(dof.lower, dof.upper - width);
        cell.upper[k] = cell.lower[k] + width;
    }
    return cell;
}

/// As a search comes by it: cut again and again where it cuts, at the knots of paths too.
inline Cell cutCell(scenes::Random& random, const Motion& motion) {
    Cell cell;
    const MotionRates rates(motion);
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        cell.lower[k] = motion.dofs[k].lower;
        cell.upper[k] = motion.dofs[k].upper;
        for (int cuts = random.below(8); cuts > 0; --cuts)
            (random.below(2) ? cell.lower : cell.upper)[k] = rates.cut(k, cell.lower[k], cell.upper[k]);
    }
    return cell;
}

/// Values in the cell, often at its ends: there bounds fail first.
inline std::vector<double> inside(scenes::Random& random, const Cell& cell, std::size_t dofs) {
    std::vector<double> q;
    for (std::size_t k = 0; k < dofs; ++k) switch (random.below(4)) {
        case 0:
            q.push_back(cell.lower[k]);
            break;
        case 1:
            q.push_back(cell.upper[k]);
            break;
        default:
            q.push_back(random.in(cell.lower[k], cell.upper[k]));
        }
    return q;
}

} // namespace cells
