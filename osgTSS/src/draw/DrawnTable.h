#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/spheres/SphereSet.h"
#include "bake/table/Table.h"

#include <osg/Geometry>
#include <osg/Vec4>

#include <span>
#include <vector>

namespace osgTSS {

/// Many spheres as one translucent geometry.
class SphereGeometry : public osg::Geometry {
public:
    SphereGeometry(std::size_t count, const osg::Vec4& color);

    /// Places all of them: `count` spheres. During cull traversals of DYNAMIC geometry only.
    void place(std::span<const tss::Sphere> spheres);

private:
    osg::ref_ptr<osg::Vec3Array> _vertices;
};

/// Lines of one colour, drawn in front of everything: contact is where surfaces hide it.
class Lines : public osg::Geometry {
public:
    /// width: pixels. point: also draws where the first line begins.
    Lines(const osg::Vec4& color, float width, bool point);

    void clear() { _vertices->clear(); }
    void add(const tss::Vec3& from, const tss::Vec3& to);
    /// Shows the lines that were added since clear().
    void finish();

private:
    bool _point;
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
};

/// The overlay of one table: its spheres, a line for each test, and point and normal of contact at the
/// nearest one. Who draws it says each frame where the spheres are.
struct DrawnTable {
    explicit DrawnTable(const tss::Table& table);

    std::vector<tss::Sphere> a, b; ///< in the overlay's frame, in the table's order
    osg::ref_ptr<SphereGeometry> shapeA, shapeB;
    osg::ref_ptr<Lines> pairs, nearest;

    /// Brings the drawables up to `a` and `b`.
    void draw();

private:
    void drawContact(const tss::Sphere& from, const tss::Sphere& to);

    std::vector<tss::SpherePair> _tests;
    std::vector<double> _restGaps;
};

} // namespace osgTSS
