#include "RealSkins.h"
#include "SkinMeasure.h"
#include "bake/geometry/MeshAudit.h"
#include "tests/Shapes.h"

#include <iostream>
#include <map>

using namespace tss;

namespace {

/// What a captured shape adds to each vertex of the face: lines "vertex dx dy dz".
std::vector<Vec3> captured(const std::string& name, std::size_t vertices) {
    std::vector<Vec3> moves(vertices, Vec3::Zero());
    std::ifstream stream(sharedMesh("human_face_ict/" + name + ".delta"));
    std::size_t v = 0;
    for (Vec3 d; stream >> v >> d[0] >> d[1] >> d[2];) moves.at(v) = d;
    return moves;
}

/// A point under the skin, seen from the front: z of the foremost triangle over (x, y) less a depth.
Vec3 underSkin(const TriangleMesh& face, double x, double y, double depth) {
    double front = -1e9;
    for (const Tri& t : face.triangles) {
        const Vec3 &a = face.vertices[t[0]], &b = face.vertices[t[1]], &c = face.vertices[t[2]];
        const double area = (b - a).cross(c - a).z();
        if (area == 0) continue;
        const Vec3 p(x, y, 0);
        const auto across = [&](const Vec3& u, const Vec3& v) {
            return (u.x() - p.x()) * (v.y() - p.y()) - (u.y() - p.y()) * (v.x() - p.x());
        };
        const double wa = across(b, c) / area, wb = across(c, a) / area, wc = 1 - wa - wb;
        if (wa >= 0 && wb >= 0 && wc >= 0) front = std::max(front, wa * a.z() + wb * b.z() + wc * c.z());
    }
    return {x, y, front - depth};
}

/// One belly of the frontalis, from the galea under the hairline to the skin of the brow: a sheet of even
/// thickness under the forehead between two columns of x. Textbook places, in centimetres; nothing is taken
/// from the captured shapes.
struct Belly {
    double inner = 0.3, outer = 3.6;       ///< |x|
    double origin = 10.5, insertion = 4.9; ///< y
    double depth = 0.25, thickness = 0.2;  ///< below the skin, and of the sheet
    double contraction = 0.15;
    double anchor = 0.35; ///< neither end is on bone: the brow is drawn up, and the galea down
};

Muscle frontalis(const TriangleMesh& face, const Belly& belly, double side) {
    constexpr int along = 24, across = 12;
    Muscle muscle;
    muscle.form = MuscleForm::Sheet;
    muscle.maxContraction = belly.contraction;
    muscle.anchor = belly.anchor;
    const auto at = [&](double s, double t, double depth) {
        return underSkin(face, side * (belly.inner + t * (belly.outer - belly.inner)),
                         belly.origin + s * (belly.insertion - belly.origin), depth);
    };
    TriangleMesh& mesh = muscle.surface;
    for (const double depth : {belly.depth, belly.depth + belly.thickness})
        for (int i = 0; i <= along; ++i)
            for (int j = 0; j <= across; ++j)
                mesh.vertices.push_back(
                    at(static_cast<double>(i) / along, static_cast<double>(j) / across, depth));
    const int layer = (along + 1) * (across + 1);
    const auto quad = [&](int a, int b, int c, int d) {
        if (side < 0) std::swap(b, d);
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
    };
    const auto index = [&](int i, int j) { return i * (across + 1) + j; };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < across; ++j) {
            quad(index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
            quad(layer + index(i, j), layer + index(i, j + 1), layer + index(i + 1, j + 1),
                 layer + index(i + 1, j));
        }
    for (int i = 0; i < along; ++i) {
        quad(index(i, 0), layer + index(i, 0), layer + index(i + 1, 0), index(i + 1, 0));
        quad(index(i, across), index(i + 1, across), layer + index(i + 1, across), layer + index(i, across));
    }
    for (int j = 0; j < across; ++j) {
        quad(index(0, j), index(0, j + 1), layer + index(0, j + 1), layer + index(0, j));
        quad(index(along, j), layer + index(along, j), layer + index(along, j + 1), index(along, j + 1));
    }
    for (int i = 0; i <= 8; ++i) muscle.fibre.push_back(at(i / 8.0, 0.5, belly.depth + belly.thickness / 2));
    return muscle;
}

/// The rims of eyes, nostrils and mouth are held by what lies behind them: 1 there, 0 from a distance on.
std::vector<double> heldAtOpenings(const TriangleMesh& face, double distance) {
    std::map<std::pair<int, int>, int> uses;
    for (const Tri& t : face.triangles)
        for (int k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    std::vector<int> rim;
    for (const auto& [edge, count] : uses)
        if (count == 1) rim.push_back(edge.first);
    std::vector<double> held;
    for (const Vec3& v : face.vertices) {
        double near = distance;
        for (const int r : rim) near = std::min(near, (face.vertices[r] - v).norm());
        const double t = 1 - near / distance;
        held.push_back(t * t * (3 - 2 * t));
    }
    return held;
}

} // namespace

TEST_CASE("a frontalis set up from its anatomy raises a human brow as it was captured, roughly") {
    REQUIRE_SHARED_MESHES();
    const TriangleMesh face = skins::realSkin("human_face_ict/face.obj");
    const std::size_t count = face.vertices.size();
    std::vector<Vec3> shape = captured("browInnerUp_L", count);
    const std::vector<Vec3> right = captured("browInnerUp_R", count);
    for (std::size_t v = 0; v < count; ++v) shape[v] += right[v];

    constexpr double held = 1; // cm around the openings
    const Belly belly;
    skins::Couple couple = skins::couple(face, {frontalis(face, belly, 1), frontalis(face, belly, -1)}, 0);
    for (const auto& muscle : couple.muscles) {
        const MeshAudit audit = auditMesh(muscle->muscle().surface);
        CHECK(audit.watertight);
        CHECK(audit.signedVolume > 0);
    }
    SkinParameters parameters;
    parameters.tether = heldAtOpenings(face, held);
    SkinResponse skin(couple.rig(parameters));
    for (int f = 1; f <= 30; ++f) skin.update(std::vector<double>(2, f / 30.0));
    const std::vector<Vec3> now = skins::places(couple, skin);

    // For the picture: docs/strips.sh draws them side by side.
    writeObj({now, face.triangles}, OSGTSS_BINARY_DIR "/brow_muscle.obj");
    std::vector<Vec3> target = face.vertices;
    for (std::size_t v = 0; v < count; ++v) target[v] += shape[v];
    writeObj({target, face.triangles}, OSGTSS_BINARY_DIR "/brow_captured.obj");
    writeObj(face, OSGTSS_BINARY_DIR "/brow_rest.obj");

    double along = 0, ours = 0, theirs = 0, error = 0, scaled = 0, angles = 0, weight = 0;
    for (std::size_t v = 0; v < count; ++v) {
        const Vec3 u = now[v] - face.vertices[v], d = shape[v];
        along += u.dot(d);
        ours += u.squaredNorm();
        theirs += d.squaredNorm();
        error += (u - d).squaredNorm();
        if (d.norm() < 0.05 || u.norm() == 0) continue;
        angles += d.norm() * u.normalized().dot(d.normalized());
        weight += d.norm();
    }
    const double best = along / ours;
    for (std::size_t v = 0; v < count; ++v)
        scaled += (best * (now[v] - face.vertices[v]) - shape[v]).squaredNorm();
    std::cout << "human brow, captured browInnerUp: cosine of the whole fields "
              << along / std::sqrt(ours * theirs)
              << ", mean cosine where the capture moves by 0.5 mm or more " << angles / weight
              << "; RMS error " << std::sqrt(error / theirs) << " of the capture's RMS, "
              << std::sqrt(scaled / theirs) << " with the activation that fits best (" << best
              << " of it); largest move " << 10 * skins::largestMove(skin) << " mm\n";
    const skins::Strain strain = skins::strain(skin);
    std::cout << "  edges " << strain.shortest << " to " << strain.longest << ", flipped " << strain.flipped
              << '\n';
    CHECK(along / std::sqrt(ours * theirs) > 0.7);
    CHECK(error < theirs);
    CHECK(strain.flipped == 0);
    CHECK(skin.update(std::vector<double>(2, 0.0)).rest);
}
