#include "bake/scene/SceneWriting.h"

#include "bake/base/NearestFloat.h"

#include <algorithm>
#include <numeric>

namespace tss {

namespace {

/// Where the nearest prim above this path that is a body stands, which its own transform is relative to.
Pose parentPlacement(const SceneModel& scene, std::string path) {
    for (auto slash = path.rfind('/'); slash != 0 && slash != std::string::npos; slash = path.rfind('/')) {
        path.resize(slash);
        if (const int body = findBody(scene, path); body >= 0) return scene.bodies[body].placement;
    }
    return Pose::Identity();
}

void writePlacement(PrimWriter& prim, const Pose& placement) {
    std::vector<std::string> order;
    if (placement.translation() != Vec3::Zero()) {
        prim.set(schema::translate, Vec3(placement.translation()));
        order.push_back(schema::translate.name);
    }
    if (placement.linear() != Eigen::Matrix3d::Identity()) {
        prim.set(schema::orient, Eigen::Quaterniond(placement.linear()).normalized());
        order.push_back(schema::orient.name);
    }
    if (!order.empty()) prim.set(schema::xformOpOrder, order);
}

void writeMesh(PrimWriter& prim, const Body& body) {
    const TriangleMesh& mesh = body.mesh;
    prim.set(schema::points, mesh.vertices);
    prim.set(schema::faceVertexCounts, std::vector<double>(mesh.triangles.size(), 3));
    std::vector<double> indices;
    indices.reserve(3 * mesh.triangles.size());
    for (const Tri& triangle : mesh.triangles)
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    prim.set(schema::faceVertexIndices, indices);
    prim.set(schema::subdivisionScheme, Value("none"));
    prim.set(schema::displayColor, std::vector<Vec3>{body.displayColor});
    prim.setUnless(schema::doubleSided, Value(body.doubleSided), Value(false));
    if (mesh.vertices.empty()) return;
    const Eigen::AlignedBox3d box = bounds(mesh);
    prim.set(schema::extent, std::vector<Vec3>{box.min(), box.max()});
}

void writeBody(Layer& layer, const SceneModel& scene, const Body& body) {
    const bool hasMesh = !body.mesh.vertices.empty();
    PrimWriter prim(makePrim(layer, body.path, hasMesh ? "Mesh" : "Xform"));
    if (body.rigid) {
        addApi(prim.prim(), "PhysicsRigidBodyAPI");
        if (hasMesh) addApi(prim.prim(), "PhysicsCollisionAPI");
    }
    if (!body.displayName.empty())
        prim.prim().metadata["customData"] = Value::Object{{schema::originalName, Value(body.displayName)}};
    prim.setUnless(schema::visibility, body.visible ? "inherited" : "invisible", "inherited");
    writePlacement(prim, parentPlacement(scene, body.path).inverse() * body.placement);
    if (hasMesh) writeMesh(prim, body);
}

} // namespace

void writeBodies(Layer& layer, const SceneModel& scene) {
    // Parents first, whatever their order in the scene, so that none is made as a plain Xform by its child.
    std::vector<std::size_t> order(scene.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto depth = [&](std::size_t i) {
        const std::string& path = scene.bodies[i].path;
        return std::count(path.begin(), path.end(), '/');
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
    for (std::size_t i : order) writeBody(layer, scene, scene.bodies[i]);
}

void writeSpheres(Layer& layer, const std::string& path, const SphereSet& spheres) {
    PrimWriter prim(makePrim(layer, path, "Points"));
    std::vector<Vec3> centres;
    std::vector<double> widths;
    for (const Sphere& sphere : spheres) {
        const Vec3& c = sphere.centre;
        if (!isFloat(c.x()) || !isFloat(c.y()) || !isFloat(c.z()) || !isFloat(2 * sphere.radius))
            throw std::logic_error(path + ": spheres of a table must be exact in float; use roundToFloat()");
        centres.push_back(c);
        widths.push_back(2 * sphere.radius);
    }
    prim.set(schema::points, centres);
    prim.set(schema::widths, widths);
    prim.set(schema::purpose, Value("guide"));
    if (spheres.empty()) return;
    Eigen::AlignedBox3d box;
    for (const Sphere& sphere : spheres)
        for (double side : {-1.0, 1.0})
            box.extend(Vec3(sphere.centre + Vec3::Constant(side * sphere.radius)));
    prim.set(schema::extent, std::vector<Vec3>{box.min(), box.max()});
}

} // namespace tss
