#include "bake/geometry/MeshFileParts.h"

#ifdef OSGTSS_IMPORT

#include "bake/base/AtomicFile.h"

#include <algorithm>
#include <array>
#include <assimp/scene.h>
#include <cmath>
#include <limits>
#include <memory>
#include <minizip/unzip.h>
#include <string_view>

namespace tss {

namespace {

/// Of the first element of that name, or empty.
std::string_view attribute(std::string_view xml, const std::string& element, const std::string& name) {
    const auto begin = xml.find("<" + element + " ");
    if (begin == xml.npos) return {};
    const std::string_view tag = xml.substr(begin, xml.find('>', begin) - begin);
    const auto at = tag.find(" " + name + "=");
    if (at == tag.npos) return {};
    const std::string_view value = tag.substr(at + name.size() + 2);
    return value.empty() ? value : value.substr(1, value.find(value[0], 1) - 1);
}

/// Metres; 0 where it is none of theirs. 3MF core specification, 3.4; ASTM F2915 (AMF). Both have millimetres
/// where they do not say.
double lengthOf(std::string_view unit) {
    struct Unit {
        std::string_view name;
        double metres;
    };
    constexpr std::array units = {Unit{"", 0.001},      Unit{"millimeter", 0.001}, Unit{"micron", 1e-6},
                                  Unit{"meter", 1},     Unit{"centimeter", 0.01},  Unit{"inch", 0.0254},
                                  Unit{"foot", 0.3048}, Unit{"feet", 0.3048}};
    const auto found = std::ranges::find(units, unit, &Unit::name);
    return found == units.end() ? 0 : found->metres;
}

/// Of the file that the archive stands at; empty where it cannot be read.
std::string content(unzFile archive) {
    std::string text;
    if (unzOpenCurrentFile(archive) != UNZ_OK) return text;
    std::array<char, 1 << 16> some;
    int count = 0;
    while ((count = unzReadCurrentFile(archive, some.data(), some.size())) > 0)
        text.append(some.data(), static_cast<std::size_t>(count));
    return unzCloseCurrentFile(archive) == UNZ_OK && count == 0 ? text : "";
}

/// The models that a 3MF holds, as one text: the first is the one that the others are part of.
std::string modelsOf(const std::string& file) {
    const std::unique_ptr<void, int (*)(unzFile)> archive(unzOpen(file.c_str()), unzClose);
    std::vector<std::pair<std::string, std::string>> models;
    std::array<char, 1024> name{};
    for (int at = archive ? unzGoToFirstFile(archive.get()) : UNZ_BADZIPFILE; at == UNZ_OK;
         at = unzGoToNextFile(archive.get())) {
        unz_file_info info;
        if (unzGetCurrentFileInfo(archive.get(), &info, name.data(), name.size() - 1, nullptr, 0, nullptr,
                                  0) != UNZ_OK)
            break;
        if (std::string_view(name.data()).ends_with(".model"))
            models.emplace_back(name.data(), content(archive.get()));
    }
    // By their length: 3D/3dmodel.model before 3D/Objects/part.model.
    std::ranges::sort(models, {},
                      [](const auto& model) { return std::pair(model.first.size(), model.first); });
    std::string text;
    for (const auto& [path, xml] : models) text += xml;
    return text;
}

void addOf3mf(const std::string& xml, MeshFileNotes& notes) {
    notes.metersPerUnit = lengthOf(attribute(xml, "model", "unit"));
    if (xml.find(":path=") != xml.npos) // of the production extension, on components and items
        notes.leftOut.push_back("the parts that stand in other files of its archive (p:path)");
}

void addOfFbx(const aiScene& scene, MeshFileNotes& notes) {
    if (!scene.mMetaData) return;
    float centimetres = 0;
    double precise = 0;
    std::int32_t axis = -1;
    if (scene.mMetaData->Get("UnitScaleFactor", precise))
        notes.metersPerUnit = precise / 100;
    else if (scene.mMetaData->Get("UnitScaleFactor", centimetres))
        notes.metersPerUnit = std::round(centimetres * 1e4) / 1e6; // 2.54, and not the float next to it
    if (scene.mMetaData->Get("UpAxis", axis)) notes.upAxis = axis == 1 ? 'Y' : axis == 2 ? 'Z' : '\0';
}

/// Units; 0 where they are fine enough for a mesh of its size.
double stepOf(const aiScene& scene) {
    constexpr double coarse = 1e-4; // of a mesh's diagonal
    double worst = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        Eigen::AlignedBox3d box;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            box.extend(Vec3(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z));
        if (box.isEmpty()) continue;
        const double far = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()),
                     step = far * std::numeric_limits<float>::epsilon();
        if (step > coarse * box.diagonal().norm()) worst = std::max(worst, step);
    }
    return worst;
}

} // namespace

MeshFileNotes statedNotes(const std::string& file, const aiScene& scene) {
    const std::string extension = extensionOf(file);
    MeshFileNotes notes;
    notes.step = stepOf(scene);
    if (isGltf(file)) {
        notes.metersPerUnit = 1;
        notes.upAxis = 'Y';
    } else if (extension == ".dae" || extension == ".zae") {
        notes.metersPerUnit = 1;
        if (extension == ".dae") {
            const std::string xml = readWholeFile(file);
            const auto at = xml.find("<up_axis>");
            notes.upAxis = at == xml.npos || xml.find("Y_UP", at) == at + 9 ? 'Y' : 'Z';
        }
    } else if (extension == ".fbx") {
        addOfFbx(scene, notes);
    } else if (extension == ".3mf") {
        addOf3mf(modelsOf(file), notes);
    } else if (extension == ".amf") {
        const std::string xml = readWholeFile(file);
        if (!xml.starts_with("PK")) notes.metersPerUnit = lengthOf(attribute(xml, "amf", "unit"));
    }
    return notes;
}

} // namespace tss

#endif
