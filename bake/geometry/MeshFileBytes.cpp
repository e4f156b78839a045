#include "bake/geometry/MeshFileParts.h"

#include "bake/base/Subprocess.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace tss {

namespace {

using Json = nlohmann::json;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Tri) == 3 * sizeof(int));
static_assert(sizeof(Eigen::Vector4d) == 4 * sizeof(double) &&
              sizeof(Eigen::Affine3d) == 16 * sizeof(double));

template <class T>
Json blockOf(const std::vector<T>& values) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
    return Json::binary({begin, begin + values.size() * sizeof(T)});
}

template <class T>
std::vector<T> valuesOf(const Json& block) {
    const Json::binary_t& bytes = block.get_binary();
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty())
        std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(T));
    return values;
}

Json jsonOf(const MeshFileNotes& notes) {
    return {{"leftOut", notes.leftOut},
            {"metersPerUnit", notes.metersPerUnit},
            {"upAxis", static_cast<int>(notes.upAxis)},
            {"step", notes.step}};
}

MeshFileNotes notesOf(const Json& json) {
    MeshFileNotes notes;
    notes.leftOut = json["leftOut"].get<std::vector<std::string>>();
    notes.metersPerUnit = json["metersPerUnit"].get<double>();
    notes.upAxis = static_cast<char>(json["upAxis"].get<int>());
    notes.step = json["step"].get<double>();
    return notes;
}

std::string textOf(const Json& json) {
    std::string bytes;
    Json::to_cbor(json, bytes);
    return bytes;
}

Json parsedBytes(std::string_view bytes) {
    Json json = Json::from_cbor(bytes, true, false);
    if (!json.is_object()) throw SubprocessFailed("cut short");
    return json;
}

Json jsonOf(const RigFile::Mesh& mesh) {
    std::vector<int> nodes, counts, bones;
    std::vector<Eigen::Affine3d> offsets;
    std::vector<double> weights;
    for (const auto& [node, offset] : mesh.bones) {
        nodes.push_back(node);
        offsets.push_back(offset);
    }
    for (const auto& of : mesh.weights) {
        counts.push_back(static_cast<int>(of.size()));
        for (const auto& [bone, weight] : of) {
            bones.push_back(bone);
            weights.push_back(weight);
        }
    }
    return {{"node", mesh.node},
            {"vertices", blockOf(mesh.surface.vertices)},
            {"triangles", blockOf(mesh.surface.triangles)},
            {"nodes", blockOf(nodes)},
            {"offsets", blockOf(offsets)},
            {"counts", blockOf(counts)},
            {"bones", blockOf(bones)},
            {"weights", blockOf(weights)}};
}

RigFile::Mesh rigMeshOf(const Json& json) {
    RigFile::Mesh mesh;
    mesh.node = json["node"].get<int>();
    mesh.surface.vertices = valuesOf<Vec3>(json["vertices"]);
    mesh.surface.triangles = valuesOf<Tri>(json["triangles"]);
    const auto nodes = valuesOf<int>(json["nodes"]);
    const auto offsets = valuesOf<Eigen::Affine3d>(json["offsets"]);
    for (std::size_t b = 0; b < nodes.size(); ++b) mesh.bones.emplace_back(nodes[b], offsets.at(b));
    const auto bones = valuesOf<int>(json["bones"]);
    const auto weights = valuesOf<double>(json["weights"]);
    std::size_t next = 0;
    for (const int count : valuesOf<int>(json["counts"])) {
        auto& of = mesh.weights.emplace_back();
        for (int k = 0; k < count; ++k, ++next) of.emplace_back(bones.at(next), weights.at(next));
    }
    return mesh;
}

Json jsonOf(const RigFile::Channel& channel) {
    return {{"node", channel.node},
            {"placeTimes", blockOf(channel.placeTimes)},
            {"turnTimes", blockOf(channel.turnTimes)},
            {"scaleTimes", blockOf(channel.scaleTimes)},
            {"places", blockOf(channel.places)},
            {"turns", blockOf(channel.turns)},
            {"scales", blockOf(channel.scales)}};
}

RigFile::Channel channelOf(const Json& json) {
    RigFile::Channel channel;
    channel.node = json["node"].get<int>();
    channel.placeTimes = valuesOf<double>(json["placeTimes"]);
    channel.turnTimes = valuesOf<double>(json["turnTimes"]);
    channel.scaleTimes = valuesOf<double>(json["scaleTimes"]);
    channel.places = valuesOf<Eigen::Vector3d>(json["places"]);
    channel.turns = valuesOf<Eigen::Vector4d>(json["turns"]);
    channel.scales = valuesOf<Eigen::Vector3d>(json["scales"]);
    return channel;
}

} // namespace

std::string bytesOf(const MeshFile& file) {
    Json json = jsonOf(file.notes);
    json["nodes"] = Json::array();
    for (const ImportedNode& node : file.nodes) {
        const double* place = node.place.matrix().data();
        json["nodes"].push_back({{"name", node.name},
                                 {"place", std::vector<double>(place, place + 16)},
                                 {"vertices", blockOf(node.mesh.vertices)},
                                 {"triangles", blockOf(node.mesh.triangles)}});
    }
    return textOf(json);
}

MeshFile meshFileOf(std::string_view bytes) {
    const Json json = parsedBytes(bytes);
    MeshFile file;
    file.notes = notesOf(json);
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

std::string bytesOf(const RigFile& file) {
    Json json = jsonOf(file.notes);
    for (const char* list : {"names", "animations", "meshes"}) json[list] = Json::array();
    std::vector<int> parents;
    std::vector<Eigen::Affine3d> locals;
    for (const RigFile::Node& node : file.nodes) {
        json["names"].push_back(node.name);
        parents.push_back(node.parent);
        locals.push_back(node.local);
    }
    json["parents"] = blockOf(parents);
    json["locals"] = blockOf(locals);
    for (const RigFile::Animation& animation : file.animations) {
        Json channels = Json::array();
        for (const RigFile::Channel& channel : animation.channels) channels.push_back(jsonOf(channel));
        json["animations"].push_back({{"name", animation.name}, {"channels", channels}});
    }
    for (const RigFile::Mesh& mesh : file.meshes) json["meshes"].push_back(jsonOf(mesh));
    return textOf(json);
}

RigFile rigFileOf(std::string_view bytes) {
    const Json json = parsedBytes(bytes);
    RigFile file;
    file.notes = notesOf(json);
    const auto parents = valuesOf<int>(json["parents"]);
    const auto locals = valuesOf<Eigen::Affine3d>(json["locals"]);
    for (std::size_t n = 0; n < parents.size(); ++n)
        file.nodes.push_back({json["names"][n].get<std::string>(), parents[n], locals.at(n)});
    for (const Json& from : json["animations"]) {
        RigFile::Animation& animation = file.animations.emplace_back();
        animation.name = from["name"].get<std::string>();
        for (const Json& channel : from["channels"]) animation.channels.push_back(channelOf(channel));
    }
    for (const Json& mesh : json["meshes"]) file.meshes.push_back(rigMeshOf(mesh));
    return file;
}

} // namespace tss
