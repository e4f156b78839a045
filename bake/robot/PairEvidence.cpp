#include "bake/robot/PairEvidence.h"

#include "bake/base/Error.h"
#include "bake/geometry/ConnectedParts.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/JointGraph.h"
#include "bake/model/SourceHash.h"
#include "bake/search/SampledSearch.h"
#include "bake/table/Query.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <set>

namespace tss {

namespace {

/// The values of a pair's chain, in the order of its motion.
std::string poseText(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const std::vector<double>& q) {
    std::string text;
    std::size_t k = 0;
    for (int index : pair.joints) {
        const Joint& joint = scene.joints[index];
        for (std::size_t i = 0; i < joint.dofs.size(); ++i, ++k) {
            const bool turns = motion.dofs[k].kind == DofKind::Rotation;
            text += (text.empty() ? "" : ", ") + primName(joint.path) +
                    (joint.dofs.size() > 1 ? ":" + motion.dofs[k].name : "") +
                    fmt::format(" {:.6g}", turns ? q[k] * 180 / std::numbers::pi : q[k]);
        }
    }
    return text;
}

/// Two meshes and how far they are apart at poses.
class Meshes {
public:
    Meshes(const TriangleMesh& a, const TriangleMesh& b)
        : ofA_(pointOfEachPart(a)), ofB_(pointOfEachPart(b)), queryA_(a), queryB_(b) {}

    /// Of the surfaces; 0 where they cross or a part of one lies in the other.
    double distance(const Pose& bToA) const {
        const double surfaces = queryA_.distanceTo(queryB_, bToA);
        const auto inOther = [](const std::vector<Vec3>& points, const Pose& toOther,
                                const MeshQuery& other) {
            return std::ranges::any_of(points, [&](const Vec3& p) { return other.inside(toOther * p); });
        };
        if (surfaces == 0 || inOther(ofB_, bToA, queryA_) ||
            inOther(ofA_, bToA.inverse(Eigen::Isometry), queryB_))
            return 0;
        return surfaces;
    }

private:
    static std::vector<Vec3> pointOfEachPart(const TriangleMesh& mesh) {
        std::vector<Vec3> points;
        for (const TriangleMesh& part : connectedParts(mesh)) points.push_back(part.vertices.front());
        return points;
    }

    std::vector<Vec3> ofA_, ofB_;
    MeshQuery queryA_, queryB_;
};

struct Tried {
    double distance = std::numeric_limits<double>::infinity();
    std::vector<double> q;
};

/// Downhill one DOF at a time, with steps that halve.
void descend(const Meshes& meshes, const Motion& motion, Tried& at) {
    for (double step = 1.0 / 16; step > 1e-4 && at.distance > 0; step /= 2)
        for (std::size_t k = 0; k < at.q.size(); ++k)
            for (double sign : {-1.0, 1.0}) {
                Tried next = at;
                next.q[k] += sign * step * (motion.dofs[k].upper - motion.dofs[k].lower);
                if (!withinLimits(motion, next.q)) continue;
                next.distance = meshes.distance(pose(motion, next.q));
                if (next.distance < at.distance) at = next;
            }
}

/// A pose where the meshes meet, or the one where they came nearest.
Tried nearestPose(const Meshes& meshes, const Motion& motion, const Table* table) {
    constexpr std::size_t samples = 4000, measured = 400, descents = 8;
    Tried rest{0, restValues(motion)};
    rest.distance = meshes.distance(pose(motion, rest.q));
    std::vector<Tried> tried{rest};
    std::vector<std::vector<double>> poses = exploredPoses(motion, table ? samples : measured, 1);
    if (table) { // the poses that the table calls the deepest
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t i = 0; i < poses.size(); ++i) order.emplace_back(query(*table, poses[i]).gap, i);
        std::ranges::sort(order);
        std::vector<std::vector<double>> best;
        for (std::size_t i = 0; i < std::min(measured, order.size()); ++i)
            best.push_back(poses[order[i].second]);
        poses = std::move(best);
    }
    for (std::vector<double>& q : poses) {
        if (tried.back().distance == 0) return tried.back();
        Tried next{0, std::move(q)};
        next.distance = meshes.distance(pose(motion, next.q));
        tried.push_back(std::move(next));
    }
    const auto nearer = [](const Tried& a, const Tried& b) { return a.distance < b.distance; };
    std::ranges::sort(tried, nearer);
    tried.resize(std::min(tried.size(), descents));
    for (Tried& one : tried) {
        descend(meshes, motion, one);
        if (one.distance == 0) return one;
    }
    return *std::ranges::min_element(tried, nearer);
}

class Collector {
public:
    explicit Collector(const SceneModel& scene) : scene_(scene), graph_(scene.joints) {
        for (const Pair& pair : scene.pairs) addPair(pair);
        const int count = static_cast<int>(scene.bodies.size());
        for (int a = 0; a < count; ++a) {
            if (scene.bodies[a].mesh.empty()) continue;
            const std::set<int> joined = joinedTo(a);
            for (int b = a + 1; b < count; ++b)
                if (!scene.bodies[b].mesh.empty()) addOther(a, b, joined.contains(b));
        }
    }

