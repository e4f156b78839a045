#include "tests/extreme/scenes/Builders.h"

#include <cmath>

namespace extreme {

namespace {

/// The hinge with another mesh for the ball that stands still.
std::string withStill(const TriangleMesh& mesh) {
    SceneModel scene = hinge();
    scene.bodies[0].mesh = inFloat(mesh);
    return textOf(scene);
}

TriangleMesh still() {
    return roughBall(Vec3::Zero(), 10, 2);
}

/// A can whose lids are fans of triangles a millionth as high as they are long.
TriangleMesh slivers() {
    TriangleMesh mesh;
    const int n = 16;
    for (int k = 0; k < n; ++k) {
        // Pairs of vertices next to each other.
        const double angle = 2 * M_PI * (k / 2 * 2) / n + (k % 2) * 2e-6;
        for (double z : {-10., 10.})
            mesh.vertices.emplace_back(10 * std::cos(angle), 10 * std::sin(angle), z);
    }
    mesh.vertices.emplace_back(0, 0, -10);
    mesh.vertices.emplace_back(0, 0, 10);
    for (int k = 0; k < n; ++k) {
        const int a = 2 * k, b = 2 * ((k + 1) % n);
        mesh.triangles.emplace_back(a, b, b + 1);
        mesh.triangles.emplace_back(a, b + 1, a + 1);
        mesh.triangles.emplace_back(b, a, 2 * n);
        mesh.triangles.emplace_back(a + 1, b + 1, 2 * n + 1);
    }
    return mesh;
}

/// A corner twice, thrice, and at the place of another: on an edge that other triangles have.
TriangleMesh zeroAreas() {
    TriangleMesh mesh = still();
    const int end = mesh.triangles[0][1];
    mesh.vertices.push_back(Vec3(mesh.vertices[std::size_t(end)]));
    const int again = static_cast<int>(mesh.vertices.size()) - 1;
    mesh.triangles.emplace_back(0, 0, end);
    mesh.triangles.emplace_back(3, 3, 3);
    mesh.triangles.emplace_back(0, again, end);
    return mesh;
}

TriangleMesh duplicates() {
    TriangleMesh mesh = still();
    const std::vector<Tri> once = mesh.triangles;
    for (const Tri& t : once) mesh.triangles.emplace_back(t[1], t[2], t[0]);
    for (const Tri& t : once) mesh.triangles.push_back(t);
    return mesh;
}

TriangleMesh holes() {
    TriangleMesh mesh = still();
    std::vector<Tri> left;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
        if (k % 7 != 0) left.push_back(mesh.triangles[k]);
    mesh.triangles = left;
    return mesh;
}

TriangleMesh inverted() {
    TriangleMesh mesh = still();
    for (Tri& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

/// Every third triangle turned over.
TriangleMesh mixed() {
    TriangleMesh mesh = still();
    for (std::size_t k = 0; k < mesh.triangles.size(); k += 3)
        std::swap(mesh.triangles[k][1], mesh.triangles[k][2]);
    return mesh;
}

/// Fins that stand on edges which have two triangles already.
TriangleMesh nonManifold() {
    TriangleMesh mesh = still();
    for (int k = 0; k < 8; ++k) {
        const Tri t = mesh.triangles[std::size_t(k) * 5];
        mesh.vertices.push_back(1.2 * mesh.vertices[t[0]]);
        mesh.triangles.emplace_back(t[0], t[1], static_cast<int>(mesh.vertices.size()) - 1);
    }
    return mesh;
}

TriangleMesh oneTriangle() {
    TriangleMesh mesh;
    mesh.vertices = {{-10, -10, 0}, {10, -10, 0}, {0, 10, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TriangleMesh points(int count) {
    TriangleMesh mesh;
    mesh.vertices.assign(std::size_t(count), Vec3(1, 2, 3));
    return mesh;
}

TriangleMesh onlyZeroArea() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 1}};
    return mesh;
}

/// A coordinate of a vertex as the file spells it.
std::string withCoordinate(const std::string& number) {
    SceneModel scene = hinge();
    scene.bodies[0].mesh.vertices[3].y() = 12345.5;
    return edited(edited(textOf(scene), "12345.5", "77"), "12345.5",
                  number); // the first one is in the extent
}

/// A face that names a vertex beyond the last.
std::string badIndex() {
    SceneModel scene = hinge();
    scene.bodies[0].mesh.triangles[5][1] = 1000000;
    return textOf(scene);
}

} // namespace

std::vector<ExtremeScene> meshScenes() {
    const std::string asked =
        "slivers, zero-area and duplicate triangles, holes, inverted and non-manifold meshes";
    const std::string same = "the table of the mesh without the defect";
    return {
        {"mesh_good", asked, "the table that the damaged meshes are compared with", Fate::Table, "",
         textOf(hinge())},
        {"mesh_slivers", asked, "a table with its bounds, as for any mesh", Fate::Table, "",
         withStill(slivers())},
        {"mesh_zero_area", asked, same, Fate::Table, "", withStill(zeroAreas())},
        {"mesh_duplicates", asked, same, Fate::Table, "", withStill(duplicates())},
        {"mesh_holes", asked, "a table; a note says how the holes count", Fate::Table, "",
         withStill(holes())},
        {"mesh_inverted", asked, "the table of the mesh turned right; a note says so", Fate::Table, "",
         withStill(inverted())},
        {"mesh_mixed", asked, "a table; a note says how the openings count", Fate::Table, "",
         withStill(mixed())},
        {"mesh_non_manifold", asked, "a table; a note says what is inside", Fate::Table, "",
         withStill(nonManifold())},
        {"mesh_one_triangle", asked, "a table: a surface without an inside can be met too", Fate::Table, "",
         withStill(oneTriangle())},
        {"mesh_only_zero_area", asked, "refused", Fate::NotBakeable, "no triangle with an area",
         withStill(onlyZeroArea())},
        {"mesh_one_vertex", "one vertex, no vertex", "refused", Fate::NotBakeable, "expected a mesh",
         withStill(points(1))},
        {"mesh_no_vertex", "one vertex, no vertex", "refused", Fate::NotReadable,
         "expected two bodies with geometry", withStill(points(0))},
        {"mesh_bad_index", asked, "refused", Fate::NotReadable, "expected indices below", badIndex()},
        {"point_nan", "NaN and infinite numbers", "refused", Fate::NotReadable, "finite",
         withCoordinate("\"nan\"")},
        {"point_infinite", "NaN and infinite numbers", "refused", Fate::NotReadable, "finite",
         withCoordinate("\"-inf\"")},
        {"frame_nan", "NaN and infinite numbers", "refused", Fate::NotReadable, "finite",
         edited(textOf(hinge()), "\"default\": [25,0,0]", "\"default\": [25,\"nan\",0]")},
        {"limit_nan", "NaN and infinite numbers", "refused", Fate::NotReadable, "lowerLimit",
         edited(textOf(hinge()), "\"default\": -40", "\"default\": \"nan\"")},
        {"unit_infinite", "NaN and infinite numbers", "refused", Fate::NotReadable, "metersPerUnit",
         edited(textOf(hinge()), "\"metersPerUnit\": 1", "\"metersPerUnit\": \"inf\"")},
    };
}

} // namespace extreme
