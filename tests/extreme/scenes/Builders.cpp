#include "tests/extreme/scenes/Builders.h"

#include "bake/base/NearestFloat.h"
#include "bake/model/AddPair.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"
#include "tests/Shapes.h"

#include <algorithm>
#include <fmt/format.h>
#include <random>
#include <stdexcept>

namespace extreme {

Dof turn(const Vec3& origin, const Vec3& axis, double lower, double upper) {
    return joints::turn(origin, axis, lower * degree, upper * degree);
}

TriangleMesh roughBall(const Vec3& centre, double radius, int level, double rough) {
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, level);
    std::mt19937_64 engine(7);
    for (Vec3& v : mesh.vertices) v = centre + radius * (1 - rough * (double(engine() >> 11) * 0x1p-53)) * v;
    return mesh;
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Tri& t : other.triangles) mesh.triangles.push_back(t + Tri::Constant(first));
    return mesh;
}

TriangleMesh inFloat(TriangleMesh mesh) {
    for (Vec3& v : mesh.vertices)
        for (int k = 0; k < 3; ++k) v[k] = tss::nearestFloat(v[k]);
    return mesh;
}

SceneModel pairScene(TriangleMesh a, TriangleMesh b, const Motion& motion, double tolerance) {
    SceneModel scene;
    scene.defaultPrim = "Scene";
    scene.endTimeCode = 48;
    for (auto* mesh : {&a, &b}) {
        tss::Body body;
        body.path = mesh == &a ? "/Scene/Still" : "/Scene/Moving";
        body.mesh = inFloat(std::move(*mesh));
        scene.bodies.push_back(std::move(body));
    }
    const int pair = tss::addPair(scene, 0, 1, motion, "Joint");
    if (tolerance > 0) scene.pairs[pair].settings["tolerance"] = fmt::format("{}", tolerance);
    for (tss::Joint& joint : scene.joints)
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            joint.drives[k] = {{0, 24, 48}, {joint.dofs[k].lower, joint.dofs[k].upper, joint.dofs[k].lower}};
    return scene;
}

SceneModel swing(double unit) {
    Motion motion;
    motion.dofs = {slide(Vec3(0, 0, 1) * unit, -3, 3), turn(Vec3(25, 0, 0) * unit, {0, 0, 1}, -40, 90)};
    return pairScene(roughBall(Vec3::Zero(), 10 * unit, 2), roughBall(Vec3(0, 30, 0) * unit, 5 * unit, 2),
                     motion, 0.2 * unit);
}

SceneModel hinge(double lower, double upper) {
    Motion motion;
    motion.dofs = {turn({25, 0, 0}, {0, 0, 1}, lower, upper)};
    return pairScene(roughBall(Vec3::Zero(), 10, 2), roughBall({0, 30, 0}, 5, 2), motion, 0.1);
}

std::string textOf(const SceneModel& scene) {
    return tss::writeJson(tss::layerOf(scene));
}

std::string edited(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("nothing to edit: " + from);
    return text.replace(at, from.size(), to);
}

const std::vector<ExtremeScene>& extremeScenes() {
    static const std::vector<ExtremeScene> all = [] {
        std::vector<ExtremeScene> scenes;
        for (const auto make : {unitScenes, contactScenes, meshScenes, limitScenes, skinScenes})
            for (ExtremeScene& scene : make()) scenes.push_back(std::move(scene));
        return scenes;
    }();
    return all;
}

const ExtremeScene& extremeScene(std::string_view name) {
    for (const ExtremeScene& scene : extremeScenes())
        if (scene.name == name) return scene;
    throw std::logic_error("no extreme scene " + std::string(name));
}

tss::SceneModel readText(const std::string& text, const std::string& name) {
    return tss::readScene(tss::parseLayer(text, name + ".tss"), name + ".tss");
}

} // namespace extreme
