#include "bake/robot/ReadMsh.h"

#include "bake/base/Error.h"
#include "bake/geometry/Import.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace tss {

bool isMsh(const std::string& file) {
    return file.ends_with(".msh") || file.ends_with(".MSH");
}

TriangleMesh readMsh(const std::string& bytes, const std::string& file) {
    const auto refuse = [&](const std::string& message) {
        throw InputError(Where{file}, "as a mesh of MuJoCo (MSH): " + message);
    };
    std::array<std::int32_t, 4> counts; // vertices, normals, texture coordinates, faces
    if (bytes.size() < sizeof counts) refuse("expected 16 bytes of counts at the beginning");
    std::memcpy(counts.data(), bytes.data(), sizeof counts);
    std::uint64_t size = sizeof counts;
    for (std::size_t k = 0; k < 4; ++k) {
        if (counts[k] < 0) refuse("expected counts of 0 or more");
        size += std::uint64_t(4) * (k == 2 ? 2 : 3) * static_cast<std::uint64_t>(counts[k]);
    }
    if (size != bytes.size())
        refuse("expected " + std::to_string(size) + " bytes by its counts, found " +
               std::to_string(bytes.size()));
    TriangleMesh mesh;
    const char* from = bytes.data() + sizeof counts;
    const auto three = [&](auto& numbers) { std::memcpy(numbers.data(), from, 12), from += 12; };
    for (std::int32_t v = 0; v < counts[0]; ++v) {
        Eigen::Vector3f place;
        three(place);
        if (!place.allFinite()) refuse("expected finite coordinates at vertex " + std::to_string(v));
        mesh.vertices.push_back(place.cast<double>());
    }
    from = bytes.data() + bytes.size() - std::size_t(12) * static_cast<std::size_t>(counts[3]);
    for (std::int32_t f = 0; f < counts[3]; ++f) {
        Eigen::Matrix<std::int32_t, 3, 1> corners;
        three(corners);
        if (corners.minCoeff() < 0 || corners.maxCoeff() >= counts[0])
            refuse("face " + std::to_string(f) + " names a vertex that is not there");
        mesh.triangles.emplace_back(corners);
    }
    if (mesh.triangles.empty()) refuse("holds no triangle");
    return welded(mesh);
}

} // namespace tss
