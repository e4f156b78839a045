#include "tests/adversary/scenes/Draws.h"

#include "bake/geometry/MeshQuery.h"
#include "tests/Shapes.h"
#include "tests/geometry/TestMeshes.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace adversary {

TriangleMesh anyBody(Random& random) {
    switch (random.below(5)) {
    case 0:
        return boxMesh(-Vec3(random.in(0.2, 0.8), random.in(0.2, 0.8), random.in(0.2, 0.8)),
                       Vec3(random.in(0.2, 0.8), random.in(0.2, 0.8), random.in(0.2, 0.8)));
    case 1:
        return ballMesh(Vec3::Zero(), 1, 1 + random.below(2));
    case 2:
        return bumpyBall(0.8, 2, {random.direction(), random.direction()}, random.in(0.1, 0.6),
                         random.in(0.2, 0.7));
    case 3:
        return joined(ballMesh(Vec3::Zero(), 0.6, 1),
                      needle(Vec3::Zero(), 1.2 * random.direction(), 0.2, 3 + random.below(3)));
    default: {
        std::mt19937_64 engine(static_cast<std::uint64_t>(random.below(1 << 30)));
        return tss::test::lumpyMesh(engine, 1 + random.below(2), 0.3);
    }
    }
}

namespace {

double radiusOf(const TriangleMesh& mesh) {
    double r = 0;
    for (const Vec3& v : mesh.vertices) r = std::max(r, v.norm());
    return r;
}

} // namespace

double apartBy(const TriangleMesh& a, const TriangleMesh& b) {
    return tss::MeshQuery(a).distanceTo(tss::MeshQuery(b), Eigen::Isometry3d::Identity());
}

Vec3 putBeside(Random& random, const TriangleMesh& a, TriangleMesh& b, double clearance) {
    const Vec3 way = random.direction();
    b = movedBy(b, (radiusOf(a) + radiusOf(b) + clearance) * way);
    return way;
}

void bringTogether(const TriangleMesh& a, TriangleMesh& b, const Vec3& way, double clearance) {
    const tss::MeshQuery stay(a), come(b);
    const auto distance = [&](double by) {
        return stay.distanceTo(come, Eigen::Isometry3d(Eigen::Translation3d(Vec3(-by * way))));
    };
    // Moves by what is surely free, which never passes through.
    double by = 0;
    for (int k = 0; k < 400; ++k) {
        const double left = distance(by) - std::max(clearance, 0.0);
        if (left < 1e-12) break;
        by += left;
        if (by > 1e3) return; // they pass each other
    }
    b = movedBy(b, -(by + std::max(-clearance, 0.0)) * way);
}

Dof hingePast(Random& random, const Vec3& way, double reach) {
    const Vec3 side = way.unitOrthogonal(), other = way.cross(side);
    const double around = random.in(-pi, pi);
    const Vec3 aside = std::cos(around) * side + std::sin(around) * other;
    const Vec3 axis = way.cross(aside) + random.in(0, 0.5) * random.direction();
    const double lever = random.in(0.8, 3) * reach;
    const double swing = random.in(0.2, 1.2);
    return turn(lever * aside + random.in(0, 1) * reach * way, axis, -random.in(0.1, 1) * swing, swing);
}

void anySettings(Random& random, Draft& draft) {
    const auto length = [&](double l) { return fmt::format("{}", l * draft.unit); };
    const int rest = random.below(10);
    if (rest >= 6) draft.settings["at-rest"] = rest == 6 ? "offset" : rest == 7 ? "ignore" : "collide";
    if (random.below(6) == 0)
        draft.settings["epsilon"] = length(draft.tolerance * logUniform(random, 1e-6, 1));
    if (random.below(6) == 0) draft.settings["depth"] = length(draft.tolerance * logUniform(random, 0.1, 3));
    if (random.below(12) == 0) draft.settings["conservative"] = "false";
    if (random.below(5) == 0) draft.settings["keep-spheres"] = "true";
    if (random.below(20) == 0) draft.settings["spheres"] = random.below(2) ? "surface" : "shrinking";
    if (random.below(20) == 0) draft.settings["reduce"] = "none";
}

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"bumps", bumps},           {"needles", needles},      {"slivers", slivers},
        {"nested", nested},         {"wires", wires},          {"open meshes", openMeshes},
        {"overlaps", overlaps},     {"touching", touching},    {"plates", plates},
        {"components", components}, {"cracks", cracks},        {"sockets", sockets},
        {"far axes", farAxes},      {"far bodies", farBodies}, {"tiny ranges", tinyRanges},
        {"full turns", fullTurns},  {"paths", corneredPaths},  {"planes", planes},
        {"chains", chains},         {"units", units},          {"fixed", fixed}};
    return all;
}

NamedDraft drawScene(std::uint64_t seed) {
    const Kind& kind = kinds()[seed % kinds().size()];
    return {fmt::format("{}-{}", kind.name, seed), kind.name, kind.draw(seed * 0x9E3779B97F4A7C15u + 1)};
}

namespace {

Motion scaled(Motion motion, double unit) {
    for (Dof& dof : motion.dofs) {
        dof.origin *= unit;
        dof.frame.translation() *= unit;
        for (tss::PathRow& row : dof.path) row.translation *= unit;
        if (dof.kind == tss::DofKind::Translation) dof.axis *= unit;
    }
    return motion;
}

} // namespace

tss::SceneModel sceneOf(const Draft& draft, const std::string& name) {
    Motion motion = scaled(draft.motion, draft.unit);
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) motion.dofs[k].name = fmt::format("dof{}", k);
    const auto large = [&](TriangleMesh mesh) {
        for (Vec3& v : mesh.vertices) v *= draft.unit;
        return mesh;
    };
    tss::SceneModel scene =
        extreme::pairScene(large(draft.a), large(draft.b), motion, draft.tolerance * draft.unit);
    scene.metersPerUnit = draft.metersPerUnit;
    for (const auto& [key, text] : draft.settings) scene.pairs[0].settings[key] = text;
    return extreme::readText(extreme::textOf(scene), name);
}

} // namespace adversary
