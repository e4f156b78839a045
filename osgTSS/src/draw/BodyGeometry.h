#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Geometry>
#include <osg/Node>
#include <osg/StateSet>
#include <osgTSS/SkinGeometry>

namespace osgTSS {

/// The mesh of a body with its colour and smooth normals, in the body's frame; a transform above it brings a
/// mesh near the origin that stands too far away for float coordinates. Hidden by its node mask when the body
/// is not visible.
osg::ref_ptr<osg::Node> makeBodyNode(const tss::Body& body);

/// The same as a SkinGeometry, with the vertices of the mesh as they are.
osg::ref_ptr<SkinGeometry> makeDeformingNode(const tss::Body& body);

/// Material and sides of a body.
osg::ref_ptr<osg::StateSet> makeBodyState(const tss::Vec3& linearColor, bool doubleSided);

/// A geometry with these vertices and normals (#V each), one colour, and triangles; in vertex buffers,
/// without display list.
osg::ref_ptr<osg::Geometry> makeGeometry(osg::Vec3Array& vertices, osg::Vec3Array& normals,
                                         const std::vector<tss::Tri>& triangles,
                                         const tss::Vec3& linearColor);

} // namespace osgTSS
