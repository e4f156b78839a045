#include "BodyGeometry.h"

#include "bake/base/UnionFind.h"
#include "bake/geometry/Import.h"
#include "bake/motion/ClosestPointQuery.h"

#include <osg/LightModel>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace osgTSS {

namespace {

using tss::Vec3;

/// A mesh as it is drawn: vertices split where the surface has a crease, one normal each.
struct ShadedMesh {
    std::vector<tss::Vec3> points;
    std::vector<tss::Vec3> normals;  ///< unit, one a point
    std::vector<tss::Tri> triangles; ///< triangles without area are left out
};

/// Unit; zero for a triangle without area.
Vec3 faceNormal(const tss::TriangleMesh& mesh, std::size_t t) {
    const Vec3 cross = mesh.areaNormal(t);
    const double area = cross.norm();
    return area > 0 ? Vec3(cross / area) : Vec3::Zero();
}

double cornerAngle(const tss::TriangleMesh& mesh, std::size_t t, int k) {
    const Vec3& p = mesh.corner(t, k);
    const Vec3 a = (mesh.corner(t, (k + 1) % 3) - p).normalized();
    const Vec3 b = (mesh.corner(t, (k + 2) % 3) - p).normalized();
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Joins the corners (3 a triangle) of one vertex whose triangles share an edge there and are flatter than
/// the crease.
tss::UnionFind joinCorners(const tss::TriangleMesh& mesh, const std::vector<Vec3>& normals,
                           double minCosine) {
    struct Spoke {
        int from, to; ///< an edge of a triangle, from the corner's vertex
        std::size_t corner;
        auto ends() const { return std::pair(from, to); }
    };
    std::vector<Spoke> spokes;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            for (int step : {1, 2})
                spokes.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + step) % 3], 3 * t + k});
    std::ranges::sort(spokes, {}, &Spoke::ends);
    tss::UnionFind together(3 * mesh.triangles.size());
    for (auto first = spokes.begin(); first != spokes.end();) {
        const auto end = std::ranges::upper_bound(first, spokes.end(), first->ends(), {}, &Spoke::ends);
        for (auto i = first; i != end; ++i)
            for (auto j = i + 1; j != end; ++j)
                if (normals[i->corner / 3].dot(normals[j->corner / 3]) >= minCosine)
                    together.join(i->corner, j->corner);
        first = end;
    }
    return together;
}

/// Normals weighted by the corner angles, averaged over the triangles around a vertex that hang together over
/// edges flatter than the crease angle (radians). Vertices in one place count as one, so that meshes stored
/// as loose triangles come out smooth too.
ShadedMesh shade(const tss::TriangleMesh& soup, double creaseAngle) {
    const tss::TriangleMesh mesh = tss::welded(soup);
    std::vector<Vec3> normals;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) normals.push_back(faceNormal(mesh, t));
    tss::UnionFind together = joinCorners(mesh, normals, std::cos(creaseAngle));
    std::unordered_map<std::size_t, int> vertexOfGroup;
    ShadedMesh result;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (normals[t].isZero()) continue;
        tss::Tri& drawn = result.triangles.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const auto [entry, fresh] =
                vertexOfGroup.emplace(together.root(3 * t + k), static_cast<int>(result.points.size()));
            if (fresh) {
                result.points.push_back(mesh.corner(t, k));
                result.normals.push_back(Vec3::Zero());
            }
            drawn[k] = entry->second;
            result.normals[drawn[k]] += cornerAngle(mesh, t, k) * normals[t];
        }
    }
    for (Vec3& normal : result.normals) normal.normalize();
    return result;
}

const double creaseAngle = osg::DegreesToRadians(50.0);

/// Float coordinates keep a part in 10^7: farther away than this many diameters a mesh is drawn about its own
/// centre.
constexpr double farAway = 100;

} // namespace

osg::ref_ptr<osg::StateSet> makeBodyState(const Vec3& linearColor, bool doubleSided) {
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
                                         const std::vector<tss::Tri>& triangles, const Vec3& linearColor) {
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
    ShadedMesh shaded = shade(body.mesh, creaseAngle);
    const Eigen::AlignedBox3d box = tss::bounds(body.mesh);
    const bool recentre = !box.isEmpty() && box.center().norm() > farAway * box.diagonal().norm();
    const Vec3 centre = recentre ? Vec3(box.center()) : Vec3(0, 0, 0);

    for (Vec3& point : shaded.points) point -= centre;
    osg::ref_ptr<osg::Geometry> geometry =
        makeGeometry(*toOsg(shaded.points), *toOsg(shaded.normals), shaded.triangles, body.displayColor);
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
