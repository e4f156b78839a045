#include "BodyGeometry.h"

#include "bake/base/UnionFind.h"
#include "bake/motion/ClosestPointQuery.h"

#include <osg/LightModel>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgTSS/Convert>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

namespace osgTSS {

namespace {

using tss::Vec3;

/// A mesh as it is drawn: vertices split where the surface has a crease, one normal each.
struct ShadedMesh {
    std::vector<std::uint32_t> source; ///< of each drawn vertex, its vertex in the mesh
    std::vector<tss::Vec3> normals;    ///< unit, one a drawn vertex
    std::vector<tss::Tri> triangles;   ///< indices of drawn vertices; triangles without area are left out
};

/// Each vertex's representative: the first vertex in the same place.
std::vector<int> weld(const std::vector<Vec3>& vertices) {
    std::vector<int> order(vertices.size()), representative(vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int i) { return std::array{vertices[i].x(), vertices[i].y(), vertices[i].z()}; };
    std::ranges::sort(order, [&](int i, int j) { return std::pair(key(i), i) < std::pair(key(j), j); });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && key(order[k]) == key(order[k - 1]);
        representative[order[k]] = same ? representative[order[k - 1]] : order[k];
    }
    return representative;
}

/// A triangle's corner, sorted by the place where it stands.
struct Corner {
    int place;
    int triangle;
    int k;
};

struct Surface {
    const tss::TriangleMesh& mesh;
    std::vector<int> place;        ///< of each vertex
    std::vector<Vec3> faceNormals; ///< unit; zero for a triangle without area

    int at(int triangle, int k) const { return place[mesh.triangles[triangle][k % 3]]; }

    double angle(const Corner& c) const {
        const Vec3& p = mesh.corner(c.triangle, c.k);
        const Vec3 a = (mesh.corner(c.triangle, (c.k + 1) % 3) - p).normalized();
        const Vec3 b = (mesh.corner(c.triangle, (c.k + 2) % 3) - p).normalized();
        return std::atan2(a.cross(b).norm(), a.dot(b));
    }
};

/// Joins the corners around one place whose triangles share an edge there and are flatter than the crease.
/// group: one per corner, the index of the first corner of its group.
std::vector<std::size_t> groupCorners(const Surface& surface, std::span<const Corner> corners,
                                      double minCosine) {
    tss::UnionFind together(corners.size());
    // Spokes: the far end of each edge that starts here, with the corner it belongs to.
    std::vector<std::pair<int, std::size_t>> spokes;
    for (std::size_t c = 0; c < corners.size(); ++c)
        for (int step : {1, 2}) spokes.emplace_back(surface.at(corners[c].triangle, corners[c].k + step), c);
    std::ranges::sort(spokes);
    for (std::size_t first = 0; first < spokes.size();) {
        std::size_t end = first;
        while (end < spokes.size() && spokes[end].first == spokes[first].first) ++end;
        for (std::size_t i = first; i < end; ++i)
            for (std::size_t j = i + 1; j < end; ++j) {
                const Vec3& n = surface.faceNormals[corners[spokes[i].second].triangle];
                const Vec3& m = surface.faceNormals[corners[spokes[j].second].triangle];
                if (n.dot(m) < minCosine) continue;
                together.join(spokes[i].second, spokes[j].second);
            }
        first = end;
    }
    std::vector<std::size_t> group(corners.size());
    for (std::size_t c = 0; c < corners.size(); ++c) group[c] = together.root(c);
    return group;
}

/// Normals weighted by the corner angles, averaged over the triangles around a vertex that hang together over
/// edges flatter than the crease angle (radians). Vertices in one place count as one, so that meshes stored
/// as loose triangles come out smooth too.
ShadedMesh shade(const tss::TriangleMesh& mesh, double creaseAngle) {
    Surface surface{mesh, weld(mesh.vertices), {}};
    std::vector<Corner> corners;
    std::vector<int> drawn(mesh.triangles.size(), -1);
    ShadedMesh result;
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
        const Vec3 cross =
            (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0));
        const double area = cross.norm();
        surface.faceNormals.push_back(area > 0 ? Vec3(cross / area) : Vec3::Zero());
        if (!(area > 0)) continue;
        drawn[t] = static_cast<int>(result.triangles.size());
        result.triangles.push_back(mesh.triangles[t]);
        for (int k = 0; k < 3; ++k) corners.push_back({surface.at(t, k), t, k});
    }
    std::ranges::stable_sort(corners, [](const Corner& a, const Corner& b) { return a.place < b.place; });
    const double minCosine = std::cos(creaseAngle);
    for (std::size_t first = 0; first < corners.size();) {
        std::size_t end = first;
        while (end < corners.size() && corners[end].place == corners[first].place) ++end;
        const std::span<const Corner> around(&corners[first], end - first);
        const auto group = groupCorners(surface, around, minCosine);
        std::map<std::size_t, int> vertexOfGroup;
        for (std::size_t c = 0; c < around.size(); ++c) {
            const auto [entry, fresh] =
                vertexOfGroup.emplace(group[c], static_cast<int>(result.source.size()));
            if (fresh) {
                result.source.push_back(static_cast<std::uint32_t>(around[c].place));
                result.normals.push_back(Vec3::Zero());
            }
            result.normals[entry->second] +=
                surface.angle(around[c]) * surface.faceNormals[around[c].triangle];
            result.triangles[drawn[around[c].triangle]][around[c].k] = entry->second;
        }
        first = end;
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
    const ShadedMesh shaded = shade(body.mesh, creaseAngle);
    const Eigen::AlignedBox3d box = tss::bounds(body.mesh);
    const bool recentre = !box.isEmpty() && box.center().norm() > farAway * box.diagonal().norm();
    const Vec3 centre = recentre ? Vec3(box.center()) : Vec3(0, 0, 0);

    std::vector<Vec3> points;
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
