#include "BodyNodes.h"

#include <osg/NodeVisitor>
#include <osg/ValueObject>
#include <osgTSS/Convert>

namespace osgTSS {

namespace {

const char* const tagName = "osgTSS:body";
const char* const scaleName = "osgTSS:bodyScale";

class FindBodyNodes : public osg::NodeVisitor {
public:
    FindBodyNodes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        std::string path;
        if (auto* shape = dynamic_cast<SkinGeometry*>(&node)) found.shapes.emplace(shape->getPath(), shape);
        double scale = 1;
        node.getUserValue(scaleName, scale);
        if (node.getUserValue(tagName, path)) found.frames.emplace(path, BodyFrame{&node, scale});
        traverse(node);
    }

    BodyNodes found;
};

} // namespace

void tagBody(osg::Node& node, const std::string& bodyPath, double scale) {
    node.setUserValue(tagName, bodyPath);
    if (scale != 1) node.setUserValue(scaleName, scale);
}

BodyNodes findBodyNodes(osg::Node& root) {
    FindBodyNodes visitor;
    root.accept(visitor);
    return visitor.found;
}

tss::Pose carriedSince(const osg::Matrixd& world, const osg::Matrixd& toFrame, const tss::Pose& restInverse) {
    constexpr double rounding = 1e-12;
    const auto now = toSimilarity(world * toFrame);
    if (!now) return tss::Pose::Identity();
    const tss::Pose moved = now->pose * restInverse;
    const double size = 1 + now->pose.translation().cwiseAbs().maxCoeff();
    const bool still =
        (moved.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() <= rounding * size;
    return still ? tss::Pose::Identity() : moved;
}

} // namespace osgTSS
