#pragma once
#include "bake/spheres/SphereSet.h"

#include <osg/Geometry>
#include <osg/Vec4>

#include <span>

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

} // namespace osgTSS
