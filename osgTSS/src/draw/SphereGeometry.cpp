#include "SphereGeometry.h"

#include <osg/BlendFunc>
#include <osg/Material>
#include <osg/ShapeDrawable>
#include <osg/TriangleIndexFunctor>
#include <osgTSS/Convert>

#include <vector>

namespace osgTSS {

namespace {

struct Triangles {
    std::vector<unsigned int> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        corners.insert(corners.end(), {a, b, c});
    }
};

/// A sphere of few triangles.
struct UnitSphere {
    std::vector<osg::Vec3> points;
    std::vector<unsigned int> corners; ///< three a triangle

    UnitSphere() {
        osg::ref_ptr<osg::TessellationHints> few = new osg::TessellationHints;
        few->setDetailRatio(0.3f);
        osg::ref_ptr<osg::ShapeDrawable> shape = new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1), few);
        const auto& vertices = static_cast<const osg::Vec3Array&>(*shape->getVertexArray());
        points.assign(vertices.begin(), vertices.end());
        osg::TriangleIndexFunctor<Triangles> triangles;
        shape->accept(triangles);
        corners = std::move(triangles.corners);
    }
};

const UnitSphere& unitSphere() {
    static const UnitSphere sphere;
    return sphere;
}

} // namespace

SphereGeometry::SphereGeometry(std::size_t count, const osg::Vec4& color) {
    const UnitSphere& unit = unitSphere();
    const std::size_t points = unit.points.size();
    setDataVariance(DYNAMIC);
    setUseDisplayList(false);
    setUseVertexBufferObjects(true);
    _vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, static_cast<unsigned int>(count * points));
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (std::size_t s = 0; s < count; ++s) {
        normals->insert(normals->end(), unit.points.begin(), unit.points.end());
        for (unsigned int corner : unit.corners) indices->push_back(static_cast<GLuint>(s * points + corner));
    }
    setVertexArray(_vertices);
    setNormalArray(normals);
    addPrimitiveSet(indices);

    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::OFF);
    material->setAmbient(osg::Material::FRONT_AND_BACK, color);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    osg::StateSet* state = getOrCreateStateSet();
    state->setAttributeAndModes(material);
    state->setAttributeAndModes(new osg::BlendFunc);
    // Through each other and through the bodies that they fill.
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    state->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    state->setRenderBinDetails(19, "RenderBin");
}

void SphereGeometry::place(std::span<const tss::Sphere> spheres) {
    const std::vector<osg::Vec3>& unit = unitSphere().points;
    auto out = _vertices->begin();
    for (const tss::Sphere& sphere : spheres) {
        const osg::Vec3 centre(toOsg(sphere.centre));
        for (const osg::Vec3& point : unit) *out++ = centre + point * static_cast<float>(sphere.radius);
    }
    _vertices->dirty();
    dirtyGLObjects();
    dirtyBound();
}

} // namespace osgTSS
