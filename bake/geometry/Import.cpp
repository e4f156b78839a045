#include "bake/geometry/Import.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/Gltf.h"
#include "bake/geometry/MeshAudit.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <set>

#ifdef OSGTSS_IMPORT
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#endif

namespace tss {

TriangleMesh welded(const TriangleMesh& mesh) {
    const auto count = static_cast<int>(mesh.vertices.size());
    const auto less = [&](int a, int b) {
        const Vec3 &x = mesh.vertices[a], &y = mesh.vertices[b];
        for (int k = 0; k < 3; ++k)
            if (x[k] != y[k]) return x[k] < y[k];
        return a < b;
    };
    std::vector<int> order(count), first(count), place(count, -1);
    std::iota(order.begin(), order.end(), 0);
    // NaN has no place in an order: such vertices stay as they are.
    const auto finite =
        std::partition(order.begin(), order.end(), [&](int v) { return mesh.vertices[v].allFinite(); });
    std::sort(order.begin(), finite, less);
    std::iota(first.begin(), first.end(), 0);
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
        return whyNot(file).empty() && fs::is_regular_file(file, none);
    }
    /// Null for a file that may not be opened.
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        const std::string why = whyNot(file);
        if (instead_ && fs::path(file) == file_)
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(instead_->data()),
                                              instead_->size());
        if (why.empty()) return DefaultIOSystem::Open(file, mode);
        refused_ = why;
        return nullptr;
    }

    /// What is read in place of the mesh file; kept by the caller.
    void readInstead(const std::string& bytes) { instead_ = &bytes; }

    /// The last file that was asked for and may not be opened, and why; empty where there was none.
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

/// Little-endian, as glTF has it.
std::uint32_t readNumber(std::istream& stream) {
    unsigned char bytes[4] = {};
    stream.read(reinterpret_cast<char*>(bytes), 4);
    return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

/// A PLY whose header has no end, for which an importer would look for ever. Throws InputError.
void expectEndedPly(const std::string& file) {
    constexpr std::size_t most = 1 << 16; // of a header
    std::ifstream stream(file, std::ios::binary);
    std::string begin(most, '\0');
    stream.read(begin.data(), most);
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    if ((begin.starts_with("ply") || begin.starts_with("PLY")) && begin.find("end_header") == begin.npos)
        throw InputError(Where{file}, "cannot be read as a mesh: its header has no line end_header");
}

/// A binary glTF whose chunks say that they are longer than the file is, which an importer would make room
/// for. Throws InputError.
void expectWholeGlb(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    char magic[4] = {};
    stream.read(magic, 4);
    if (!stream || std::string(magic, 4) != "glTF") return; // what it is the importer says
    std::error_code error;
    const std::uint64_t size = fs::file_size(file, error);
    constexpr std::uint64_t header = 12, ofChunk = 8; // version and length; a chunk's length and type
    for (std::uint64_t at = header; !error && at + ofChunk <= size;) {
        stream.seekg(static_cast<std::streamoff>(at));
        const std::uint64_t length = readNumber(stream), left = size - at - ofChunk;
        if (length > left)
            throw InputError(Where{file}, "is cut short: a chunk has " + std::to_string(length) +
                                              " bytes, and " + std::to_string(left) + " are left");
        at += ofChunk + length;
    }
}

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
    return Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>::Map(m[0]).cast<double>();
}

void append(const aiMesh& source, const Eigen::Matrix4d& transform, TriangleMesh& mesh) {
    const auto offset = static_cast<int>(mesh.vertices.size());
    const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
    const Vec3 shift = transform.topRightCorner<3, 1>();
    const bool mirrors = linear.determinant() < 0;
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
        const aiVector3D& p = source.mVertices[v];
        mesh.vertices.push_back(linear * Vec3(p.x, p.y, p.z) + shift);
    }
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        if (face.mNumIndices != 3) continue;
        Tri t(static_cast<int>(face.mIndices[0]), static_cast<int>(face.mIndices[1]),
              static_cast<int>(face.mIndices[2]));
        if (mirrors) std::swap(t[1], t[2]); // keeps the outside outside
        mesh.triangles.push_back(t.array() + offset);
    }
}

void append(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent, TriangleMesh& mesh) {
    const Eigen::Matrix4d transform = parent * matrix(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) append(*scene.mMeshes[node.mMeshes[i]], transform, mesh);
    for (unsigned i = 0; i < node.mNumChildren; ++i) append(scene, *node.mChildren[i], transform, mesh);
}

