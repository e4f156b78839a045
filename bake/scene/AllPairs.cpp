#include "bake/scene/AllPairs.h"

#include "bake/base/Error.h"
#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/MotionBound.h"
#include "bake/scene/SceneParts.h"

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_set>

namespace tss {

namespace {

/// The bodies that may be of a pair. One that some enabled joint holds counts as rigid, as it does for pairs
/// that are named.
std::vector<int> collidingBodies(const SceneModel& scene) {
    const std::vector<bool> soft = softBodies(scene);
    std::vector<int> bodies;
    for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body)
        if (!scene.bodies[body].mesh.empty() && !soft[body] &&
            std::ranges::any_of(scene.joints, [body](const Joint& joint) {
                return joint.enabled && (joint.body0 == body || joint.body1 == body);
            }))
            bodies.push_back(body);
    return bodies;
}

/// Paths that prims have.
std::unordered_set<std::string> pathsOf(const SceneModel& scene) {
    std::unordered_set<std::string> paths;
    const auto take = [&](const auto& items) {
        for (const auto& item : items) paths.insert(item.path);
    };
    take(scene.bodies), take(scene.joints), take(scene.muscles), take(scene.pairs);
    return paths;
}

/// A path beside the first body that nothing has yet.
std::string freePath(const SceneModel& scene, const std::unordered_set<std::string>& paths,
                     const Pair& pair) {
    const std::string wanted = scene.bodies[pair.bodyA].path + "_" + primName(scene.bodies[pair.bodyB].path);
    std::string path = wanted;
    for (int k = 2; paths.contains(path) || (scene.layer && findPrim(*scene.layer, path)); ++k)
        path = wanted + std::to_string(k);
    return path;
}

/// Why a motion cannot be baked; empty when it can.
std::string obstacle(const SceneModel& scene, const Pair& pair, const std::vector<int>& movers) {
    try {
        requireMoved(scene, pair, movers);
        const Motion motion = pairMotion(scene, pair);
        checkMotion(motion);
        wholeBox(motion); // refuses chains that are too long
        return "";
    } catch (const InputError& error) {
        return error.message;
    }
}

/// The pair of two bodies, B the one that moves; nothing, perhaps with why, where they are none.
std::optional<Pair> pairOf(const SceneModel& scene, const JointGraph& graph, const std::vector<int>& movers,
                           int a, int b, std::vector<AllPairs::Unmade>& unmade) {
    const std::string both = scene.bodies[a].path + " and " + scene.bodies[b].path;
    const auto chain = graph.chain(a, b);
    if (!chain) {
        unmade.push_back({a, b, both + ": more than one chain of joints links them, a closed loop"});
        return std::nullopt;
    }
    Pair pair;
    pair.bodyA = a, pair.bodyB = b, pair.joints = *chain;
    std::size_t dofs = 0;
    for (int joint : *chain) dofs += scene.joints[joint].dofs.size();
    if (chain->empty() || dofs == 0) return std::nullopt;
    if (chain->size() == 1) {
        const Joint& joint = scene.joints[chain->front()];
        if (!joint.collisionEnabled) return std::nullopt;
        pair.bodyA = joint.body0, pair.bodyB = joint.body1;
        pair.path = joint.path;
    }
    std::string why = obstacle(scene, pair, movers);
    if (!why.empty() && chain->size() > 1) { // a path may be crossed in one direction only
        std::swap(pair.bodyA, pair.bodyB);
        std::ranges::reverse(pair.joints);
        if (obstacle(scene, pair, movers).empty()) why.clear();
    }
    if (!why.empty()) {
        unmade.push_back({a, b, both + ": " + why});
        return std::nullopt;
    }
    return pair;
}

} // namespace

AllPairs addAllPairs(SceneModel& scene) {
    AllPairs result;
    const std::vector<int> bodies = collidingBodies(scene);
    const std::size_t first = scene.pairs.size();
    const JointGraph graph(scene.joints);
    const std::vector<int> moving = movers(scene);
    std::unordered_set<std::string> paths = pathsOf(scene);
    std::set<std::pair<int, int>> known;
    for (const Pair& pair : scene.pairs) known.insert(std::minmax(pair.bodyA, pair.bodyB));
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t j = i + 1; j < bodies.size(); ++j) {
            if (known.contains({bodies[i], bodies[j]})) continue;
            std::optional<Pair> pair = pairOf(scene, graph, moving, bodies[i], bodies[j], result.unmade);
            if (!pair) continue;
            if (pair->path.empty()) pair->path = freePath(scene, paths, *pair);
            paths.insert(pair->path);
            result.added.push_back(pair->path);
            scene.pairs.push_back(std::move(*pair));
        }
    if (!scene.layer || result.added.empty()) return result;
    Layer layer = *scene.layer;
    for (std::size_t k = first; k < scene.pairs.size(); ++k) writePair(layer, scene, scene.pairs[k]);
    scene.layer = std::make_shared<const Layer>(std::move(layer));
    return result;
}

} // namespace tss
