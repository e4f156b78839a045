#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "tests/SharedMeshes.h"

#include <fstream>
#include <sstream>

namespace skins {

/// A real mesh with its vertices in the order of the file, which captured shapes count on.
inline tss::TriangleMesh realSkin(const std::string& name) {
    tss::TriangleMesh mesh;
    std::ifstream stream(sharedMesh(name));
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "v") {
            tss::Vec3 v;
            words >> v[0] >> v[1] >> v[2];
            mesh.vertices.push_back(v);
        } else if (key == "f") {
            tss::Tri t;
            words >> t[0] >> t[1] >> t[2];
            mesh.triangles.push_back(t - tss::Tri::Ones());
        }
    }
    return mesh;
}

} // namespace skins
