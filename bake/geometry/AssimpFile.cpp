#include "bake/geometry/AssimpFile.h"

#ifdef OSGTSS_IMPORT

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Subprocess.h"
#include "bake/base/Words.h"
#include "bake/geometry/MeshFileParts.h"
#include "bake/geometry/SkinPlaces.h"

#include <algorithm>
#include <array>
#include <assimp/DefaultIOSystem.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <new>
#include <optional>
#include <set>
#include <string_view>

namespace tss {

namespace {

namespace fs = std::filesystem;

fs::path realPath(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::absolute(path, error), real = fs::weakly_canonical(whole, error);
    return error ? whole.lexically_normal() : real;
}

/// The files that an importer may open: regular ones, in the folder of the mesh file or below it, also
/// through links. A pipe is not waited for, and no path leads out.
class NearbyFiles : public Assimp::DefaultIOSystem {
public:
    /// file: the mesh file, as the user gave it.
    explicit NearbyFiles(const std::string& file)
        : file_(file), folder_(realPath(fs::absolute(file).parent_path())),
          realFolder_(realPath(file).parent_path()) {}

    bool Exists(const char* file) const override {
        std::error_code none;
        if (instead_ && fs::path(file) == file_) return true;
        return whyNot(file).empty() && fs::is_regular_file(file, none);
    }
    /// Null for a file that may not be opened.
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        const std::string why = whyNot(file);
        if (instead_ && fs::path(file) == file_)
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(instead_->data()),
                                              instead_->size());
        if (why.empty()) return DefaultIOSystem::Open(file, mode);
        if (fs::path(file).extension() != ".mtl") refused_ = why;
        return nullptr;
    }

    /// What is read in place of the mesh file; kept by the caller.
    void readInstead(const std::string& bytes) { instead_ = &bytes; }

    /// The last file that was asked for and may not be opened, and why; empty where there was none. Not of
    /// materials, which change no surface.
    const std::string& refused() const { return refused_; }

private:
    /// Empty for a file that may be opened; else why not.
    std::string whyNot(const std::string& file) const {
        if (fs::path(file) == file_) return "";
        const fs::path real = realPath(file);
        if (!isWithin(real, folder_) && !isWithin(real, realFolder_))
            return file + " lies outside of " + folder_.string() + ", the folder of the mesh";
        std::error_code none;
        return fs::exists(real, none) && !fs::is_regular_file(real, none) ? file + " is not a regular file"
                                                                          : "";
    }

    fs::path file_, folder_, realFolder_;
    std::string refused_;
    const std::string* instead_ = nullptr;
};

/// The first bytes of a file.
std::string beginOf(const std::string& file, std::size_t most) {
    std::ifstream stream(file, std::ios::binary);
    std::string begin(most, '\0');
    stream.read(begin.data(), static_cast<std::streamsize>(most));
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    return begin;
}

/// A PLY whose header has no end, for which an importer would look for ever. Throws InputError.
void expectEndedPly(const std::string& file, const std::string& begin) {
    if ((begin.starts_with("ply") || begin.starts_with("PLY")) && begin.find("end_header") == begin.npos)
        throw InputError(Where{file}, "cannot be read as a mesh: its header has no line end_header");
}

/// A binary STL of another size than its header says, of which an importer says that it is no STL. Throws
/// InputError.
void expectWholeStl(const std::string& file, const std::string& begin) {
    constexpr std::size_t header = 84, each = 50;
    if (extensionOf(file) != ".stl" || begin.size() < header || begin.starts_with("solid") ||
        begin.find('\0') >= header) // text
        return;
    std::uint32_t count = 0;
    for (std::size_t k = header; k-- > header - 4;) count = count << 8 | static_cast<unsigned char>(begin[k]);
    const std::uintmax_t has = fs::file_size(file), says = header + each * std::uintmax_t(count);
    if (has != says)
        throw InputError(Where{file},
                         fmt::format("cannot be read as a mesh: its header says {}, which take {} bytes, and "
                                     "it has {}; write it again",
                                     counted(count, "triangle"), says, has));
}

