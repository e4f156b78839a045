// glTF 2.0 (Khronos, ISO/IEC 12113): skins are 3.7.3.1, the binary container is 4.
#include "bake/geometry/MeshFileParts.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Words.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace tss {

namespace {

using Json = nlohmann::json;

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

/// Whatever else a file needs may change its surfaces: where its coordinates are packed, or stand elsewhere.
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

/// assimp takes the bytes of others for floats.
void expectFloats(const Json& gltf, const std::string& file) {
    constexpr int floats = 5126; // glTF's code
    const Json accessors = gltf.value("accessors", Json::array());
    for (const Json& mesh : gltf.value("meshes", Json::array()))
        for (const Json& primitive : mesh.at("primitives")) {
            const auto position = primitive.at("attributes").find("POSITION");
            if (position == primitive.at("attributes").end()) continue;
            const std::size_t k = position->get<std::size_t>();
            if (k >= accessors.size()) continue; // which the importer says
            if (const int type = accessors[k].at("componentType").get<int>(); type != floats)
                throw InputError(Where{file, fmt::format("/accessors/{}/componentType", k)},
                                 fmt::format("expected positions in floats ({}), found {}; write it without "
                                             "quantization (KHR_mesh_quantization)",
                                             floats, type));
        }
}

std::vector<std::string> takeSkins(Json& gltf) {
    std::set<std::int64_t> joints;
    const Json skins = gltf.value("skins", Json::array());
    gltf.erase("skins");
    if (gltf.contains("nodes"))
        for (Json& node : gltf["nodes"])
            if (node.is_object()) node.erase("skin");
    for (const Json& skin : skins)
        if (skin.is_object())
            for (const Json& joint : skin.value("joints", Json::array()))
                if (joint.is_number_integer()) joints.insert(joint.get<std::int64_t>());
    std::vector<std::string> leftOut;
    if (!joints.empty()) leftOut.push_back(counted(joints.size(), "bone"));
    const Json extensions = gltf.value("extensionsUsed", Json::array());
    if (std::ranges::find(extensions, "EXT_mesh_gpu_instancing") != extensions.end())
        leftOut.push_back("the copies of meshes that EXT_mesh_gpu_instancing makes");
    return leftOut;
}

} // namespace

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
        plain.leftOut = takeSkins(gltf);
        const std::string json = gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
        plain.bytes = binary ? glbWith(json, bytes, glbHeader + chunkHeader + text.size()) : json;
        return plain;
    } catch (const Json::exception&) { // something is of another type than glTF has it
        return std::nullopt;
    }
}

} // namespace tss
