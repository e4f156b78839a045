#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <osg/Geometry>
#include <osg/Matrixd>

#include <array>
#include <vector>

namespace osgTSS {

/// Adds the triangles of a drawable to a mesh, every point times the matrix and then the scale. Equal points
/// of one drawable become one vertex; a matrix that mirrors turns the triangles round, so that outside stays
/// outside.
/// Returns how many were left out since a corner is no finite point, or no vertex of the geometry.
std::size_t collectTriangles(const osg::Drawable& drawable, const osg::Matrixd& matrix, double scale,
                             tss::TriangleMesh& mesh);

/// The places of a geometry's vertices, whatever they are stored as; none for what is no place.
std::vector<osg::Vec3d> pointsOf(const osg::Geometry& geometry);

/// The triangles of a geometry, by its vertices.
std::vector<std::array<unsigned int, 3>> trianglesOf(const osg::Geometry& geometry);

/// It draws what trianglesOf() does not know: patches and triangles with their neighbours, which a shader
/// makes surface of, or several instances, which one places.
bool drawsByShader(const osg::Drawable& drawable);

/// The determinant of the upper 3x3 part, below 0 where the matrix mirrors.
double determinant(const osg::Matrixd& matrix);

} // namespace osgTSS
