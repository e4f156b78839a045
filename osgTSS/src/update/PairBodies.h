#pragma once
#include "bake/model/SceneModel.h"
#include "bake/motion/MayMeet.h"

#include <osg/Node>
#include <osgTSS/ConstraintVisitor>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgTSS {

/// The bodies of the pairs that have tables or proofs, as a graph holds them now, and what else in the graph
/// could come to them.
class PairBodies {
public:
    PairBodies(osg::Node& root, const tss::SceneModel& model);

    /// Whether what hangs at the end of a path from the root is part of a body of a pair.
    bool hold(const osg::NodePath& path) const;

    /// Whether a node, which hangs at the end of the path, carries one body of a pair and not the other, or
    /// draws, itself and below, what may touch at some pose a body of a pair that it is no part of and does
    /// not carry, or carries a joint that makes no body as it stands now. What moves by itself, without being
    /// a joint, no pair reaches, and is not looked at.
    bool mayBeMetBy(osg::Node& node, const osg::NodePath& above);

private:
    struct Shape {
        tss::MeshQuery surface;
        tss::BallAbout ball;

        explicit Shape(const tss::TriangleMesh& mesh) : surface(mesh), ball(mesh) {}
    };

    int bodyAt(const osg::NodePath& path, osg::Matrixd& toBody) const;
    bool isNamed(int body, const std::string& path, const tss::Joint* movedBy) const;
    bool isBelow(int body, osg::Node& node) const;
    bool loses(osg::Node& node) const;
    bool meets(int body, const tss::TriangleMesh& part, const std::set<int>& others);

    ConstraintVisitor _visitor;
    const tss::SceneModel& _now;
    std::map<const osg::Node*, int> _bodyOf;
    std::vector<std::pair<int, int>> _pairs; ///< bodies of the graph
    std::map<int, Shape> _shapes;
};

} // namespace osgTSS
