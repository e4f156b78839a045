#pragma once
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"
#include "bake/search/SkinSearch.h"
#include "tests/BentEllipsoid.h"

#include <cmath>

/// Generated skins over generated muscles, for the tests of the skin.
namespace skins {

constexpr double degree = M_PI / 180;

/// A bone, as a muscle that does not contract.
inline std::shared_ptr<const tss::MuscleDeformer> boneOf(tss::TriangleMesh mesh) {
    tss::Muscle bone;
    bone.surface = std::move(mesh);
    bone.activationUpper = 0;
    return std::make_shared<const tss::MuscleDeformer>(std::move(bone));
}

/// A sheet of n by n quads over [-size, size]^2, vaulted by `vault` in the middle, split the same way on
/// either side of x = 0 and y = 0; n even.
inline tss::TriangleMesh vaultedSheet(int n, double size, double height, double vault) {
    tss::TriangleMesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = size * (2.0 * i / n - 1), y = size * (2.0 * j / n - 1);
            mesh.vertices.emplace_back(x, y, height - vault * (x * x + y * y) / (size * size));
        }
    const auto at = [&](int i, int j) { return j * (n + 1) + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const bool mirrored = (2 * i < n) != (2 * j < n);
            const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (mirrored) {
                mesh.triangles.emplace_back(a, b, d);
                mesh.triangles.emplace_back(b, c, d);
            } else {
                mesh.triangles.emplace_back(a, b, c);
                mesh.triangles.emplace_back(a, c, d);
            }
        }
    return mesh;
}

/// A bent ellipsoid along x right under the middle of the sheet.
inline tss::Muscle muscleBelow(double clearance, double contraction = 0.25, double y = 0) {
    tss::test::BentEllipsoid shape;
    shape.origin = {-0.6, y, -0.25 - clearance};
    shape.insertion = {0.6, y, -0.25 - clearance};
    shape.bend = 0.1;
    shape.halfWidth = 0.25;
    shape.halfHeight = 0.15;
    tss::Muscle muscle = tss::test::bentEllipsoid(shape);
    muscle.maxContraction = contraction;
    muscle.anchor = 0.5;
    return muscle;
}

/// One sphere a vertex, inside the surface.
inline tss::SphereSet insetSpheres(const tss::TriangleMesh& mesh, double radius) {
    const std::vector<tss::Vec3> normals = tss::vertexNormals(mesh);
    tss::SphereSet spheres;
    for (std::size_t v = 0; v < normals.size(); ++v)
        spheres.push_back({mesh.vertices[v] - radius * normals[v], radius});
    return spheres;
}

/// A skin over muscles, with its table.
struct Couple {
    tss::TriangleMesh skin;
    std::vector<std::shared_ptr<const tss::MuscleDeformer>> muscles;
    tss::SkinTable table;

    std::shared_ptr<const tss::SkinRig> rig(const tss::SkinParameters& parameters = {}) const {
        return tss::makeSkinRig(skin, muscles, table, parameters);
    }
};

inline Couple couple(tss::TriangleMesh skin, std::vector<tss::Muscle> muscles, double thickness = 0.03,
                     tss::SkinPath path = tss::SkinPath::Carried) {
    Couple result{std::move(skin), {}, {}};
    std::vector<tss::SkinSearchMuscle> searched;
    for (tss::Muscle& m : muscles) {
        result.muscles.push_back(std::make_shared<const tss::MuscleDeformer>(std::move(m)));
        searched.push_back(
            {result.muscles.back().get(), insetSpheres(result.muscles.back()->muscle().surface, 0.05)});
    }
    tss::SkinSearchOptions options;
    options.thickness = thickness;
    options.travel = thickness;
    options.path = path;
    result.table = tss::searchSkin(result.skin, searched, options);
    return result;
}

/// The usual one: 32 by 32 quads, the muscle 0.01 below the skin.
inline Couple usual() {
    return couple(vaultedSheet(32, 1, 0.01, 0.3), {muscleBelow(0)});
}

inline void run(tss::SkinResponse& response, double activation, int frames) {
    for (int f = 0; f < frames; ++f) response.update(std::vector<double>{activation});
}

inline bool exactlyAtRest(const tss::SkinResponse& response) {
    for (std::size_t i = 0; i < response.positions().size(); ++i)
        if (response.positions()[i] != response.rig().rest[i] ||
            response.normals()[i] != response.rig().restNormals[i])
            return false;
    return true;
}

} // namespace skins
