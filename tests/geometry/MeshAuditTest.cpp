#include "bake/geometry/MeshAudit.h"
#include "tests/FloatTraps.h"

#include "bake/base/Error.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("a closed box is watertight, of one component and of its volume") {
    const MeshAudit audit = auditMesh(boxMesh({0, 0, 0}, {1, 2, 3}));
    CHECK(audit.watertight);
    CHECK(audit.components == 1);
    CHECK(audit.signedVolume == Approx(6));
    CHECK_FALSE(audit.insideOut());
    CHECK(audit.usable());
    CHECK(text(audit) == "8 vertices, 12 triangles, 1 component, watertight");
}

TEST_CASE("the volume of a box 1e7 units away is not lost") {
    const MeshAudit audit = auditMesh(boxMesh(Vec3::Constant(1e7), Vec3::Constant(1e7 + 1)));
    CHECK(audit.signedVolume == Approx(1).epsilon(1e-6));
}

TEST_CASE("a box turned inside out is watertight with a negative volume") {
    const MeshAudit audit = auditMesh(turnedInsideOut(boxMesh({0, 0, 0}, {1, 1, 1})));
    CHECK(audit.watertight);
    CHECK(audit.insideOut());
    CHECK(text(audit).find("inside out") != std::string::npos);
}

TEST_CASE("a box given for both of its sides is no thicker than its surface, and it is said so") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    CHECK(auditMesh(mesh).turnedOverTriangles == 0);
    const TriangleMesh other = turnedInsideOut(mesh);
    mesh.triangles.insert(mesh.triangles.end(), other.triangles.begin(), other.triangles.end());
    CHECK(auditMesh(mesh).turnedOverTriangles == 12);
    CHECK(text(auditMesh(mesh)).find("12 triangles given a second time turned over") != std::string::npos);
}

TEST_CASE("each fault of a mesh is counted") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    SECTION("a triangle missing leaves three open edges") {
        mesh.triangles.pop_back();
        CHECK(auditMesh(mesh).openEdges == 3);
        CHECK_FALSE(auditMesh(mesh).watertight);
    }
    SECTION("a triangle turned over has three misoriented edges") {
        std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
        CHECK(auditMesh(mesh).misorientedEdges == 3);
    }
    SECTION("a fin is non-manifold and open") {
        mesh.vertices.emplace_back(5, 5, 5);
        mesh.triangles.emplace_back(0, 1, 8);
        const MeshAudit audit = auditMesh(mesh);
        CHECK(audit.nonManifoldEdges == 1);
        CHECK(audit.openEdges == 2);
    }
    SECTION("a triangle given again is a duplicate however it is written, the other side of it is none") {
        mesh.triangles.emplace_back(mesh.triangles[3][1], mesh.triangles[3][2], mesh.triangles[3][0]);
        CHECK(auditMesh(mesh).duplicateTriangles == 1);
        mesh.triangles.back() = {mesh.triangles[3][1], mesh.triangles[3][0], mesh.triangles[3][2]};
        CHECK(auditMesh(mesh).duplicateTriangles == 0);
        CHECK(auditMesh(mesh).turnedOverTriangles == 1);
        mesh.triangles.push_back(mesh.triangles.back());
        CHECK(auditMesh(mesh).turnedOverTriangles == 1);
    }
    SECTION("triangles of no area are found whether corners repeat or lie in line") {
        mesh.triangles.emplace_back(0, 1, 1);
        mesh.vertices.emplace_back(0.5, 0, 0);
        mesh.triangles.emplace_back(0, 8, 1);
        CHECK(auditMesh(mesh).zeroAreaTriangles == 2);
    }
    SECTION("unused and repeated vertices") {
        mesh.vertices.emplace_back(1, 1, 1);
        CHECK(auditMesh(mesh).unusedVertices == 1);
        CHECK(auditMesh(mesh).duplicateVertices == 1);
    }
    SECTION("NaN and an index out of range make it unusable") {
        const FloatTrapsOff traps; // what is not a number is handed over on purpose
        CHECK(auditMesh(mesh).usable());
        TriangleMesh bad = mesh;
        bad.vertices[2].y() = std::nan("");
        CHECK(auditMesh(bad).notFinite == 1);
        CHECK_FALSE(auditMesh(bad).usable());
        mesh.triangles[1][2] = 99;
        CHECK(auditMesh(mesh).badIndices == 1);
        CHECK_FALSE(auditMesh(mesh).usable());
    }
    SECTION("two boxes are two components") {
        append(mesh, boxMesh({3, 0, 0}, {4, 1, 1}));
        CHECK(auditMesh(mesh).components == 2);
        CHECK(auditMesh(mesh).watertight);
    }
}

