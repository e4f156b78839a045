#include "examples/doghead/DogMeshes.h"

#include "examples/doghead/anatomy/Anatomy.h"
#include "examples/doghead/mesh/Meshing.h"

#include <cmath>

namespace doghead {
namespace {

TriangleMesh rounded(TriangleMesh mesh) {
    for (Vec3& v : mesh.vertices) v = (v * 1000).array().round() / 1000;
    return mesh;
}

TriangleMesh meshOf(const Field& field, const Detail& detail, const RemeshOptions& options) {
    RemeshOptions wanted = options;
    wanted.deviation = detail.deviation;
    return rounded(remesh(polygonize(field, detail.cell), field, wanted));
}

Field balls(const Vec3& centre, double radius) {
    return mirrored(ellipsoid(centre, Vec3::Constant(radius)));
}

} // namespace

TriangleMesh skullMesh(const Detail& detail) {
    return meshOf(skull(), detail, {.shortest = 0.8});
}

TriangleMesh mandibleMesh(const Detail& detail) {
    return meshOf(mandible(), detail, {.shortest = 0.8});
}

TriangleMesh frontalisMesh(const Detail& detail) {
    return meshOf(frontalis(), detail, {.shortest = 1, .longest = 2.5});
}

TriangleMesh nosePadMesh(const Detail& detail) {
    return meshOf(nosePad(), detail, {.longest = 2.5});
}

TriangleMesh eyesMesh() {
    return meshOf(balls(eyeCentre, eyeRadius), {1, 0.08}, {});
}

TriangleMesh irisesMesh() {
    return meshOf(balls(eyeCentre + 4.8 * gaze, 6.2), {1, 0.06}, {});
}

namespace {

/// Open at the neck.
TriangleMesh headMesh(const Field& head, const Detail& detail, double finest, double longest) {
    RemeshOptions options{.shortest = finest / 2, .longest = longest};
    options.limit = [finest, muscle = frontalis()](const Vec3& p) {
        return std::max(finest, finest - 1.2 + 0.25 * muscle(p));
    };
    options.deviation = detail.deviation;
    const TriangleMesh whole = remesh(polygonize(head, detail.cell), head, options);
    return trim(whole, halfSpace({-52, 0, -36}, {-0.8, 0, -0.55}, head.box));
}

/// Of a head with its mouth cut: without the lining.
TriangleMesh withoutLining(const TriangleMesh& skin) {
    const Field lining = behindLips();
    return trim(skin, {[&](const Vec3& p) { return -lining(p); }, bounds(skin)});
}

TriangleMesh leftHalf(const TriangleMesh& skin) {
    return trim(skin, halfSpace({0, -3, 0}, -Vec3::UnitY(), bounds(skin)));
}

} // namespace

TriangleMesh leftSkinMesh(const Detail& detail) {
    return rounded(leftHalf(headMesh(headSkin(), detail, 2.2, 4.5)));
}

TriangleMesh leftSkinMouthCutMesh(const Detail& detail) {
    return rounded(leftHalf(withoutLining(headMesh(headSkinMouthCut(), detail, 2.2, 4.5))));
}

TriangleMesh skinMesh(const Detail& detail) {
    return rounded(headMesh(headSkin(), detail, 2.6, 5.5));
}

TriangleMesh skinMouthCutMesh(const Detail& detail) {
    return rounded(withoutLining(headMesh(headSkinMouthCut(), detail, 2.6, 5.5)));
}

TriangleMesh earCartilageMesh(const Detail& detail) {
    return bodyMesh(earCartilage(), detail);
}

TriangleMesh bodyMesh(const Field& field, const Detail& detail) {
    return meshOf(field, detail, {.shortest = 0.8, .longest = 4});
}

tss::Motion earMotion() {
    tss::Dof back;
    back.name = "back";
    back.origin = Vec3(-12, 33, 46);
    back.axis = -Vec3::UnitY();
    back.lower = 0;
    back.upper = 80 * M_PI / 180;
    tss::Motion motion;
    motion.dofs = {back};
    return motion;
}

tss::Motion jawMotion() {
    const double degree = M_PI / 180;
    tss::Dof lateral, open;
    lateral.name = "lateral";
    lateral.axis = Vec3::UnitZ();
    lateral.lower = -4 * degree;
    lateral.upper = 4 * degree;
    open.name = "open";
    open.axis = Vec3::UnitY();
    open.lower = -4 * degree;
    open.upper = 34 * degree;
    open.rest = 16 * degree;
    tss::Motion motion;
    motion.dofs = {lateral, open};
    return motion;
}

} // namespace doghead
