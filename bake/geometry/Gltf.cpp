// glTF 2.0 (Khronos, ISO/IEC 12113): morph targets are 3.7.2.2, skins 3.7.3.1, the binary container is 4.
#include "bake/geometry/MeshFileParts.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Words.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace tss {

namespace {

using Json = nlohmann::json;

constexpr int byteType = 5121, shortType = 5123, floatType = 5126; // glTF's codes for types of components
constexpr std::size_t glbHeader = 12, chunkHeader = 8;

/// Little-endian.
std::uint32_t numberAt(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t k = 4; k-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + k]);
    return number;
}

std::string bytesOf(std::size_t number) {
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(number >> 8 * k & 0xff);
    return bytes;
}

/// The file again with other JSON. end: of its first chunk.
std::string glbWith(std::string json, std::string_view file, std::size_t end) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string_view rest = file.substr(end);
    return "glTF" + bytesOf(2) + bytesOf(glbHeader + chunkHeader + json.size() + rest.size()) +
           bytesOf(json.size()) + "JSON" + json + std::string(rest);
}

/// Null where the text is no JSON, or more deeply nested than any glTF.
Json parsed(std::string_view text) {
    constexpr int most = 64;
    const auto shallow = [](int depth, Json::parse_event_t, Json&) { return depth < most; };
    const Json json = Json::parse(text, shallow, false);
    return json.is_object() ? json : Json();
}

/// assimp goes down by calling itself, and a chain of many thousand nodes, or one without an end, takes all
/// of the stack.
void expectShallow(const Json& gltf, const std::string& file) {
    constexpr std::size_t most = 1000;
    const Json nodes = gltf.value("nodes", Json::array());
    std::vector<std::size_t> parents(nodes.size(), nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
        if (nodes[k].is_object())
            for (const Json& child : nodes[k].value("children", Json::array()))
                if (child.is_number_unsigned() && child.get<std::size_t>() < nodes.size())
                    parents[child.get<std::size_t>()] = k;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        std::size_t levels = 0;
        for (std::size_t at = k; at < nodes.size() && levels <= most; at = parents[at]) ++levels;
        if (levels > most)
            throw InputError(Where{file, fmt::format("/nodes/{}", k)},
                             fmt::format("expected nodes at most {} levels deep", most));
    }
}

/// Throws InputError for a required extension that is not known to leave the surfaces as they are: it may
/// compress the coordinates or keep them elsewhere.
void expectKnown(const Json& gltf, const std::string& file) {
    constexpr std::array harmless = {"KHR_materials_",
                                     "KHR_texture_",
                                     "EXT_texture_",
                                     "MSFT_texture_",
                                     "KHR_lights_",
                                     "KHR_animation",
                                     "KHR_xmp",
                                     "EXT_lights_",
                                     "KHR_draco_",
                                     "AGI_",
                                     "KHR_technique",
                                     "KHR_mesh_quantization",
                                     "EXT_mesh_gpu_instancing"};
    for (const Json& name : gltf.value("extensionsRequired", Json::array())) {
        const std::string needed = name.get<std::string>();
        if (std::ranges::none_of(harmless, [&](const char* known) { return needed.starts_with(known); }))
            throw InputError(Where{file, "/extensionsRequired"},
                             "needs " + needed + ", which is not read; write it without");
    }
}

/// Throws InputError for positions of another number type: assimp would take their bytes for floats.
void expectFloats(const Json& gltf, const std::string& file) {
    const Json accessors = gltf.value("accessors", Json::array());
    for (const Json& mesh : gltf.value("meshes", Json::array()))
        for (const Json& primitive : mesh.at("primitives")) {
            const auto position = primitive.at("attributes").find("POSITION");
            if (position == primitive.at("attributes").end()) continue;
            const std::size_t k = position->get<std::size_t>();
            if (k >= accessors.size()) continue; // which the importer says
            if (const int type = accessors[k].at("componentType").get<int>(); type != floatType)
                throw InputError(Where{file, fmt::format("/accessors/{}/componentType", k)},
                                 fmt::format("expected positions in floats ({}), found {}; write it without "
                                             "quantization (KHR_mesh_quantization)",
                                             floatType, type));
        }
}

