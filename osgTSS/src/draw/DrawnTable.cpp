#include "DrawnTable.h"

#include <osg/BlendFunc>
#include <osg/LineWidth>
#include <osg/Material>
#include <osg/Point>
#include <osg/ShapeDrawable>
#include <osg/TriangleIndexFunctor>
#include <osgTSS/Convert>

#include <algorithm>
#include <limits>

namespace osgTSS {

namespace {

const osg::Vec4 colorA(0.25f, 0.55f, 0.95f, 0.35f), colorB(0.95f, 0.6f, 0.15f, 0.35f);
const osg::Vec4 pairColor(1, 1, 1, 0.25f), nearestColor(1, 0.15f, 0.15f, 1);

/// The diagonal of the box about the centres.
double extentOf(const std::vector<tss::Sphere>& spheres) {
    Eigen::AlignedBox3d box;
    for (const tss::Sphere& sphere : spheres) box.extend(sphere.centre);
    return box.diagonal().norm();
}

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

Lines::Lines(const osg::Vec4& color, float width, bool point) : _point(point) {
    setDataVariance(DYNAMIC);
    setUseDisplayList(false);
    setUseVertexBufferObjects(true);
    setVertexArray(_vertices);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
    colors->front() = color;
    setColorArray(colors);
    osg::StateSet* state = getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    state->setAttributeAndModes(new osg::BlendFunc);
    state->setAttribute(new osg::LineWidth(width));
    state->setAttribute(new osg::Point(3 * width));
    state->setRenderBinDetails(20, "RenderBin");
}

void Lines::add(const tss::Vec3& from, const tss::Vec3& to) {
    _vertices->push_back(osg::Vec3(toOsg(from)));
    _vertices->push_back(osg::Vec3(toOsg(to)));
}

void Lines::finish() {
    const auto count = static_cast<GLsizei>(_vertices->size());
    removePrimitiveSet(0, getNumPrimitiveSets());
    addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, count));
    if (_point && count > 0) addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 1));
    _vertices->dirty();
    dirtyGLObjects();
    dirtyBound();
}

DrawnTable::DrawnTable(const tss::Table& table)
    : a(table.a.size()), b(table.b.size()), shapeA(new SphereGeometry(table.a.size(), colorA)),
      shapeB(new SphereGeometry(table.b.size(), colorB)), pairs(new Lines(pairColor, 1, false)),
      nearest(new Lines(nearestColor, 3, true)), _tests(tss::tests(table)), _restGaps(table.restGaps) {}

void DrawnTable::draw() {
    shapeA->place(a);
    shapeB->place(b);
    pairs->clear();
    nearest->clear();
    double least = std::numeric_limits<double>::infinity();
    const tss::SpherePair* closest = nullptr;
    for (std::size_t t = 0; t < _tests.size(); ++t) {
        const tss::Sphere &from = a[_tests[t].a], &to = b[_tests[t].b];
        pairs->add(from.centre, to.centre);
        const double gap = (to.centre - from.centre).norm() - from.radius - to.radius -
                           (_restGaps.empty() ? 0 : _restGaps[t]);
        if (gap < least) {
            least = gap;
            closest = &_tests[t];
        }
    }
    if (closest) drawContact(a[closest->a], b[closest->b]);
    pairs->finish();
    nearest->finish();
}

/// The point half way between the two surfaces, and the normal there, a quarter as long as the smaller set of
/// spheres is wide.
void DrawnTable::drawContact(const tss::Sphere& from, const tss::Sphere& to) {
    tss::Vec3 normal = to.centre - from.centre;
    const double distance = normal.norm();
    if (!(distance > 0)) return;
    normal /= distance;
    const tss::Vec3 point = from.centre + normal * (from.radius + (distance - from.radius - to.radius) / 2);
    const double length =
        std::max(0.25 * std::min(extentOf(a), extentOf(b)), 4 * std::max(from.radius, to.radius));
    nearest->add(point, point + length * normal);
}

} // namespace osgTSS