TEST_CASE("an empty mesh has an audit and is not usable") {
    const MeshAudit audit = auditMesh({});
    CHECK(audit.triangles == 0);
    CHECK_FALSE(audit.watertight);
    CHECK_FALSE(audit.usable());
}

TEST_CASE("cleaning drops what has no area, what repeats and what nothing uses") {
    const TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
    TriangleMesh dirty;
    dirty.vertices.emplace_back(9, 9, 9);
    append(dirty, box);
    dirty.triangles.emplace_back(1, 1, 2);
    dirty.triangles.push_back(dirty.triangles[5]);
    const TriangleMesh clean = cleaned(dirty);
    CHECK(clean.vertices == box.vertices);
    CHECK(clean.triangles == box.triangles);
}

TEST_CASE("cleaning keeps segments and points of surface that no other triangle has") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    const std::size_t proper = mesh.triangles.size();
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        const int first = static_cast<int>(mesh.vertices.size());
        for (const Vec3& v : {a, b, c}) mesh.vertices.push_back(v);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        return cleaned(mesh).triangles.size() - proper;
    };
    CHECK(add({0, 0, 0}, {1, 0, 0}, {1, 0, 0}) == 0);            // an edge
    CHECK(add({1, 0.25, 0}, {1, 0.75, 0}, {1, 0.5, 0}) == 0);    // on one
    CHECK(add({1, 1, 0.5}, {1, 1, 0.5}, {1, 1, 0.5}) == 0);      // a point of one
    CHECK(add({0, 0, 1}, {3, 0, 1}, {1, 0, 1}) == 1);            // goes on beyond the edge
    CHECK(add({2, 2, 2}, {2, 2, 2}, {2, 2, 2}) == 2);            // a point off the box
    CHECK(add({0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}) == 3);      // both ends on the box, within it in between
    CHECK(add({0, 0, 0}, {0, -5e-324, 0}, {0, 0, -1e-20}) == 3); // rounding of a corner
    // Two edges in a line that the third corner parts.
    append(mesh, boxMesh({1, 0, 0}, {2, 1, 1}));
    const std::size_t before = cleaned(mesh).triangles.size();
    const int first = static_cast<int>(mesh.vertices.size());
    for (const double x : {0.0, 2.0, 1.0}) mesh.vertices.emplace_back(x, 0, 0);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    CHECK(cleaned(mesh).triangles.size() == before);
}

TEST_CASE("a cleaned mesh says which loaded triangle each of its own was") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    mesh.triangles.insert(mesh.triangles.begin() + 3, {Tri(1, 1, 2), mesh.triangles[0]});
    std::vector<std::uint32_t> loaded{77};
    const TriangleMesh clean = cleaned(mesh, &loaded);
    REQUIRE(loaded.size() == clean.triangles.size());
    for (std::size_t t = 0; t < loaded.size(); ++t)
        for (int k = 0; k < 3; ++k) CHECK(clean.corner(t, k) == mesh.corner(loaded[t], k));
    CHECK(loaded[2] == 2);
    CHECK(loaded[3] == 5);
}

TEST_CASE("what cannot be cleaned is refused with the reason") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    const auto messageOf = [](const TriangleMesh& m) -> std::string {
        try {
            cleaned(m);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    SECTION("no triangle") {
        CHECK(messageOf({}).find("no triangle") != std::string::npos);
    }
    SECTION("only triangles of no area") {
        mesh.triangles = {{0, 1, 1}};
        CHECK(messageOf(mesh).find("no triangle") != std::string::npos);
    }
    SECTION("an infinite coordinate") {
        mesh.vertices[3].x() = std::numeric_limits<double>::infinity();
        CHECK(messageOf(mesh).find("vertex 3") != std::string::npos);
    }
    SECTION("an index out of range") {
        mesh.triangles[4][1] = -1;
        CHECK(messageOf(mesh).find("triangle 4") != std::string::npos);
    }
}

TEST_CASE("the size of a mesh does not decide what has no area") {
    for (const double size : {1e-100, 1e-6, 1.0, 1e6, 1e100})
        CHECK(auditMesh(boxMesh(Vec3::Zero(), Vec3::Constant(size))).zeroAreaTriangles == 0);
}