/// Whether an accessor has one of these component types and that type, as assimp takes for granted. Throws
/// Json::exception for one that is not there.
bool holds(const Json& gltf, const Json& accessor, std::initializer_list<int> components, const char* type) {
    const Json& found = gltf.at("accessors").at(accessor.get<std::size_t>());
    return found.at("type") == type &&
           std::ranges::find(components, found.at("componentType").get<int>()) != components.end();
}

/// Empty for a skin that assimp can read at a mesh; else what is wrong with it.
std::string whyNot(const Json& gltf, const Json& skin, const Json& mesh) {
    const Json& joints = skin.at("joints");
    for (const Json& joint : joints)
        if (joint.get<std::size_t>() >= gltf.at("nodes").size()) return "names a node that is not there";
    if (const auto binds = skin.find("inverseBindMatrices"); binds != skin.end())
        if (!holds(gltf, *binds, {floatType}, "MAT4") ||
            gltf["accessors"][binds->get<std::size_t>()].at("count").get<std::size_t>() < joints.size())
            return "has no inverse bind matrix in floats for each of its joints";
    for (const Json& primitive : mesh.at("primitives"))
        for (const auto& [name, accessor] : primitive.at("attributes").items()) {
            if (name.starts_with("WEIGHTS_") && !holds(gltf, accessor, {floatType}, "VEC4"))
                return "has weights that are no floats";
            if (name.starts_with("JOINTS_") && !holds(gltf, accessor, {byteType, shortType}, "VEC4"))
                return "has joints that are no bytes and no shorts";
        }
    return "";
}

/// Nodes no longer have skins that cannot be read, whose meshes then stand where their nodes are. Skins that
/// no node has are emptied.
void leaveOutSkins(Json& gltf, std::vector<std::string>& leftOut) {
    std::set<std::string> texts;
    std::set<std::size_t> used;
    for (Json& node : gltf["nodes"]) {
        const auto found = node.find("skin");
        if (found == node.end()) continue;
        std::string why = "is not there";
        const auto k = found->get<std::size_t>();
        if (k < gltf["skins"].size() && node.contains("mesh"))
            why = whyNot(gltf, gltf["skins"][k], gltf.at("meshes").at(node["mesh"].get<std::size_t>()));
        if (why.empty()) {
            used.insert(k);
            continue;
        }
        node.erase("skin");
        texts.insert(fmt::format("/skins/{}, which {}", k, why));
    }
    leftOut.insert(leftOut.end(), texts.begin(), texts.end());
    for (std::size_t k = 0; k < gltf["skins"].size(); ++k)
        if (!used.contains(k)) gltf["skins"][k] = {{"joints", Json::array()}};
}

/// assimp gives a skin to the mesh and not to the node, and knows no weights of a node (3.7.2.2): each node
/// with either gets a mesh of its own.
void separateMeshes(Json& gltf) {
    std::map<std::size_t, int> uses;
    for (const Json& node : gltf["nodes"])
        if (node.contains("mesh")) ++uses[node["mesh"].get<std::size_t>()];
    for (Json& node : gltf["nodes"]) {
        if (!node.contains("mesh") || !(node.contains("skin") || node.contains("weights"))) continue;
        auto k = node["mesh"].get<std::size_t>();
        if (uses[k]-- > 1) {
            const Json copy = gltf.at("meshes").at(k);
            gltf["meshes"].push_back(copy);
            node["mesh"] = k = gltf["meshes"].size() - 1;
        }
        if (node.contains("weights")) gltf.at("meshes").at(k)["weights"] = node["weights"];
    }
}

/// assimp finds the joints of a skin by their names, which glTF need not give them, nor but once.
void nameJoints(Json& gltf) {
    std::map<std::string, int> uses;
    for (const Json& node : gltf["nodes"]) ++uses[node.value("name", "")];
    for (const Json& skin : gltf["skins"])
        for (const Json& joint : skin.at("joints")) {
            Json& node = gltf["nodes"].at(joint.get<std::size_t>());
            const std::string name = node.value("name", "");
            if (!name.empty() && uses[name] < 2) continue;
            node["name"] = fmt::format("{}_{}", name.empty() ? "joint" : name, joint.get<std::size_t>());
        }
}

