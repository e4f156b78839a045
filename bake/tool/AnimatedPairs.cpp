#include "bake/tool/AnimatedPairs.h"

#include "bake/base/Words.h"
#include "bake/pipeline/FirstLook.h"

#include <fmt/format.h>

namespace tss::tool {

void keepPairsOfAnimation(RobotScene& made, bool near) {
    const std::vector<Body>& bodies = made.scene.bodies;
    std::vector<std::pair<int, int>> asked;
    for (const Pair& pair : made.scene.pairs) asked.emplace_back(pair.bodyA, pair.bodyB);
    for (const AllPairs::Unmade& none : made.unmade) asked.emplace_back(none.bodyA, none.bodyB);
    const std::vector<MotionContact> contacts = contactsInMotion(made.scene, asked);
    std::vector<std::string> held;
    std::size_t next = 0, far = 0;
    const auto areBones = [&](int a, int b) { return !bodies[a].visible && !bodies[b].visible; };
    std::erase_if(made.scene.pairs, [&](const Pair& pair) {
        const MotionContact& contact = contacts[next++];
        if (!areBones(pair.bodyA, pair.bodyB)) return false;
        if (contact.crossing >= 0.5)
            held.push_back(primName(bodies[pair.bodyA].path) + " and " + primName(bodies[pair.bodyB].path));
        else if (near && !contact.near)
            ++far;
        else
            return false;
        return true;
    });
    std::erase_if(made.unmade, [&](const AllPairs::Unmade& none) {
        const MotionContact& contact = contacts[next++];
        if (!areBones(none.bodyA, none.bodyB)) return false;
        return contact.crossing >= 0.5 || (near && !contact.near);
    });
    if (!held.empty())
        made.notes.push_back(
            "no pair: bones that the animation has in each other half of the time or more, by "
            "which they would be held: " +
            firstOf(held, 10));
    if (far > 0)
        made.notes.push_back(fmt::format(
            "left out: {} of bones that the animation never has nearer to each other than a ninth "
            "of the smaller one's size; --pairs all keeps them",
            counted(far, "pair")));
}

} // namespace tss::tool
