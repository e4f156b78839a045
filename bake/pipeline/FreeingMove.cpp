#include "bake/pipeline/FreeingMove.h"

#include "bake/pipeline/FreeingTrial.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace tss {

namespace {

/// Lengths of shifts as shares of the smaller body's diagonal: the first that is tried, and the longest.
constexpr double firstShare = 1e-3, lastShare = 0.1;
constexpr double lengthening = 1.3; ///< factor from one length to the next

/// Unit shifts from the centre of a cube to its faces, edges and corners.
std::vector<JointMove> directions() {
    std::vector<JointMove> all;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x || y || z) {
                    JointMove move = JointMove::Zero();
                    move.head<3>() = Vec3(x, y, z).normalized();
                    all.push_back(move);
                }
    return all;
}

/// The shortest shift tried that frees all wanted poses; where none does, the one that frees most of them.
/// all: whether it frees all.
JointMove firstShift(const FreeingTrial& trial, const std::vector<char>& wanted, bool& all) {
    const auto count = static_cast<std::size_t>(std::ranges::count(wanted, char{1}));
    JointMove best = JointMove::Zero();
    std::size_t reached = trial.countFree(best, wanted);
    for (double length = firstShare * trial.size();
         length <= lastShare * trial.size() && reached < count && !trial.late(); length *= lengthening) {
        JointMove now = JointMove::Zero();
        for (const JointMove& direction : directions()) {
            const std::size_t free = trial.countFree(length * direction, wanted);
            if (free > reached) reached = free, now = length * direction;
        }
        if (!now.isZero()) best = now;
    }
    all = reached == count;
    return best;
}

/// Improves a move by random steps that become shorter where they do not help: first it shall free more of
/// the wanted poses, then be smaller. axes: the axes may be moved too. all: whether it frees all.
JointMove improved(FreeingTrial& trial, const std::vector<char>& wanted, const JointMove& first, bool axes,
                   bool& all) {
    constexpr int tries = 400;
    constexpr double axesWeight = 0.1; // moving the axes costs something of its own
    const auto cost = [&](const JointMove& move) {
        return std::hypot(trial.displacement(move), axesWeight * move.tail<3>().norm());
    };
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    const auto count = static_cast<std::size_t>(std::ranges::count(wanted, char{1}));
    JointMove best = first;
    std::size_t reached = all ? count : trial.countFree(first, wanted);
    double least = cost(best), step = 0.3 * std::max(first.head<3>().norm(), firstShare * trial.size());
    const double finest = 1e-3 * step, farthest = lastShare * trial.size();
    for (int k = 0; k < tries && step > finest && !trial.late(); ++k) {
        JointMove move = best;
        // A step, and all of it a little shorter.
        for (int i = 0; i < 3; ++i) move[i] += step * normal(random);
        if (axes)
            for (int i = 3; i < 6; ++i) move[i] += 2 * step * normal(random);
        else
            move *= 1 - 0.05 * std::abs(normal(random));
        if (cost(move) > farthest || (reached == count && cost(move) >= least)) continue;
        std::size_t free = reached;
        const bool isBetter = reached == count ? trial.frees(move, wanted)
                                               : (free = trial.countFree(move, wanted)) > reached ||
                                                     (free == reached && cost(move) < least);
        if (isBetter) {
            best = move;
            least = cost(best);
            reached = free;
            step *= 1.5;
        } else {
            step *= 0.95;
        }
    }
    all = reached == count;
    return best;
}

/// Lengthens a move by the least of some factors with which it frees all wanted poses. False: none does.
bool lengthened(FreeingTrial& trial, const std::vector<char>& wanted, JointMove& move) {
    for (const double factor : {1.0, 1.02, 1.05, 1.1, 1.2, 1.4}) {
        if (!trial.frees(factor * move, wanted)) continue;
        move *= factor;
        return true;
    }
    return false;
}

/// Where all axes are parallel, removes the part of their shift along them, which changes nothing.
void removeSliding(const Motion& motion, JointMove& move) {
    Vec3 common = Vec3::Zero();
    for (const Dof& dof : motion.dofs) {
        if (dof.kind != DofKind::Rotation) continue;
        const Vec3 axis = dof.axis.normalized();
        if (!common.isZero() && common.cross(axis).norm() > 1e-9) return;
        common = axis;
    }
    move.tail<3>() -= common * common.dot(move.tail<3>());
}

/// A small move that frees the wanted poses, and poses between them. move: one to start from, or zero.
JointMove smallMove(FreeingTrial& trial, std::vector<char>& wanted, JointMove move, bool axes) {
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
        bool all = !move.isZero() && lengthened(trial, wanted, move);
        if (!all && !axes) move = firstShift(trial, wanted, all);
        if (all || axes) move = improved(trial, wanted, move, axes, all);
        if (!all || trial.late() || trial.addBlocked(move, wanted) == 0) break;
    }
    return move;
}

} // namespace

FreeingMoves freeingMoves(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                          const FreeingOptions& options) {
    FreeingMoves found;
    FreeingTrial trial(a, b, motion, options.seconds);
    if (!trial.overlapsAtRest()) {
        found.elsewhere = trial.touchingElsewhere();
        return found;
    }
    found.apart = trial.apartElsewhere();
    std::vector<char> wanted;
    for (const char stop : trial.stops()) wanted.push_back(!stop);
    JointMove move = smallMove(trial, wanted, JointMove::Zero(), false);
    found.complete = !trial.late();
    if (move.isZero()) return found;
    std::vector<FreeingMove>& moves = found.moves;
    moves.push_back(trial.measured(move));
    if (options.axes && found.complete) {
        move = smallMove(trial, wanted, move, true);
        removeSliding(motion, move);
        // Where it helps little the axes stay.
        const FreeingMove turned = trial.measured(move);
        if (turned.free > moves.front().free || turned.moved < 0.9 * moves.front().moved)
            moves.push_back(turned);
        found.complete = !trial.late();
    }
    std::erase_if(moves, [](const FreeingMove& m) { return m.free == 0; });
    std::ranges::sort(moves, [](const FreeingMove& x, const FreeingMove& y) {
        return x.free + x.stops != y.free + y.stops ? x.free + x.stops > y.free + y.stops : x.moved < y.moved;
    });
    return found;
}

} // namespace tss
