#pragma once
#include <osg/Node>
#include <osgTSS/Install>
#include <osgTSS/Scene>

namespace osgTSS {

/// Lets the model's skins and muscles play in a graph: those that it shows already, and those that are made
/// from tagged geometry, which SkinGeometries are put in place of.
void installSkins(osg::Node& root, Scene& scene, Installed& installed);

/// Puts back what installSkins() has taken out.
void restoreDrawables(osg::Node& root);

/// Ours runs around those that are there, so that it has the last word whatever they do after their own
/// traverse().
void addOutermost(osg::Node& node, osg::Callback& callback);

} // namespace osgTSS
