#include "BodyNodes.h"

#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/NodePaths.h"
#include "osgTSS/src/UserValues.h"

#include <osg/ValueObject>
#include <osgAnimation/MorphGeometry>
#include <osgTSS/Convert>

namespace osgTSS {

namespace {

const char* const tagName = "osgTSS:body";
const char* const scaleName = "osgTSS:bodyScale";
const char* const carrierName = "osgTSS:carrier";

/// A mesh of morph targets has stayed in its place, before what is drawn instead: in a copy of the graph it
/// is that one which plays, not what the other one remembers. Any other drawable itself.
osg::Drawable* morphBefore(osg::Drawable& shown, osg::Drawable& remembered) {
    if (!dynamic_cast<osgAnimation::MorphGeometry*>(&remembered)) return &remembered;
    for (osg::Group* parent : shown.getParents())
        for (unsigned int k = parent->getChildIndex(&shown); k-- > 0;) {
            auto* morph = dynamic_cast<osgAnimation::MorphGeometry*>(parent->getChild(k));
            if (morph && morph->getName() == remembered.getName()) return morph;
        }
    return &remembered;
}

} // namespace

void tagBody(osg::Node& node, const std::string& bodyPath, double scale) {
    node.setUserValue(tagName, bodyPath);
    if (scale != 1) node.setUserValue(scaleName, scale);
}

std::string bodyPath(const osg::Node& node) {
    std::string path;
    node.getUserValue(tagName, path);
    return path;
}

double bodyScale(const osg::Node& node) {
    double scale = 1;
    node.getUserValue(scaleName, scale);
    return scale;
}

osg::Drawable* replacedBy(osg::Drawable& drawable) {
    osg::Drawable* replaced =
        dynamic_cast<SkinGeometry*>(&drawable) ? userObjectOf<osg::Drawable>(drawable) : nullptr;
    return replaced ? morphBefore(drawable, *replaced) : nullptr;
}

void tagCarrier(SkinGeometry& skin, const std::string& bodyPath) {
    skin.setUserValue(carrierName, bodyPath);
}

std::string carrierPath(const SkinGeometry& skin) {
    std::string path;
    skin.getUserValue(carrierName, path);
    return path;
}

BodyFrame BodyNodes::frame(const std::string& body) const {
    const auto found = frames.find(body);
    return found == frames.end() ? BodyFrame{} : found->second;
}

SkinGeometry* BodyNodes::shape(const std::string& body) const {
    const auto found = shapes.find(body);
    return found == shapes.end() ? nullptr : found->second;
}

BodyNodes findBodyNodes(osg::Node& root) {
    BodyNodes found;
    eachNode(root, [&](osg::Node& node) {
        if (auto* shape = dynamic_cast<SkinGeometry*>(&node)) found.shapes.emplace(shape->getPath(), shape);
        const std::string path = bodyPath(node);
        if (!path.empty()) found.frames.emplace(path, BodyFrame{&node, bodyScale(node)});
    });
    return found;
}

std::optional<osg::Matrixd> toAbove(osg::Node& owner, osg::Node& node) {
    const osg::NodePathList paths = pathsFrom(owner, node);
    return paths.empty() ? std::nullopt : std::optional(alongPath(paths.front()));
}

tss::Pose carriedSince(const osg::Matrixd& world, const osg::Matrixd& toFrame, double scale,
                       const tss::Pose& restInverse) {
    constexpr double rounding = 1e-12, blended = 0.1; // bones between matrices as keys, which shear a little
    const auto now = toSimilarity(world * toFrame, blended);
    if (!now) return tss::Pose::Identity();
    tss::Pose inFrame = now->pose;
    inFrame.translation() *= scale;
    const tss::Pose moved = inFrame * restInverse;
    const double size = 1 + inFrame.translation().cwiseAbs().maxCoeff();
    const bool still =
        (moved.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() <= rounding * size;
    return still ? tss::Pose::Identity() : moved;
}

} // namespace osgTSS
