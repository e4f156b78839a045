#include "BodyGeometry.h"

#include "SmoothNormals.h"

#include "bake/motion/ClosestPointQuery.h"

#include <osg/LightModel>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgTSS/Convert>

namespace osgTSS {

namespace {

const double creaseAngle = osg::DegreesToRadians(50.0);

/// Float coordinates keep a part in 10^7: farther away than this many diameters a mesh is drawn about its own
/// centre.
constexpr double farAway = 100;

} // namespace

osg::ref_ptr<osg::StateSet> makeBodyState(const tss::Vec3& linearColor, bool doubleSided) {
    // Headlight and key light add up to 1.0 at most, ambient to 0.22, and a flat face that looks at the
    // headlight shines all over (see makeKeyLight): white comes to 0.94.
    constexpr float diffuse = 0.68f, ambient = 0.8f, specular = 0.08f, shininess = 24;
    const osg::Vec4 color = toDisplayColor(linearColor);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::OFF);
    const osg::Vec3 rgb(color.x(), color.y(), color.z());
    material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(rgb * ambient, 1));
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(rgb * diffuse, 1));
    material->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(specular, specular, specular, 1));
    material->setShininess(osg::Material::FRONT_AND_BACK, shininess);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttributeAndModes(material);
    if (doubleSided) {
        osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
        model->setTwoSided(true);
        state->setAttributeAndModes(model);
    }
    return state;
}

osg::ref_ptr<osg::Geometry> makeGeometry(osg::Vec3Array& vertices, osg::Vec3Array& normals,
                                         const std::vector<tss::Tri>& triangles,
                                         const tss::Vec3& linearColor) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(&vertices);
    geometry->setNormalArray(&normals, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
    color->front() = toDisplayColor(linearColor);
    geometry->setColorArray(color);
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    indices->reserve(3 * triangles.size());
    for (const tss::Tri& triangle : triangles)
        for (int k = 0; k < 3; ++k) indices->push_back(static_cast<GLuint>(triangle[k]));
    geometry->addPrimitiveSet(indices);
    return geometry;
}

osg::ref_ptr<osg::Node> makeBodyNode(const tss::Body& body) {
    const ShadedMesh shaded = shade(body.mesh, creaseAngle);
    const Eigen::AlignedBox3d box = tss::bounds(body.mesh);
    const bool recentre = !box.isEmpty() && box.center().norm() > farAway * box.diagonal().norm();
    const tss::Vec3 centre = recentre ? tss::Vec3(box.center()) : tss::Vec3(0, 0, 0);

    std::vector<tss::Vec3> points;
    points.reserve(shaded.source.size());
    for (std::uint32_t vertex : shaded.source) points.push_back(body.mesh.vertices[vertex] - centre);
    osg::ref_ptr<osg::Geometry> geometry =
        makeGeometry(*toOsg(points), *toOsg(shaded.normals), shaded.triangles, body.displayColor);
    geometry->setStateSet(makeBodyState(body.displayColor, body.doubleSided));
    if (!body.visible) geometry->setNodeMask(0);
    if (!recentre) return geometry;
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrixd::translate(toOsg(centre)));
    transform->setDataVariance(osg::Object::DYNAMIC); // flattening would bring the far coordinates back
    transform->addChild(geometry);
    return transform;
}

osg::ref_ptr<SkinGeometry> makeDeformingNode(const tss::Body& body) {
    osg::ref_ptr<SkinGeometry> skin = new SkinGeometry;
    skin->setPath(body.path);
    skin->setRestGeometry(makeGeometry(*toOsg(body.mesh.vertices), *toOsg(tss::vertexNormals(body.mesh)),
                                       body.mesh.triangles, body.displayColor));
    skin->setStateSet(makeBodyState(body.displayColor, body.doubleSided));
    if (!body.visible) skin->setNodeMask(0);
    return skin;
}

} // namespace osgTSS
