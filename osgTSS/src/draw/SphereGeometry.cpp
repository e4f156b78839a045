#include "SphereGeometry.h"

#include <osg/BlendFunc>
#include <osg/Material>
#include <osgTSS/Convert>

#include <array>
#include <map>
#include <utility>

namespace osgTSS {

namespace {

/// A unit sphere of few triangles: an octahedron, its edges halved twice.
struct UnitSphere {
    std::vector<osg::Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::array<unsigned int, 3>> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

    UnitSphere() {
        for (int round = 0; round < 2; ++round) halve();
    }
    void halve() {
        std::map<std::pair<unsigned int, unsigned int>, unsigned int> middles;
        const auto middle = [&](unsigned int a, unsigned int b) {
            const auto [entry, fresh] =
                middles.emplace(std::minmax(a, b), static_cast<unsigned int>(points.size()));
            if (!fresh) return entry->second;
            osg::Vec3 point = points[a] + points[b];
            point.normalize();
            points.push_back(point);
            return entry->second;
        };
        std::vector<std::array<unsigned int, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const unsigned int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
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
        for (const auto& triangle : unit.triangles)
            for (unsigned int corner : triangle) indices->push_back(static_cast<GLuint>(s * points + corner));
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
