#include "bake/geometry/Import.h"

#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "tests/MeshFileTexts.h"
#include "tests/SharedMeshes.h"
#include "tests/geometry/TestMeshes.h"

#include <fmt/format.h>
#include <fstream>
#include <sys/stat.h>

using namespace tss;
using namespace tss::test;

namespace {

/// A file in the build tree that goes with the object.
struct TemporaryFile {
    std::string name;
    TemporaryFile(const std::string& file, const std::string& content)
        : name((std::filesystem::path(OSGTSS_BINARY_DIR) / ("import_" + file)).string()) {
        std::ofstream(name, std::ios::binary) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(name); }
};

std::string refusal(const std::string& file) {
    try {
        importMesh(file);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST_CASE("nodes deep below each other, or in a circle, are refused before they take the stack") {
    std::string nodes = "{\"mesh\":0}";
    for (int k = 1; k < 20'000; ++k) nodes += ",{\"children\":[" + std::to_string(k - 1) + "]}";
    for (const std::string& some : {nodes, std::string("{\"children\":[1]},{\"children\":[0]}")}) {
        const TemporaryFile file("deep.gltf",
                                 "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
                                 "\"nodes\":[" +
                                     some + "]}");
        CHECK_THROWS_WITH(importMesh(file.name), Catch::Contains("at most 1000 levels deep"));
    }
}

TEST_CASE("equal vertices become one, others stay in their order") {
    TriangleMesh mesh;
    mesh.vertices = {{1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-300}};
    mesh.triangles = {{0, 1, 3}, {2, 3, 4}};
    const TriangleMesh result = welded(mesh);
    CHECK(result.vertices == std::vector<Vec3>{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1e-300}});
    CHECK(result.triangles == std::vector<Tri>{{0, 1, 2}, {0, 2, 3}});
}

#ifdef OSGTSS_IMPORT

TEST_CASE("polygons are cut into triangles and the parts of a file are one mesh") {
    const TemporaryFile file("quads.obj", "o one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
                                          "o two\nv 1 1 1\nv 2 2 2\nv 0 1 0\nf 5 6 7\n");
    const TriangleMesh mesh = importMesh(file.name);
    CHECK(mesh.triangles.size() == 3);
    CHECK(mesh.vertices.size() == 6); // 0 1 0 stands in the file twice
}

TEST_CASE("points and lines beside the faces do not count in a mesh's size") {
    std::string text = tetrahedronCollada('Z');
    const auto number = text.find("0 0 3</float_array>");
    text.replace(number, 5, "0 0 3 9 9 9");
    text.replace(text.find("count=\"12\""), 10, "count=\"15\"")
        .replace(text.find("count=\"4\" stride"), 9, "count=\"5\"");
    text.insert(text.find("<triangles"), "<lines count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" "
                                         "offset=\"0\"/><p>0 4</p></lines>\n");
    const TemporaryFile collada("lines.dae", text),
        obj("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 9 9 9\nl 1 4\nf 1 2 3\n");
    for (const TemporaryFile* file : {&collada, &obj}) {
        MeshFileNotes notes;
        const TriangleMesh mesh = importMesh(file->name, &notes);
        CHECK(bounds(mesh).max() == Vec3(1, 2, file == &obj ? 0 : 3));
        CHECK(notes.leftOut == std::vector<std::string>{"1 point or line"});
    }
    const TemporaryFile loose("loose.ply",
                              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                              "y\nproperty float z\nelement face 1\nproperty list uchar int "
                              "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n9 9 9\n3 0 1 2\n");
    CHECK(importMesh(loose.name).vertices.size() == 4); // which the audit says
}

TEST_CASE("the triangles of an STL share their corners again") {
    std::string stl = "solid t\n";
    const TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
    for (std::size_t t = 0; t < box.triangles.size(); ++t) {
        stl += "facet normal 0 0 0\nouter loop\n";
        for (int k = 0; k < 3; ++k) {
            const Vec3& v = box.corner(t, k);
            stl += "vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
                   std::to_string(v.z()) + "\n";
        }
        stl += "endloop\nendfacet\n";
    }
    const TemporaryFile file("box.stl", stl + "endsolid t\n");
    const MeshAudit audit = auditMesh(importMesh(file.name));
    CHECK(audit.vertices == 8);
    CHECK(audit.watertight);
    CHECK(audit.signedVolume == Approx(1));
}

TEST_CASE("the transforms of a scene's nodes are applied, a mirror keeps the outside outside") {
    const std::string collada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>10 0 0</translate><scale>-2 1 1</scale>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
    const TemporaryFile file("mirrored.dae", collada);
    const TriangleMesh mesh = importMesh(file.name);
    const MeshAudit audit = auditMesh(mesh);
    CHECK(audit.watertight);
    CHECK(audit.signedVolume == Approx(2.0 / 6));
    CHECK(bounds(mesh).min().x() == Approx(8));
    CHECK(bounds(mesh).max().x() == Approx(10));
}

TEST_CASE("a file that is no mesh is refused by its name and the reason") {
    CHECK(refusal("nowhere.obj").find("nowhere.obj: no such file") != std::string::npos);
    CHECK(refusal(OSGTSS_BINARY_DIR).find("not a file") != std::string::npos);
    const TemporaryFile text("words.txt", "these are words\n");
    std::filesystem::path capital(text.name);
    capital.replace_filename("Import_Words.TXT");
    CHECK(refusal(capital.string()).find("no such file; there is import_words.txt") != std::string::npos);
    CHECK(refusal(text.name).find("cannot be read as a mesh") != std::string::npos);
    const TemporaryFile pointer("large.stl",
                                "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n");
    CHECK(refusal(pointer.name).find("large.stl: is a pointer of Git LFS") != std::string::npos);
    const TemporaryFile empty("empty.obj", "");
    CHECK_FALSE(refusal(empty.name).empty());
    const TemporaryFile points("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    CHECK_FALSE(refusal(points.name).empty());
    const TemporaryFile line("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    CHECK(refusal(line.name) == line.name + ": has no area, a mesh with a surface was expected");
    const TemporaryFile nodes("nodes.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_visual_scenes><visual_scene id="s"><node id="a"><node id="b"><translate>1 0 0</translate></node></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
    CHECK(refusal(nodes.name).find("holds no triangle") != std::string::npos); // and gets no made-up skeleton
}

TEST_CASE("a face that is not convex is covered, none of it left open, and nothing beyond it") {
    // A prism over a comb that lies askew, its ends one face each, of 82 corners.
    const int teeth = 20;
    std::vector<Vec3> comb{{0, 0, 0}, {2.0 * teeth, 0, 0}};
    for (int k = teeth; k > 0; --k)
        for (const auto& [x, y] : {std::pair(2 * k, 1.0), {2 * k - 1, 1.0}, {2 * k - 1, .1}, {2 * k - 2, .1}})
            comb.emplace_back(x, y, 0);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized();
    const auto count = static_cast<int>(comb.size());
    std::string vertices, bottom = "f", top = "f", sides;
    for (const double z : {0.0, 1.0})
        for (const Vec3& corner : comb) {
            const Vec3 v = turn * (corner + z * Vec3::UnitZ());
            vertices += fmt::format("v {:.7f} {:.7f} {:.7f}\n", v.x(), v.y(), v.z());
        }
    for (int k = 1; k <= count; ++k) {
        bottom += fmt::format(" {}", count + 1 - k);
        top += fmt::format(" {}", count + k);
        const int next = k % count + 1;
        sides += fmt::format("f {} {} {} {}\n", k, next, count + next, count + k);
    }
    const TemporaryFile file("comb.obj", vertices + bottom + "\n" + top + "\n" + sides);
    const TriangleMesh mesh = importMesh(file.name);
    const MeshAudit audit = auditMesh(mesh);
    CHECK(audit.triangles == 2 * (count - 2) + 2 * count);
    CHECK(audit.watertight);
    CHECK(audit.signedVolume == Approx(22));
    double area = 0, rim = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        area +=
            (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)).norm() / 2;
    for (int k = 0; k < count; ++k) rim += (comb[k] - comb[(k + 1) % count]).norm();
    CHECK(area == Approx(2 * 22 + rim));
}

TEST_CASE("nothing is turned, whatever way is up, and a file's own unit and axes are handed over") {
    const auto said = [](const TemporaryFile& file) {
        MeshFileNotes notes;
        CHECK(bounds(importMesh(file.name, &notes)).sizes().isApprox(Vec3(1, 2, 3), 1e-6));
        return notes;
    };
    for (const char up : {'Y', 'Z'}) {
        const MeshFileNotes notes = said({"up.dae", tetrahedronCollada(up)});
        CHECK(notes.upAxis == up);
        CHECK(notes.metersPerUnit == 1);
        CHECK(said({"up.fbx", tetrahedronFbx(up)}).upAxis == up);
    }
    CHECK(said({"inch.fbx", tetrahedronFbx('Y')}).metersPerUnit == Approx(0.0254));
    CHECK(said({"plain.amf", tetrahedronAmf("")}).metersPerUnit == 0.001);
    CHECK(said({"inch.amf", tetrahedronAmf(" unit=\"inch\"")}).metersPerUnit == 0.0254);
    const MeshFileNotes model = said({"inch.3mf", tetrahedron3mf(" unit=\"inch\"")});
    CHECK(model.metersPerUnit == 0.0254);
    CHECK(model.leftOut.empty());
    CHECK(said({"plain.3mf", tetrahedron3mf("")}).metersPerUnit == 0.001);
    // assimp's reader turns it.
    CHECK(said({"faces.dxf", "0\nSECTION\n2\nENTITIES\n" + dxfFace({0, 0, 0}, {1, 0, 0}, {0, 2, 0}) +
                                 dxfFace({0, 0, 0}, {1, 0, 0}, {0, 0, 3}) + "0\nENDSEC\n0\nEOF\n"})
              .metersPerUnit == 0);
}

TEST_CASE("the parts of a 3MF that stand elsewhere in its archive are said to be left out") {
    MeshFileNotes notes;
    const TemporaryFile file("parts.3mf",
                             tetrahedron3mf("", "<item objectid=\"1\" p:path=\"/3D/b.model\"/>"));
    importMesh(file.name, &notes);
    REQUIRE(notes.leftOut.size() == 1);
    CHECK(notes.leftOut[0].find("p:path") != std::string::npos);
}

TEST_CASE("remarks say what is left out, which unit a file has, and where floats are coarse") {
    MeshFileNotes notes;
    CHECK(remarks("a.obj", notes, 0.001).empty());
    notes.metersPerUnit = 0.0254;
    CHECK(remarks("a.fbx", notes, 0.0254).empty());
    REQUIRE(remarks("a.fbx", notes, 1).size() == 1);
    CHECK(remarks("a.fbx", notes, 1)[0].find("0.0254 m, and 1 m is taken") != std::string::npos);
    notes.leftOut = {"1 camera"};
    CHECK(remarks("a.fbx", notes, 1).size() == 2);
    const TemporaryFile far("far.obj", "v 1000000 0 0\nv 1000001 0 0\nv 1000000 1 0\nf 1 2 3\n"),
        near("near.obj", "v 100 0 0\nv 101 0 0\nv 100 1 0\nf 1 2 3\n");
    importMesh(near.name, &notes);
    CHECK(remarks("near.obj", notes, 1).empty());
    importMesh(far.name, &notes);
    REQUIRE(remarks("far.obj", notes, 1).size() == 1);
    CHECK(remarks("far.obj", notes, 1)[0].find("steps of 0.119 units") != std::string::npos);
}

TEST_CASE("a glTF of which a part would be misread or lost is refused") {
    const auto gltf = [](const std::string& more, int type, int last) {
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)" +
               more +
               R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)" +
               fmt::format(R"({{"bufferView":0,"componentType":{},"count":3,"type":"VEC3"}},)", type) +
               R"({"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"}],"bufferViews":[)"
               R"({"buffer":0,"byteLength":36},{"buffer":1,"byteLength":6}],"buffers":[{"byteLength":36,)"
               R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"},)"
               R"({"byteLength":6,"uri":"data:application/octet-stream;base64,AAECAAE)" +
               (last == 2 ? "C" : "D") + "\"}]}";
    };
    constexpr int floats = 5126, shorts = 5122;
    CHECK(importMesh(TemporaryFile("whole.gltf", gltf("", floats, 2)).name).triangles.size() == 2);
    CHECK(refusal(TemporaryFile("lost.gltf", gltf("", floats, 3)).name).find("Those faces were dropped") !=
          std::string::npos);
    CHECK(refusal(TemporaryFile("short.gltf", gltf("", shorts, 2)).name)
              .find("/accessors/0/componentType: expected positions in floats") != std::string::npos);
    const auto needs = [&](const std::string& extension) {
        return refusal(
            TemporaryFile("needs.gltf", gltf("\"extensionsRequired\":[\"" + extension + "\"],", floats, 2))
                .name);
    };
    CHECK(needs("EXT_meshopt_compression").find("needs EXT_meshopt_compression") != std::string::npos);
    CHECK(needs("KHR_materials_unlit").empty());
}

TEST_CASE("a file of which faces would be lost is refused, and of lost parts it is said so") {
    // With normals and no texture coordinates, faces that name some.
    const TemporaryFile tokens("tokens.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"
                                             "f 1/1/1 3/1/1 2/1/1\n");
    CHECK(refusal(tokens.name).find("cannot be read whole: assimp says \"OBJ: Not supported token in face") !=
          std::string::npos);
    // A face whose last corner is not there gets another one.
    const TemporaryFile other("other.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 9\n");
    CHECK(refusal(other.name).find("Vertex index is out of range") != std::string::npos);
    std::string collada = tetrahedronCollada('Y');
    const std::string whole = "<instance_geometry url=\"#g\"/>";
    collada.insert(collada.find(whole), "<instance_geometry url=\"#gone\"/>");
    const TemporaryFile part("part.dae", collada);
    MeshFileNotes notes;
    CHECK(importMesh(part.name, &notes).triangles.size() == 4);
    REQUIRE(notes.leftOut.size() == 1);
    CHECK(notes.leftOut[0].find("Unable to find geometry for ID \"gone\"") != std::string::npos);
}

TEST_CASE("a file that crashes its reader is refused or read, and ends nothing else") {
    // assimp 5.2's reader of it writes beyond its memory.
    const TemporaryFile file("coloured.raw",
                             "Name\n0.5 0.5 0.5 0 0 0 0 1 0 1 0 0\n0.1 0 0 0 0 3 0 1 3 1 0 3\n");
    const std::string why = refusal(file.name);
    CHECK((why.empty() || why.find(file.name + ": cannot be read as a mesh: ") == 0));
}

TEST_CASE("a bone that carries several meshes is left out as one") {
    const std::string triangle =
        R"({"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]})";
    const TemporaryFile file("skinned.gltf",
                             R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
"nodes":[{"name":"arm"},{"mesh":0,"skin":0},{"mesh":1,"skin":0}],"skins":[{"joints":[0]}],"meshes":[)" +
                                 triangle + "," + triangle +
                                 R"(],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC4"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12},
{"buffer":0,"byteOffset":48,"byteLength":48}],"buffers":[{"byteLength":96,"uri":"data:application/octet-stream;base64,)"
                                 // 0 0 0, 1 0 0, 0 1 0; joint 0; weights 1 0 0 0
                                 "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAACAPwAAAAA"
                                 "AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
                                 "AAAAAAAAAAAAAAAA"
                                 R"("}]})");
    MeshFileNotes notes;
    CHECK(importMesh(file.name, &notes).triangles.size() == 2);
    CHECK(notes.leftOut == std::vector<std::string>{"1 bone"});
}

