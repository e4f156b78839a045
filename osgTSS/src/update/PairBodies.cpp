#include "PairBodies.h"

#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/extract/FindQuietly.h"
#include "osgTSS/src/joints/JointNodes.h"

#include "bake/base/Error.h"
#include "bake/model/JointGraph.h"

#include <osg/Transform>
#include <osgTSS/Convert>
#include <osgTSS/JointTransform>

#include <algorithm>

namespace osgTSS {

PairBodies::PairBodies(osg::Node& root, const tss::SceneModel& model) : _now(findQuietly(root, _visitor)) {
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
    const tss::JointGraph graph(_now.joints);
    for (const tss::Pair& pair : model.pairs) {
        if (!pair.table && !pair.proof) continue;
        for (int a : standFor[pair.bodyA])
            for (int b : standFor[pair.bodyB])
                if (const auto chain = graph.chain(a, b); !chain || !chain->empty())
                    _pairs.emplace_back(a, b);
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
    return of && osgTSS::isBelow(*of, node);
}

/// Whether a joint with tables at or below a node is none as it stands now, as where it is sheared.
bool PairBodies::loses(osg::Node& node) const {
    bool lost = false;
    eachNode(node, [&](osg::Node& below) {
        lost = lost || (below.asTransform() && carriesJoint(below) && !_bodyOf.contains(&below));
    });
    return lost;
}

/// part: of `body`, in its frame.
bool PairBodies::meets(int body, const tss::TriangleMesh& part, const std::set<int>& others) {
    if (part.empty()) return false;
    const tss::MeshQuery surface(part);
    return std::ranges::any_of(others, [&](int other) {
        const auto chain = tss::findChain(_now.joints, body, other);
        if (!chain || chain->empty()) return false;
        tss::Pair pair;
        pair.bodyA = body;
        pair.bodyB = other;
        pair.joints = *chain;
        try {
            const Shape& shape = _shapes.try_emplace(other, _now.bodies[other].mesh).first->second;
            return tss::mayMeet(surface, shape.surface, shape.ball, tss::pairMotion(_now, pair));
        } catch (const tss::InputError&) {
            return true; // of more degrees of freedom nothing is known
        }
    });
}

bool PairBodies::mayBeMetBy(osg::Node& node, const osg::NodePath& above) {
    if (loses(node)) return true;
    std::set<int> others;
    for (const auto& [a, b] : _pairs) {
        if (isBelow(a, node) != isBelow(b, node)) return true;
        others.insert({a, b});
    }
    osg::Matrixd toBody;
    const int body = bodyAt(above, toBody);
    std::erase_if(others, [&](int other) { return other == body || isBelow(other, node); });
    for (int own = 0; own < static_cast<int>(_now.bodies.size()); ++own)
        if (isBelow(own, node) && meets(own, _now.bodies[own].mesh, others)) return true;
    ConstraintVisitor visitor;
    const std::vector<tss::Body>& found = findQuietly(node, visitor).bodies;
    if (found.empty()) return false;
    tss::TriangleMesh mesh = found[0].mesh; // which is part of the body that it hangs in
    const double scale = _visitor.getBodyNodes()[body].scale;
    for (tss::Vec3& vertex : mesh.vertices) vertex = scale * toCore(toOsg(vertex) * toBody);
    return meets(body, mesh, others);
}

} // namespace osgTSS