bool hasPlyStrips(const std::string& file) {
    constexpr std::size_t header = 1 << 16;
    const std::string begin = beginOf(file, header);
    return lowerCase(begin.substr(0, 3)) == "ply" &&
           begin.find("element tristrips") < begin.find("end_header");
}

/// What assimp says of lost surface in its log alone, and goes on. It has one log for a process.
class Losses : public Assimp::LogStream {
public:
    /// Throws InputError for single faces that are lost, or have got other corners.
    static void expectNoFaces() {
        if (faces_.empty()) return;
        throw InputError("cannot be read whole: assimp says \"" + faces_ +
                         "\"; write it again, or in another format, as STL, OBJ, PLY or glTF");
    }
    /// Whole parts, in assimp's words.
    static const std::set<std::string>& parts() { return parts_; }

    void write(const char* line) override {
        constexpr std::array ofFaces = {
            "faces were dropped",    "Not supported token in face", "OFF: Vertex index is out of range",
            "Vertex index overflow", "A new facet begins",          "facet with more than 3 vertices"};
        constexpr std::array ofParts = {"Unable to find geometry", "Unable to resolve reference to instanced",
                                        "resolve block reference", "Skipping this element instance",
                                        "vertices for polymesh",   "more than 4 indices per face",
                                        "unexpected vertex setup", "source object for incoming Model link"};
        const std::string_view text = line;
        const auto isAbout = [&](const char* words) { return text.find(words) != text.npos; };
        if (std::ranges::any_of(ofFaces, isAbout)) faces_ = said(text);
        if (std::ranges::any_of(ofParts, isAbout)) parts_.insert(said(text));
    }

private:
    /// Without "Error, T0: " and the end of the line.
    static std::string said(std::string_view line) {
        const std::size_t thread = line.find(": "), begin = thread == line.npos ? 0 : thread + 2;
        return std::string(line.substr(begin, line.find('\n', begin) - begin));
    }

    static inline std::string faces_;
    static inline std::set<std::string> parts_;
};

/// That of the root as its file has it: some of assimp's readers turn what has Z up so that Y is.
Eigen::Affine3d placeOfRoot(const aiScene& scene, const std::string& file) {
    Eigen::Affine3d upright = Eigen::Affine3d::Identity();
    upright.linear().block<2, 2>(1, 1) << 0, 1, -1, 0;
    const Eigen::Affine3d place = placeOf(scene.mRootNode->mTransformation);
    constexpr std::array turning = {".3ds", ".ase", ".ask", ".dxf", ".md2", ".md3", ".md5mesh"};
    const bool turned =
        place.matrix() == upright.matrix() && std::ranges::find(turning, extensionOf(file)) != turning.end();
    return turned ? Eigen::Affine3d::Identity() : place;
}

std::vector<std::string> leftOutOf(const aiScene& scene) {
    std::size_t shapes = 0, lines = 0;
    std::set<std::string> bones; // one may carry several meshes
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned b = 0; b < mesh.mNumBones; ++b) bones.insert(mesh.mBones[b]->mName.C_Str());
        shapes += mesh.mNumAnimMeshes;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) lines += mesh.mFaces[f].mNumIndices < 3;
    }
    std::vector<std::string> names;
    const auto add = [&](std::size_t count, const char* what) {
        if (count > 0) names.push_back(counted(count, what));
    };
    add(scene.mNumAnimations, "animation");
    add(bones.size(), "bone");
    add(shapes, "blend shape");
    add(scene.mNumCameras, "camera");
    add(scene.mNumLights, "light");
    add(lines, "point or line");
    return names;
}

/// Cutting a face into triangles takes the square of its corners.
void expectSmallFaces(const aiScene& scene) {
    constexpr unsigned most = 10'000;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
            if (const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices; corners > most)
                throw InputError("has a face of " + std::to_string(corners) + " corners; expected at most " +
                                 std::to_string(most));
}