TEST_CASE("the real meshes come in as their list says") {
    REQUIRE_SHARED_MESHES();
    const MeshAudit skull = auditMesh(importMesh(sharedMesh("dog_jaw/skull.obj")));
    CHECK(skull.vertices == 21260);
    CHECK(skull.triangles == 42480);
    CHECK(skull.watertight);
    CHECK(skull.components == 23);
    CHECK(skull.signedVolume == Approx(0.000231102).epsilon(1e-4));
    const MeshAudit link = auditMesh(importMesh(sharedMesh("franka_fer/link3.obj")));
    CHECK(link.openEdges == 238);
    CHECK(link.components == 4);
    CHECK_FALSE(link.watertight);
}

TEST_CASE("what a mesh file names is read beside it alone, and a pipe is not waited for") {
    const std::filesystem::path folder = std::filesystem::path(OSGTSS_BINARY_DIR) / "import_folder";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "sub");
    const auto gltf = [&](const std::string& uri) {
        std::ofstream(folder / "sub/a.gltf")
            << R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":")" << uri
            << R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)"
            << R"("componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":)"
            << R"({"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0})";
        return (folder / "sub/a.gltf").string();
    };
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (const char* file : {"sub/here.bin", "above.bin"})
        std::ofstream(folder / file, std::ios::binary)
            .write(reinterpret_cast<const char*>(corners), sizeof corners);
    REQUIRE(mkfifo((folder / "sub/pipe.bin").c_str(), 0600) == 0);
    std::filesystem::create_symlink("../above.bin", folder / "sub/link.bin");
    CHECK(importMesh(gltf("here.bin")).triangles.size() == 1);
    CHECK(refusal(gltf("pipe.bin")).find("pipe.bin is not a regular file") != std::string::npos);
    for (const char* out : {"../above.bin", "link.bin"})
        CHECK(refusal(gltf(out)).find("lies outside of ") != std::string::npos);
    // The file itself may be a link, to a folder that has the others.
    std::filesystem::create_symlink("sub/a.gltf", folder / "elsewhere.gltf");
    gltf("here.bin");
    std::filesystem::rename(folder / "sub/here.bin", folder / "here.bin");
    CHECK(importMesh((folder / "elsewhere.gltf").string()).triangles.size() == 1);
    std::filesystem::remove_all(folder);
}

TEST_CASE("lengths that a file does not have, endless faces and corners that are no numbers are refused") {
    const std::string chunk("glTF\x02\0\0\0\xe8\x03\0\0\xf0\xff\xff\xff"
                            "JSON{}",
                            22);
    CHECK(refusal(TemporaryFile("cut.glb", chunk).name).find("4294967280 bytes, and 2 are left") !=
          std::string::npos);
    CHECK(
        refusal(
            TemporaryFile("endless.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n").name)
            .find("no line end_header") != std::string::npos);
    std::string stl(84 + 70, '\0');
    stl[80] = 2;
    CHECK(refusal(TemporaryFile("cut.stl", stl).name)
              .find("says 2 triangles, which take 184 bytes, and it has 154") != std::string::npos);
    std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int k = 0; k < 4000; ++k) face += " 1 2 3";
    CHECK(refusal(TemporaryFile("face.obj", face + "\n").name).find("a face of 12000 corners") !=
          std::string::npos);
    const TemporaryFile nan("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(refusal(nan.name).find(nan.name + ": vertex 1 is not finite") != std::string::npos);
}

#else

TEST_CASE("a build without mesh files says so") {
    CHECK(refusal("any.obj").find("OSGTSS_IMPORT") != std::string::npos);
}

#endif
