#include "bake/model/JointGraph.h"
#include "bake/scene/SceneReading.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

bool readBodiesOfPrim(const SceneReading& reading, const PrimReader& prim, Pair& pair) {
    const auto paths = prim.targets(schema::bodies);
    if (paths.size() != 2 || paths[0] == paths[1]) {
        prim.problem("expected a joint, or a relationship tss:bodies that names two bodies");
        return false;
    }
    pair.bodyA = reading.body(prim, schema::bodies, paths[0]);
    pair.bodyB = reading.body(prim, schema::bodies, paths[1]);
    if (pair.bodyA < 0 || pair.bodyB < 0) return false;
    const auto chain = findChain(reading.scene.joints, pair.bodyA, pair.bodyB);
    const Place place = prim.placeOf(schema::bodies, "targetPaths");
    if (!chain)
        reading.problems.add(place, "expected one chain of joints from " + paths[0] + " to " + paths[1] +
                                        ", found more than one: a pair cannot be part of a closed loop");
    else if (chain->empty())
        reading.problems.add(place, "expected a chain of joints from " + paths[0] + " to " + paths[1] +
                                        ", found none");
    else
        pair.joints = *chain;
    return chain && !chain->empty();
}

bool readBodiesOfJoint(const SceneReading& reading, const PrimReader& prim, Pair& pair) {
    const int index = reading.jointAt.at(pair.path);
    const Joint& joint = reading.scene.joints[index];
    pair.bodyA = joint.body0;
    pair.bodyB = joint.body1;
    pair.joints = {index};
    if (prim.prim().property(schema::bodies))
        reading.problems.add(prim.placeOf(schema::bodies), "expected tss:bodies on a prim that is no joint");
    if (pair.bodyA < 0 || pair.bodyB < 0)
        prim.problem("expected physics:body0 and physics:body1: a pair needs both");
    return pair.bodyA >= 0 && pair.bodyB >= 0;
}

void checkMeshes(const SceneReading& reading, const PrimReader& prim, const Pair& pair) {
    for (int body : {pair.bodyA, pair.bodyB})
        if (reading.scene.bodies[body].mesh.vertices.empty())
            prim.problem("expected two bodies with geometry, found none in " +
                         reading.scene.bodies[body].path);
}

/// Everything that a motion needs and that a joint alone may do without.
bool checkPairMotion(const SceneReading& reading, const PrimReader& prim, const Pair& pair) {
    for (int index : pair.joints) {
        const Joint& joint = reading.scene.joints[index];
        for (const Dof& dof : joint.dofs)
            if (!std::isfinite(dof.lower) || !std::isfinite(dof.upper)) {
                prim.problem("expected a lower and an upper limit for each DOF of a pair, found none for " +
                             dof.name + " of " + joint.path);
                return false;
            }
        try { // told with the joint whose limits they are, before they are one chain
            checkMotion(Motion{joint.dofs, Pose::Identity(), joint.planes});
        } catch (const InputError& error) {
            reading.reader(reading.index.find(joint.path)).problem(error.message);
            return false;
        }
    }
    try {
        checkMotion(pairMotion(reading.scene, pair));
    } catch (const InputError& error) {
        prim.problem(error.message);
        return false;
    }
    return true;
}

} // namespace

BakeSettings readSettings(const PrimReader& prim) {
    BakeSettings settings;
    const std::string prefix = schema::bakePrefix;
    for (const auto& [name, property] : prim.prim().properties) {
        if (!name.starts_with(prefix)) continue;
        std::string key = name.substr(prefix.size());
        std::replace(key.begin(), key.end(), '_', '-');
        const Attribute attribute{name.c_str(), "string", true};
        if (prim.value(attribute)) settings[key] = prim.text(attribute, "");
    }
    return settings;
}

void readPairs(SceneReading& reading) {
    for (std::size_t i = 0; i < reading.index.entries.size(); ++i) {
        if (!hasApi(*reading.index.entries[i].prim, "TssPairAPI")) continue;
        if (!reading.ownPrim(static_cast<int>(i), "TssPairAPI")) continue;
        const PrimReader prim = reading.reader(static_cast<int>(i));
        Pair pair;
        pair.path = prim.place().path;
        pair.settings = readSettings(prim);
        const bool tied = reading.jointAt.contains(pair.path) ? readBodiesOfJoint(reading, prim, pair)
                                                              : readBodiesOfPrim(reading, prim, pair);
        if (!tied) continue;
        checkMeshes(reading, prim, pair);
        if (checkPairMotion(reading, prim, pair)) reading.scene.pairs.push_back(std::move(pair));
    }
}

} // namespace tss