std::unique_ptr<aiScene> importScene(Assimp::Importer& importer, NearbyFiles& files,
                                     const std::string& file) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Losses, Assimp::Logger::Warn | Assimp::Logger::Err);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true); // else nodes alone get a made-up one
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true); // nothing is turned
    // STL and the like repeat a vertex for every face: welded() joins them, exactly equal ones only.
    const aiScene* scene = importer.ReadFile(file, 0);
    const std::string why = files.refused().empty() ? importer.GetErrorString() : files.refused();
    if (why == std::bad_alloc().what()) throw std::bad_alloc();
    if (!scene || !scene->mRootNode)
        throw InputError("cannot be read as a mesh: " + (why.empty() ? "its reader does not say why" : why));
    Losses::expectNoFaces();
    expectSmallFaces(*scene);
    return std::unique_ptr<aiScene>(importer.GetOrphanedScene());
}

/// What to say of a file that is not there: one beside it whose name has other capital letters, as of a file
/// that was written where these count for nothing.
std::string missing(const fs::path& file) {
    const std::string name = lowerCase(file.filename().string());
    std::error_code error;
    for (const auto& other : fs::directory_iterator(file.has_parent_path() ? file.parent_path() : ".", error))
        if (lowerCase(other.path().filename().string()) == name)
            return "no such file; there is " + other.path().filename().string();
    return "no such file";
}

} // namespace

AssimpFile readAssimpFile(const std::string& file) {
    Assimp::Importer importer;
    const std::optional<PlainGltf> gltf = isGltf(file) ? plainGltf(file) : std::nullopt;
    std::string named = file;
    if (gltf && extensionOf(file) == ".vrm") // which assimp does not know
        named += gltf->bytes.starts_with("glTF") ? ".glb" : ".gltf";
    auto* files = new NearbyFiles(named);
    importer.SetIOHandler(files); // which owns it
    const std::string ply = hasPlyStrips(file) ? plainPly(file) : "";
    if (gltf || !ply.empty()) files->readInstead(gltf ? gltf->bytes : ply);
    AssimpFile read;
    read.scene = importScene(importer, *files, named);
    if (gltf) applyBlendShapes(*read.scene);
    read.root = placeOfRoot(*read.scene, file);
    read.notes = statedNotes(file, *read.scene);
    const std::vector<std::string> leftOut = leftOutOf(*read.scene);
    read.notes.leftOut.insert(read.notes.leftOut.begin(), leftOut.begin(), leftOut.end());
    if (gltf) read.notes.leftOut.insert(read.notes.leftOut.end(), gltf->leftOut.begin(), gltf->leftOut.end());
    for (const std::string& part : Losses::parts())
        read.notes.leftOut.push_back("a part, of which assimp says \"" + part + "\"");
    if (!files->refused().empty()) read.notes.leftOut.push_back(files->refused());
    return read;
}

AssimpFile::AssimpFile() = default;
AssimpFile::AssimpFile(AssimpFile&&) noexcept = default;
AssimpFile::~AssimpFile() = default;

void readApart(const std::string& file, const std::function<std::string()>& work,
               const std::function<void(const std::string&)>& take) {
    std::error_code error;
    if (!fs::exists(file, error)) throw InputError(Where{file}, missing(file));
    if (!fs::is_regular_file(file, error))
        throw InputError(Where{file}, "not a file, a mesh file was expected");
    const std::string begin = beginOf(file, 1 << 16); // as long as a header may be
    expectFetched(file, begin);
    expectWholeGlb(file);
    expectEndedPly(file, begin);
    expectWholeStl(file, begin);
    // 4 GB, and what a large file takes that is packed.
    const std::size_t memory = (std::size_t(4) << 30) + 64 * fs::file_size(file);
    try {
        inFile(file, [&] { take(runInSubprocess(work, memory)); });
    } catch (const SubprocessFailed& end) {
        throw InputError(Where{file}, fmt::format("cannot be read as a mesh: assimp's reader of it {}; write "
                                                  "it in another format, as STL, OBJ, PLY or glTF",
                                                  end.what()));
    }
}

} // namespace tss

#endif
