#pragma once
#include "bake/motion/Motion.h"

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/observer_ptr>
#include <osgTSS/SkinGeometry>

#include <map>
#include <optional>
#include <string>

namespace osgTSS {

/// Names the body whose frame a node's children are in, and the factor from their lengths to the body's
/// (negative: mirrored). User values, saved and cloned with the node.
void tagBody(osg::Node& node, const std::string& bodyPath, double scale = 1);

/// The body that a node was tagged with; empty: none.
std::string bodyPath(const osg::Node& node);

/// The factor that a node was tagged with.
double bodyScale(const osg::Node& node);

/// The body that carries the skin as a whole: what is part of it too never moves against the skin, wherever
/// the application takes both.
void tagCarrier(SkinGeometry& skin, const std::string& bodyPath);
std::string carrierPath(const SkinGeometry& skin);

/// The drawable that install() has put this one in place of; null: none.
osg::Drawable* replacedBy(osg::Drawable& drawable);

/// Where the coordinates of a body are in a graph.
struct BodyFrame {
    osg::observer_ptr<osg::Node> node; ///< whose children are in them; null: the graph names none
    double scale = 1;                  ///< from the lengths there to the body's
};

/// What shows bodies at and below a node, by the bodies' paths; of several the first. Sees masked nodes.
struct BodyNodes {
    std::map<std::string, BodyFrame> frames;
    std::map<std::string, SkinGeometry*> shapes;

    BodyFrame frame(const std::string& body) const;
    SkinGeometry* shape(const std::string& body) const; ///< null: there is none
};
BodyNodes findBodyNodes(osg::Node& root);

/// From a node's children to what the owner hangs in; nothing where the node is not below the owner.
std::optional<osg::Matrixd> toAbove(osg::Node& owner, osg::Node& node);

/// How far a node has been carried since rest, in a frame; exactly nothing for less than rounding, and where
/// there is no telling. world: of the node; toFrame: from the world; scale: from the frame's lengths to the
/// pose's; restInverse: frame to node, at rest.
tss::Pose carriedSince(const osg::Matrixd& world, const osg::Matrixd& toFrame, double scale,
                       const tss::Pose& restInverse);

} // namespace osgTSS
