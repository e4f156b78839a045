#include "bake/model/JointGraph.h"

#include "bake/base/Order.h"

#include <algorithm>

namespace tss {

JointGraph::JointGraph(const std::vector<Joint>& joints) : only_(joints.size(), true) {
    int most = -1;
    for (const Joint& joint : joints) most = std::max({most, joint.body0, joint.body1});
    std::vector<std::vector<Step>> from(static_cast<std::size_t>(most + 2)); // each body, the world first
    for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
        const Joint& joint = joints[j];
        if (!joint.enabled || joint.body0 == joint.body1) continue;
        from[joint.body0 + 1].push_back({j, joint.body1 + 1});
        from[joint.body1 + 1].push_back({j, joint.body0 + 1});
    }
    const int bodies = static_cast<int>(from.size());
    above_.assign(from.size(), Step{-1, -1});
    depth_.assign(from.size(), -1);
    for (int root = 0; root < bodies; ++root) {
        if (depth_[root] >= 0) continue;
        depth_[root] = 0;
        std::vector<int> reached{root};
        for (std::size_t i = 0; i < reached.size(); ++i)
            for (const Step& step : from[reached[i]]) {
                if (depth_[step.body] >= 0) continue;
                depth_[step.body] = depth_[reached[i]] + 1;
                above_[step.body] = {step.joint, reached[i]};
                reached.push_back(step.body);
            }
    }
    // A joint that is not in the forest closes a loop through all those in it between its two bodies.
    std::vector<int> top =
        indicesOf<int>(from.size()); // of each body, as far up as such loops have led already
    const auto climbed = [&](int body) {
        while (top[body] != body) body = top[body] = top[top[body]];
        return body;
    };
    for (int body = 0; body < bodies; ++body)
        for (const Step& step : from[body]) {
            if (step.joint == above_[body].joint || step.joint == above_[step.body].joint) continue;
            int a = climbed(body), b = climbed(step.body);
            while (a != b) {
                int& lower = depth_[a] > depth_[b] ? a : b;
                only_[above_[lower].joint] = false;
                top[lower] = above_[lower].body;
                lower = climbed(lower);
            }
        }
}

std::optional<std::vector<int>> JointGraph::chain(int bodyA, int bodyB) const {
    std::vector<int> way, back;
    int a = bodyA + 1, b = bodyB + 1;
    if (std::max(a, b) >= static_cast<int>(above_.size())) return way;
    while (a != b) {
        const bool fromA = depth_[a] >= depth_[b];
        const Step up = above_[fromA ? a : b];
        if (up.joint < 0) return std::vector<int>(); // two trees
        (fromA ? way : back).push_back(up.joint);
        (fromA ? a : b) = up.body;
    }
    way.insert(way.end(), back.rbegin(), back.rend());
    if (!std::ranges::all_of(way, [&](int joint) { return only_[joint]; })) return std::nullopt;
    return way;
}

std::optional<std::vector<int>> findChain(const std::vector<Joint>& joints, int bodyA, int bodyB) {
    return JointGraph(joints).chain(bodyA, bodyB);
}

} // namespace tss
