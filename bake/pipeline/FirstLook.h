#pragma once
#include "bake/model/SceneModel.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tss {

/// Whether a pair has more than three joint values, as pairs of a whole arm do: spheres of the default
/// tolerance then take too long for a first look.
bool isLongChain(const SceneModel& scene, const Pair& pair);

/// How far apart the meshes of each pair are where the joints rest, scene units: 0 where they touch or
/// overlap, infinity where a body has no mesh. From a ninth of the smaller body's diagonal on it is only no
/// more than that, which is quick: room beyond makes no tolerance of setFirstTolerances() another.
std::vector<double> distancesAtRest(const SceneModel& scene);

/// How near the surfaces of two bodies come in the scene's own motion.
struct MotionContact {
    bool near = false;   ///< at some pose nearer than a ninth of the smaller body's diagonal
    double crossing = 0; ///< the share of the poses at which they cross

    bool holds() const { return crossing >= 0.5; }
};

/// The same of each two bodies, at the times of the drives' samples, or at 400 of them where there are more.
std::vector<MotionContact> contactsInMotion(const SceneModel& scene,
                                            std::span<const std::pair<int, int>> bodies);

/// Two bodies of a character, whose skin is drawn in their place.
bool areBones(const SceneModel& scene, int bodyA, int bodyB);

/// What pairForAnimation() left out.
struct PairsLeftOut {
    std::vector<std::string> held; ///< "LeftTip and RightTip"
    std::size_t far = 0;
};

/// Leaves of a character's pairs those that its animation asks for. Not two bones that it has in each other
/// half of the time or more: they would hold it all along, for what is cut out of one mesh lies in each other
/// where it bends. With `near` not those either that it never has near each other. The others are solid
/// (Inside::Contact): they swing into each other at the ends of their limits.
PairsLeftOut pairForAnimation(SceneModel& scene, bool near);

/// A thirtieth of the median body diagonal, rounded to one digit in millimetres; scene units.
double usualTolerance(const SceneModel& scene);

/// Where some pair is a long chain: gives each pair the tolerance of a first look, a length with its unit, as
/// its setting. About a thirtieth of the diagonal of its smaller body (toleranceNextTo()). But for bodies
/// that are not drawn, a character's bones, a hundredth where the two touch or overlap at rest, for what is
/// near that is exempt; and of pairs that are no long chains no more than three tenths of their distance at
/// rest, so that the spheres of both leave their joint some of it. None is finer than what a bake takes by
/// itself, a 500th.
void setFirstTolerances(SceneModel& scene, const std::vector<double>& distancesAtRest);

/// The budget, seconds per pair, with which baking all pairs of a scene takes some minutes.
double firstBudget(const SceneModel& scene);

} // namespace tss