/// A skin without inverse bind matrices has identities (3.7.3.1), for which assimp looks in vain.
void addInverseBinds(Json& gltf) {
    for (Json& skin : gltf["skins"]) {
        if (skin.contains("inverseBindMatrices") || skin.at("joints").empty()) continue;
        const std::size_t count = skin.at("joints").size();
        std::string matrices;
        for (std::size_t k = 0; k < count * 16; ++k)
            matrices += k % 16 % 5 == 0 ? std::string("\0\0\x80\x3f", 4) : std::string(4, '\0'); // 1 and 0
        gltf["buffers"].push_back({{"byteLength", matrices.size()},
                                   {"uri", "data:application/octet-stream;base64," + base64(matrices)}});
        gltf["bufferViews"].push_back(
            {{"buffer", gltf["buffers"].size() - 1}, {"byteLength", matrices.size()}});
        gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                     {"componentType", floatType},
                                     {"count", count},
                                     {"type", "MAT4"}});
        skin["inverseBindMatrices"] = gltf["accessors"].size() - 1;
    }
}

/// Nodes, skins and weights as assimp reads them.
void prepareNodes(Json& gltf, std::vector<std::string>& leftOut) {
    if (!gltf.contains("nodes") || !gltf.contains("meshes")) return;
    if (!gltf.contains("skins")) gltf["skins"] = Json::array();
    leaveOutSkins(gltf, leftOut);
    separateMeshes(gltf);
    nameJoints(gltf);
    addInverseBinds(gltf);
}

void noteInstances(const Json& gltf, std::vector<std::string>& leftOut) {
    const Json extensions = gltf.value("extensionsUsed", Json::array());
    if (std::ranges::find(extensions, "EXT_mesh_gpu_instancing") != extensions.end())
        leftOut.push_back("the copies of meshes that EXT_mesh_gpu_instancing makes");
}

} // namespace

void expectWholeGlb(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    const auto next = [&](std::size_t count) {
        std::string bytes(count, '\0');
        stream.read(bytes.data(), static_cast<std::streamsize>(count));
        return bytes;
    };
    if (next(4) != "glTF" || !stream) return; // what it is the importer says
    const std::uint32_t version = numberAt(next(4), 0);
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    for (std::uint64_t at = glbHeader; !error && at + chunkHeader <= size;) {
        stream.seekg(static_cast<std::streamoff>(at));
        const std::uint64_t length = numberAt(next(4), 0), left = size - at - chunkHeader;
        if (length > left)
            throw InputError(Where{file}, fmt::format("is cut short: a chunk has {} bytes, and {} are left",
                                                      length, left));
        if (version == 1) return; // which has one, and behind it numbers as they are
        at += chunkHeader + length;
    }
}

std::optional<PlainGltf> plainGltf(const std::string& file) {
    const std::string bytes = readWholeFile(file);
    const bool binary = bytes.size() >= glbHeader + chunkHeader && bytes.starts_with("glTF");
    std::string_view text = bytes;
    if (binary) {
        const std::size_t size = numberAt(bytes, glbHeader), begin = glbHeader + chunkHeader;
        if (size > bytes.size() - begin) return std::nullopt;
        text = text.substr(begin, size);
    }
    Json gltf = parsed(text);
    try {
        if (!gltf.is_object() || !gltf.at("asset").at("version").get<std::string>().starts_with("2"))
            return std::nullopt;
        expectShallow(gltf, file);
        expectKnown(gltf, file);
        expectFloats(gltf, file);
        PlainGltf plain;
        prepareNodes(gltf, plain.leftOut);
        noteInstances(gltf, plain.leftOut);
        const std::string json = gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
        plain.bytes = binary ? glbWith(json, bytes, glbHeader + chunkHeader + text.size()) : json;
        return plain;
    } catch (const Json::exception&) { // something is of another type than glTF has it
        return std::nullopt;
    }
}

} // namespace tss