    std::vector<PairEvidence> all() const {
        std::vector<PairEvidence> list;
        for (const auto& [bodies, evidence] : found_) list.push_back(evidence);
        return list;
    }

private:
    /// The bodies with geometry that joints lead to, directly or through bodies without.
    std::set<int> joinedTo(int body) const {
        std::set<int> seen{body}, joined;
        std::vector<int> front{body};
        while (!front.empty()) {
            const int at = front.back();
            front.pop_back();
            for (const Joint& joint : scene_.joints) {
                if (!joint.enabled || (joint.body0 != at && joint.body1 != at)) continue;
                const int next = joint.body0 == at ? joint.body1 : joint.body0;
                if (next < 0 || !seen.insert(next).second) continue;
                if (scene_.bodies[next].mesh.empty())
                    front.push_back(next);
                else
                    joined.insert(next);
            }
        }
        return joined;
    }

    PairEvidence& at(int a, int b) {
        PairEvidence& evidence = found_[std::minmax(a, b)];
        evidence.bodyA = std::min(a, b);
        evidence.bodyB = std::max(a, b);
        return evidence;
    }

    void addPair(const Pair& pair) {
        for (const int body : {pair.bodyA, pair.bodyB})
            if (scene_.bodies[body].mesh.empty())
                throw InputError(Where{"", "", scene_.bodies[body].path},
                                 "expected a mesh, the body has none");
        requireFresh(scene_, pair, "");
        PairEvidence& evidence = at(pair.bodyA, pair.bodyB);
        evidence.baked = pair.table || pair.proof;
        evidence.adjacent = joinedTo(pair.bodyA).contains(pair.bodyB);
        if (pair.proof && pair.proof->restRegion.empty()) {
            evidence.verdict = Meeting::Never;
            evidence.clearance = pair.proof->clearance;
            return;
        }
        const Meshes meshes(scene_.bodies[pair.bodyA].mesh, scene_.bodies[pair.bodyB].mesh);
        const Motion motion = pairMotion(scene_, pair);
        const Tried nearest = nearestPose(meshes, motion, pair.table.get());
        evidence.verdict = nearest.distance == 0 ? Meeting::Meets : Meeting::Open;
        evidence.clearance = nearest.distance;
        evidence.pose = poseText(scene_, pair, motion, nearest.q);
    }

    /// Bodies that are no pair: they do not move against each other, or nobody asked.
    void addOther(int a, int b, bool joined) {
        if (found_.contains({a, b})) return;
        const auto chain = graph_.chain(a, b);
        const bool rigid = chain && !chain->empty() &&
                           std::ranges::all_of(*chain, [&](int j) { return scene_.joints[j].dofs.empty(); });
        if (!rigid && !joined) return;
        PairEvidence& evidence = at(a, b);
        evidence.adjacent = joined;
        if (!rigid) return;
        Pair fixed;
        fixed.bodyA = a;
        fixed.bodyB = b;
        fixed.joints = *chain;
        const Pose bToA = pose(pairMotion(scene_, fixed), std::vector<double>());
        evidence.clearance = Meshes(scene_.bodies[a].mesh, scene_.bodies[b].mesh).distance(bToA);
        evidence.verdict = evidence.clearance > 0 ? Meeting::Never : Meeting::Always;
    }

    const SceneModel& scene_;
    const JointGraph graph_;
    std::map<std::pair<int, int>, PairEvidence> found_;
};

} // namespace

std::string originalName(const Body& body) {
    return body.displayName.empty() ? primName(body.path) : body.displayName;
}

std::vector<PairEvidence> evidenceOf(const SceneModel& scene) {
    return Collector(scene).all();
}

} // namespace tss
