#include "bake/geometry/Import.h"

#include "bake/base/Error.h"
#include "bake/base/Order.h"
#include "bake/base/Words.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/MeshFileParts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tuple>

namespace tss {

TriangleMesh welded(const TriangleMesh& mesh) {
    const auto count = static_cast<int>(mesh.vertices.size());
    const auto key = [&](int v) {
        const Vec3& x = mesh.vertices[v];
        return std::tuple(x.x(), x.y(), x.z(), v);
    };
    std::vector<int> order = indicesOf<int>(count), first = order, place(count, -1);
    // NaN has no place in an order: such vertices stay as they are.
    const auto finite =
        std::partition(order.begin(), order.end(), [&](int v) { return mesh.vertices[v].allFinite(); });
    std::ranges::sort(order.begin(), finite, {}, key);
    for (auto it = order.begin(); it != finite; ++it)
        if (it != order.begin() && mesh.vertices[*it] == mesh.vertices[*(it - 1)])
            first[*it] = first[*(it - 1)];
    TriangleMesh result;
    for (int v = 0; v < count; ++v) {
        if (first[v] == v) {
            place[v] = static_cast<int>(result.vertices.size());
            result.vertices.push_back(mesh.vertices[v]);
        } else {
            place[v] = place[first[v]];
        }
    }
    const auto moved = [&](int v) { return v >= 0 && v < count ? place[v] : v; };
    for (const Tri& t : mesh.triangles) result.triangles.emplace_back(moved(t[0]), moved(t[1]), moved(t[2]));
    return result;
}

#ifdef OSGTSS_IMPORT

namespace {

/// The mesh of a file, welded.
TriangleMesh checked(const TriangleMesh& mesh, const std::string& file) {
    return inFile(file, [&] {
        checkIndices(mesh);
        return welded(mesh);
    });
}

MeshFile readFaces(const std::string& file) {
    MeshFile read = readMeshFile(file);
    if (!read.nodes.empty()) return read;
    const std::vector<std::string>& others = read.notes.leftOut;
    throw InputError(Where{file},
                     "holds no triangle, a mesh with faces was expected" +
                         (others.empty() ? "" : fmt::format("; not read: {}", fmt::join(others, ", "))));
}

void append(const ImportedNode& node, TriangleMesh& mesh) {
    const auto offset = static_cast<int>(mesh.vertices.size());
    const bool mirrors = node.place.linear().determinant() < 0;
    for (const Vec3& v : node.mesh.vertices) mesh.vertices.push_back(node.place * v);
    for (Tri t : node.mesh.triangles) {
        if (mirrors) std::swap(t[1], t[2]); // keeps the outside outside
        mesh.triangles.push_back(t.array() + offset);
    }
}

} // namespace

TriangleMesh importMesh(const std::string& file, MeshFileNotes* notes) {
    const MeshFile read = readFaces(file);
    TriangleMesh mesh;
    for (const ImportedNode& node : read.nodes) append(node, mesh);
    mesh = checked(mesh, file);
    std::size_t flat = 0;
    while (flat < mesh.triangles.size() && hasZeroArea(mesh, flat)) ++flat;
    if (flat == mesh.triangles.size())
        throw InputError(Where{file}, "has no area, a mesh with a surface was expected");
    if (notes) *notes = read.notes;
    return mesh;
}

std::vector<ImportedNode> importNodes(const std::string& file, MeshFileNotes* notes) {
    MeshFile read = readFaces(file);
    for (ImportedNode& node : read.nodes) node.mesh = checked(node.mesh, file);
    if (notes) *notes = read.notes;
    return std::move(read.nodes);
}

#else

TriangleMesh importMesh(const std::string& file, MeshFileNotes*) {
    throw InputError(Where{file}, "this build reads no mesh files (OSGTSS_IMPORT is off)");
}

std::vector<ImportedNode> importNodes(const std::string& file, MeshFileNotes*) {
    throw InputError(Where{file}, "this build reads no mesh files (OSGTSS_IMPORT is off)");
}

#endif

std::vector<std::string> remarks(const std::string& file, const MeshFileNotes& notes, double metersPerUnit) {
    std::vector<std::string> texts;
    for (const std::string& what : notes.leftOut) texts.push_back("left out of " + file + ": " + what);
    const double stated = notes.metersPerUnit;
    if (stated > 0 && std::abs(stated - metersPerUnit) > 1e-5 * stated)
        texts.push_back(fmt::format("{} says that one of its units, as it is read, is {:.6g} m, and {:.6g} m "
                                    "is taken: expected --meters-per-unit {:.6g}, or meshes written in the "
                                    "unit that is given",
                                    file, stated, metersPerUnit, stated));
    if (notes.step > 0)
        texts.push_back(fmt::format("{} lies so far from its origin that its coordinates, which are read as "
                                    "floats, are steps of {:.3g} units; write it with its origin near it",
                                    file, notes.step));
    return texts;
}

std::string extensionOf(const std::string& file) {
    return lowerCase(std::filesystem::path(file).extension().string());
}

bool isGltf(const std::string& file) {
    const std::string extension = extensionOf(file);
    return extension == ".gltf" || extension == ".glb" || extension == ".vrm";
}

} // namespace tss
