#include "bake/geometry/MeshFileParts.h"

#include "bake/base/Subprocess.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace tss {

namespace {

using Json = nlohmann::json;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Tri) == 3 * sizeof(int));

template <class T>
Json blockOf(const std::vector<T>& values) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
    return Json::binary({begin, begin + values.size() * sizeof(T)});
}

template <class T>
std::vector<T> valuesOf(const Json& block) {
    const Json::binary_t& bytes = block.get_binary();
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data()->data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

} // namespace

std::string bytesOf(const MeshFile& file) {
    const MeshFileNotes& notes = file.notes;
    Json json{{"leftOut", notes.leftOut},
              {"metersPerUnit", notes.metersPerUnit},
              {"upAxis", static_cast<int>(notes.upAxis)},
              {"step", notes.step},
              {"nodes", Json::array()}};
    for (const ImportedNode& node : file.nodes) {
        const double* place = node.place.matrix().data();
        json["nodes"].push_back({{"name", node.name},
                                 {"place", std::vector<double>(place, place + 16)},
                                 {"vertices", blockOf(node.mesh.vertices)},
                                 {"triangles", blockOf(node.mesh.triangles)}});
    }
    std::string bytes;
    Json::to_cbor(json, bytes);
    return bytes;
}

MeshFile meshFileOf(std::string_view bytes) {
    const Json json = Json::from_cbor(bytes, true, false);
    if (!json.is_object()) throw SubprocessFailed("cut short");
    MeshFile file;
    file.notes.leftOut = json["leftOut"].get<std::vector<std::string>>();
    file.notes.metersPerUnit = json["metersPerUnit"].get<double>();
    file.notes.upAxis = static_cast<char>(json["upAxis"].get<int>());
    file.notes.step = json["step"].get<double>();
    for (const Json& from : json["nodes"]) {
        ImportedNode& node = file.nodes.emplace_back();
        node.name = from["name"].get<std::string>();
        std::memcpy(node.place.matrix().data(), from["place"].get<std::vector<double>>().data(),
                    16 * sizeof(double));
        node.mesh.vertices = valuesOf<Vec3>(from["vertices"]);
        node.mesh.triangles = valuesOf<Tri>(from["triangles"]);
    }
    return file;
}

} // namespace tss