void collect(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent,
             std::vector<ImportedNode>& nodes) {
    const Eigen::Matrix4d transform = parent * matrix(node.mTransformation);
    ImportedNode part{node.mName.C_Str(), Eigen::Affine3d(transform), {}};
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
        append(*scene.mMeshes[node.mMeshes[i]], Eigen::Matrix4d::Identity(), part.mesh);
    if (!part.mesh.empty()) nodes.push_back(std::move(part));
    for (unsigned i = 0; i < node.mNumChildren; ++i) collect(scene, *node.mChildren[i], transform, nodes);
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
        if (count > 0) names.push_back(std::to_string(count) + " " + what + (count > 1 ? "s" : ""));
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
void expectSmallFaces(const aiScene& scene, const std::string& file) {
    constexpr unsigned most = 10'000;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
            if (const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices; corners > most)
                throw InputError(Where{file}, "has a face of " + std::to_string(corners) +
                                                  " corners; expected at most " + std::to_string(most));
}

const aiScene& readFile(Assimp::Importer& importer, const std::string& file,
                        std::vector<std::string>* leftOut) {
    std::error_code error;
    if (!fs::exists(file, error)) throw InputError(Where{file}, "no such file");
    if (!fs::is_regular_file(file, error))
        throw InputError(Where{file}, "not a file, a mesh file was expected");
    expectWholeGlb(file);
    expectEndedPly(file);
    auto* files = new NearbyFiles(file);
    importer.SetIOHandler(files); // which owns it
    const std::optional<PlainGltf> gltf = isGltf(file) ? plainGltf(file) : std::nullopt;
    if (gltf) files->readInstead(gltf->bytes);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true); // else nodes alone get a made-up one
    // STL and the like repeat a vertex for every face: welded() joins them, exactly equal ones only.
    const aiScene* scene = importer.ReadFile(file, 0);
    if (scene) expectSmallFaces(*scene, file);
    if (scene) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (!scene || !scene->mRootNode)
        throw InputError(Where{file},
                         "cannot be read as a mesh: " +
                             (files->refused().empty() ? importer.GetErrorString() : files->refused()));
    if (leftOut) {
        *leftOut = leftOutOf(*scene);
        if (gltf) leftOut->insert(leftOut->end(), gltf->leftOut.begin(), gltf->leftOut.end());
    }
    return *scene;
}

/// The mesh of a file, welded.
TriangleMesh checked(const TriangleMesh& mesh, const std::string& file) {
    return inFile(file, [&] {
        checkIndices(mesh);
        return welded(mesh);
    });
}

[[noreturn]] void refuseEmpty(const std::string& file) {
    throw InputError(Where{file}, "holds no triangle, a mesh with faces was expected");
}

} // namespace

TriangleMesh importMesh(const std::string& file, MeshAxes axes, std::vector<std::string>* leftOut) {
    Assimp::Importer importer;
    if (axes == MeshAxes::AsWritten)
        importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const aiScene& scene = readFile(importer, file, leftOut);
    TriangleMesh mesh;
    append(scene, *scene.mRootNode, Eigen::Matrix4d::Identity(), mesh);
    if (mesh.triangles.empty()) refuseEmpty(file);
    mesh = checked(mesh, file);
    const auto isFlat = [&](const Tri& t) {
        const std::vector<Vec3>& x = mesh.vertices;
        return hasZeroArea(x[t[0]], x[t[1]], x[t[2]]);
    };
    if (std::ranges::all_of(mesh.triangles, isFlat))
        throw InputError(Where{file}, "has no area, a mesh with a surface was expected");
    return mesh;
}

std::vector<ImportedNode> importNodes(const std::string& file, std::vector<std::string>* leftOut) {
    Assimp::Importer importer;
    const aiScene& scene = readFile(importer, file, leftOut);
    std::vector<ImportedNode> nodes;
    collect(scene, *scene.mRootNode, Eigen::Matrix4d::Identity(), nodes);
    if (nodes.empty()) refuseEmpty(file);
    for (ImportedNode& node : nodes) node.mesh = checked(node.mesh, file);
    return nodes;
}

#else

TriangleMesh importMesh(const std::string& file, MeshAxes, std::vector<std::string>*) {
    throw InputError(Where{file}, "this build reads no mesh files (OSGTSS_IMPORT is off)");
}

std::vector<ImportedNode> importNodes(const std::string& file, std::vector<std::string>*) {
    throw InputError(Where{file}, "this build reads no mesh files (OSGTSS_IMPORT is off)");
}

#endif

bool isGltf(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".gltf" || extension == ".glb";
}

} // namespace tss
