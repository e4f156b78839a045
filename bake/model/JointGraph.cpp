#include "bake/model/JointGraph.h"

#include <algorithm>
#include <map>

namespace tss {

namespace {

/// The shortest way by breadth first, `without` one joint.
std::vector<int> findWay(const std::vector<Joint>& joints, int from, int to, int without) {
    std::map<int, int> arrivedBy{{from, -1}}; // body -> joint
    std::vector<int> front{from};
    for (std::size_t i = 0; i < front.size() && !arrivedBy.contains(to); ++i)
        for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
            const Joint& joint = joints[j];
            if (j == without || !joint.enabled || joint.body0 == joint.body1) continue;
            if (joint.body0 != front[i] && joint.body1 != front[i]) continue;
            const int next = joint.body0 == front[i] ? joint.body1 : joint.body0;
            if (arrivedBy.emplace(next, j).second) front.push_back(next);
        }
    std::vector<int> way;
    if (!arrivedBy.contains(to)) return way;
    for (int body = to; body != from;) {
        const int j = arrivedBy[body];
        way.push_back(j);
        body = joints[j].body0 == body ? joints[j].body1 : joints[j].body0;
    }
    std::reverse(way.begin(), way.end());
    return way;
}

} // namespace

std::optional<std::vector<int>> findChain(const std::vector<Joint>& joints, int bodyA, int bodyB) {
    const std::vector<int> way = findWay(joints, bodyA, bodyB, -1);
    // The way is the only one just when none of its joints can be gone round.
    for (int joint : way)
        if (!findWay(joints, bodyA, bodyB, joint).empty()) return std::nullopt;
    return way;
}

} // namespace tss
