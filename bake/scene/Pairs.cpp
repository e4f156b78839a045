#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"
#include "bake/scene/SceneParts.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr const char* loopFound = ", found more than one: a pair cannot be part of a closed loop";

bool readBodiesOfPrim(const SceneReading& reading, const JointGraph& graph, const PrimReader& prim,
                      Pair& pair) {
    const auto paths = prim.targets(schema::bodies);
    if (paths.size() != 2 || paths[0] == paths[1]) {
        prim.problem("expected a joint, or a relationship tss:bodies that names two bodies");
        return false;
    }
    pair.bodyA = reading.body(prim, schema::bodies, paths[0]);
    pair.bodyB = reading.body(prim, schema::bodies, paths[1]);
    if (pair.bodyA < 0 || pair.bodyB < 0) return false;
    const auto chain = graph.chain(pair.bodyA, pair.bodyB);
    if (!chain)
        prim.targetProblem(schema::bodies, "expected one chain of joints from ", paths[0], " to ", paths[1],
                           loopFound);
    else if (chain->empty())
        prim.targetProblem(schema::bodies, "expected a chain of joints from ", paths[0], " to ", paths[1],
                           ", found none");
    else
        pair.joints = *chain;
    return chain && !chain->empty();
}

bool readBodiesOfJoint(const SceneReading& reading, const JointGraph& graph, const PrimReader& prim,
                       Pair& pair) {
    const int index = reading.jointAt.at(pair.path);
    const Joint& joint = reading.scene.joints[index];
    pair.bodyA = joint.body0;
    pair.bodyB = joint.body1;
    pair.joints = {index};
    if (prim.has(schema::bodies))
        reading.problems.add(prim.placeOf(schema::bodies), "expected tss:bodies on a prim that is no joint");
    if (pair.bodyA < 0 || pair.bodyB < 0)
        prim.problem("expected physics:body0 and physics:body1: a pair needs both");
    else if (!joint.enabled)
        prim.problem("expected a joint that is enabled: the two bodies of a pair move by it");
    else if (!graph.chain(pair.bodyA, pair.bodyB))
        prim.problem("expected one chain of joints from ", reading.scene.bodies[pair.bodyA].path, " to ",
                     reading.scene.bodies[pair.bodyB].path, loopFound);
    else
        return true;
    return false;
}

void checkMeshes(const SceneReading& reading, const PrimReader& prim, const Pair& pair) {
    for (int body : {pair.bodyA, pair.bodyB})
        if (reading.scene.bodies[body].mesh.vertices.empty())
            prim.problem("expected two bodies with geometry, found none in ",
                         reading.scene.bodies[body].path);
}

/// What is proven of a pair is proven of one shape of its bodies and of one of its joints.
bool checkStill(const SceneReading& reading, const Pair& pair) {
    const auto fails = [&](int entry, std::string_view name) {
        reading.problems.add(
            reading.index.entries[entry].place.property(name) / "timeSamples",
            "expected a value that stays as it is, for it is of a pair, found one that changes "
            "in time");
        return false;
    };
    for (const int index : pair.joints) {
        const int entry = reading.index.find(reading.scene.joints[index].path);
        const std::string name = changingOf(*reading.index.entries[entry].prim);
        if (!name.empty()) return fails(entry, name);
    }
    for (const int body : {pair.bodyA, pair.bodyB}) {
        const int own = reading.index.find(reading.scene.bodies[body].path);
        for (int entry = own; entry >= 0; entry = reading.index.entries[entry].parent) {
            for (const auto& [name, property] : reading.index.entries[entry].prim->properties) {
                const bool shape =
                    name == "points" || name.starts_with("faceVertex") || name == "orientation";
                if (changes(property) && ((shape && entry == own) || name.starts_with("xformOp:scale")))
                    return fails(entry, name);
            }
            if (resetsXformStack(reading.reader(entry))) break;
        }
    }
    return true;
}

