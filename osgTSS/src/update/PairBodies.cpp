#include "PairBodies.h"

#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/extract/FindQuietly.h"
#include "osgTSS/src/joints/JointNodes.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"

#include <osg/Transform>
#include <osgTSS/Convert>
#include <osgTSS/JointTransform>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace osgTSS {

namespace {

/// Nothing for what no joints lead to.
std::optional<tss::Motion> motionBetween(const tss::SceneModel& model, int body, int other) {
    tss::Pair pair;
    pair.bodyA = body;
    pair.bodyB = other;
    const auto chain = tss::findChain(model.joints, body, other);
    if (!chain || (chain->empty() && body != other)) return std::nullopt;
    pair.joints = *chain;
    return tss::pairMotion(model, pair);
}

/// A surface that stays within reach of where it stands here.
struct Drawn {
    tss::TriangleMesh mesh;
    double reach = 0;
};

/// What is drawn at and below a node, in the frame of the body that it hangs in; joints of its own count by
/// how far they carry.
std::vector<Drawn> drawnAt(osg::Node& node, const osg::Matrixd& toBody, double scale) {
    constexpr double everywhere = 1e300;
    ConstraintVisitor visitor;
    const tss::SceneModel& model = findQuietly(node, visitor);
    const auto similarity = toSimilarity(toBody);
    std::vector<Drawn> found;
    for (std::size_t k = 0; k < model.bodies.size(); ++k) {
        Drawn part{model.bodies[k].mesh};
        if (part.mesh.empty()) continue;
        tss::Pose place = tss::Pose::Identity();
        try {
            const auto motion = motionBetween(model, 0, static_cast<int>(k));
            if (!motion) continue;
            const tss::Swept swept(tss::BallAbout(part.mesh), *motion);
            place = swept.middle;
            if (!motion->dofs.empty())
                part.reach = similarity ? swept.reach * std::abs(similarity->scale * scale) : everywhere;
        } catch (const tss::InputError&) {
            part.reach = everywhere; // more degrees of freedom than anything is known of
        }
        for (tss::Vec3& vertex : part.mesh.vertices)
            vertex = scale * toCore(toOsg(tss::Vec3(place * vertex)) * toBody);
        found.push_back(std::move(part));
    }
    return found;
}

} // namespace

PairBodies::PairBodies(osg::Node& root, const tss::SceneModel& model)
    : _root(root), _now(findQuietly(root, _visitor)) {
    const auto& nodes = _visitor.getBodyNodes();
    std::vector<const tss::Joint*> movedBy(model.bodies.size(), nullptr);
    for (const tss::Joint& joint : model.joints)
        if (joint.body1 >= 0) movedBy[joint.body1] = &joint;
    std::vector<std::vector<int>> standFor(model.bodies.size());
    for (int body = 0; body < static_cast<int>(_now.bodies.size()); ++body) {
        if (nodes[body].node) _bodyOf.emplace(nodes[body].node, body);
        for (std::size_t k = 0; k < model.bodies.size(); ++k)
            if (isNamed(body, model.bodies[k].path, movedBy[k])) standFor[k].push_back(body);
    }
    const tss::JointWays ways(_now.joints);
    for (const tss::Pair& pair : model.pairs) {
        if (!pair.table && !pair.proof) continue;
        for (int a : standFor[pair.bodyA])
            for (int b : standFor[pair.bodyB])
                if (const auto chain = ways.chain(a, b); !chain || !chain->empty()) _pairs.emplace_back(a, b);
    }
}

/// Bodies carry the model's names since install(); what no joint moves has no node of its own.
bool PairBodies::isNamed(int body, const std::string& path, const tss::Joint* movedBy) const {
    if (body == 0) return !movedBy;
    const osg::Node* node = _visitor.getBodyNodes()[body].node;
    if (const auto* joint = dynamic_cast<const JointTransform*>(node))
        return movedBy && joint->getJoint().path == movedBy->path;
    return node && bodyPath(*node) == path;
}

/// toBody: of what hangs at the end of the path.
int PairBodies::bodyAt(const osg::NodePath& path, osg::Matrixd& toBody) const {
    for (std::size_t k = path.size(); k-- > 0;)
        if (const auto found = _bodyOf.find(path[k]); found != _bodyOf.end()) {
            toBody = alongPath(osg::NodePath(path.begin() + k + 1, path.end()));
            return found->second;
        }
    toBody = alongPath(path);
    return 0;
}

bool PairBodies::hold(const osg::NodePath& path) const {
    osg::Matrixd toBody;
    const int body = bodyAt(path, toBody);
    return std::ranges::any_of(_pairs,
                               [&](const auto& pair) { return pair.first == body || pair.second == body; });
}

bool PairBodies::isBelow(int body, osg::Node& node) const {
    osg::Node* of = _visitor.getBodyNodes()[body].node;
    return of && !pathsFrom(node, *of).empty();
}

bool PairBodies::separatedBy(osg::Node& node) const {
    return std::ranges::any_of(
        _pairs, [&](const auto& pair) { return isBelow(pair.first, node) != isBelow(pair.second, node); });
}

const PairBodies::Shape& PairBodies::shapeOf(int body) {
    std::unique_ptr<Shape>& made = _shapes[body];
    const tss::TriangleMesh& mesh = _now.bodies[body].mesh;
    if (!made) made.reset(new Shape{tss::MeshQuery(mesh), tss::BallAbout(mesh)});
    return *made;
}

/// surface: part of `body`, in its frame.
bool PairBodies::meets(int body, int other, const tss::MeshQuery& surface, double margin) {
    try {
        const auto motion = motionBetween(_now, body, other);
        const Shape& shape = shapeOf(other);
        return motion && tss::mayMeet(surface, shape.surface, shape.ball, *motion, margin);
    } catch (const tss::InputError&) {
        return true; // of more degrees of freedom nothing is known
    }
}

bool PairBodies::mayBeMetBy(osg::Node& node, const osg::NodePath& above) {
    osg::Matrixd toBody;
    const int body = bodyAt(above, toBody);
    std::set<int> others;
    for (const auto& [a, b] : _pairs) others.insert({a, b});
    std::erase_if(others, [&](int other) { return other == body || isBelow(other, node); });
    const double scale = _visitor.getBodyNodes()[body].scale;
    return std::ranges::any_of(drawnAt(node, toBody, scale), [&](const Drawn& part) {
        const tss::MeshQuery surface(part.mesh);
        return std::ranges::any_of(others,
                                   [&](int other) { return meets(body, other, surface, part.reach); });
    });
}

} // namespace osgTSS