/// Everything that a motion needs and that a joint alone may do without.
bool checkPairMotion(const SceneReading& reading, const std::vector<int>& movers, const PrimReader& prim,
                     const Pair& pair) {
    for (int index : pair.joints) {
        const Joint& joint = reading.scene.joints[index];
        for (const Dof& dof : joint.dofs)
            if (!std::isfinite(dof.lower) || !std::isfinite(dof.upper)) {
                prim.problem("expected a lower and an upper limit for each DOF of a pair, found none for ",
                             dof.name, " of ", joint.path);
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
        requireMoved(reading.scene, pair, movers);
        checkMotion(pairMotion(reading.scene, pair));
    } catch (const InputError& error) {
        prim.problem(error.message);
        return false;
    }
    return true;
}

} // namespace

std::vector<SchemaType> pairSchemas() {
    return {{"TssPairAPI", {schema::bodies, schema::table}}};
}

BakeSettings readSettings(const PrimReader& prim) {
    BakeSettings settings;
    for (const auto& [name, property] : prim.prim().properties) {
        if (!name.starts_with(schema::bakePrefix)) continue;
        std::string key = name.substr(schema::bakePrefix.size());
        std::ranges::replace(key, '_', '-');
        const Attribute attribute{name, "string"};
        if (prim.value(attribute)) settings[key] = prim.text(attribute);
    }
    return settings;
}

void writeSettings(Prim& prim, const BakeSettings& settings) {
    std::erase_if(prim.properties,
                  [](const auto& property) { return property.first.starts_with(schema::bakePrefix); });
    for (const auto& [key, text] : settings) {
        std::string name = joined(schema::bakePrefix, key);
        std::ranges::replace(name, '-', '_');
        PrimWriter(prim).set(Attribute{name, "string", true}, Value(text));
    }
}

void readPairs(SceneReading& reading) {
    const auto isPair = [](const Prim& prim) { return hasApi(prim, "TssPairAPI"); };
    const JointGraph graph(reading.scene.joints);
    const std::vector<int> moving = movers(reading.scene);
    reading.forPrims(isPair, [&](const PrimReader& prim, int entry) {
        if (!reading.ownPrim(entry, "TssPairAPI")) return;
        Pair pair;
        pair.path = prim.place().path;
        pair.settings = readSettings(prim);
        const bool tied = reading.jointAt.contains(pair.path) ? readBodiesOfJoint(reading, graph, prim, pair)
                                                              : readBodiesOfPrim(reading, graph, prim, pair);
        if (!tied) return;
        checkMeshes(reading, prim, pair);
        if (checkStill(reading, pair) && checkPairMotion(reading, moving, prim, pair))
            reading.scene.pairs.push_back(std::move(pair));
    });
}

void checkCarried(const SceneReading& reading) {
    const SceneModel& scene = reading.scene;
    const std::vector<int> moving = movers(scene);
    const std::vector<bool> soft = softBodies(scene);
    for (const auto& [path, body] : reading.bodyAt) {
        if (scene.bodies[body].mesh.empty() || moving[body] >= 0 || soft[body]) continue;
        for (int at = reading.index.find(path); at >= 0 && !resetsXformStack(reading.reader(at));) {
            at = reading.index.entries[at].parent;
            const auto carrier = reading.bodyAt.find(at < 0 ? "" : reading.index.entries[at].place.path);
            if (carrier == reading.bodyAt.end() || moving[carrier->second] < 0) continue;
            for (const Pair& pair : scene.pairs)
                if (pair.bodyA == carrier->second || pair.bodyB == carrier->second)
                    reading.reader(reading.index.find(pair.path))
                        .problem("expected all of ", carrier->first,
                                 " in one mesh, or other meshes of it on "
                                 "joints of their own, found ",
                                 path, " inside of it, which no joint moves");
            break;
        }
    }
}

void writePair(Layer& layer, const SceneModel& scene, const Pair& pair) {
    const bool ofJoint = pair.joints.size() == 1 && scene.joints[pair.joints[0]].path == pair.path;
    PrimWriter prim(makePrim(layer, pair.path, "Scope"));
    addApi(prim.prim(), "TssPairAPI");
    if (!ofJoint) prim.setTargets(schema::bodies, pathsOf(scene.bodies, {pair.bodyA, pair.bodyB}));
    writeSettings(prim.prim(), pair.settings);
}

} // namespace tss
