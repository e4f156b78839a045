#pragma once
#include "bake/geometry/Import.h"

#include <functional>
#include <memory>
#include <string>

struct aiScene;

namespace tss {

// What reading through assimp has in common; of builds with OSGTSS_IMPORT.

/// A file as assimp reads it.
struct AssimpFile {
    std::unique_ptr<aiScene> scene;                     ///< has a root node
    Eigen::Affine3d root = Eigen::Affine3d::Identity(); ///< its root's place, as the file has it
    MeshFileNotes notes;

    AssimpFile();
    AssimpFile(AssimpFile&&) noexcept;
    ~AssimpFile();
};

/// Throws InputError. Some readers crash on a file, take all memory for it, or print: see readApart().
AssimpFile readAssimpFile(const std::string& file);

/// Takes the bytes that work makes of a mesh file in a process of its own; take() throws SubprocessFailed for
/// bytes that are cut short. Throws InputError, also for a file that is not there or that no reader can be
/// given, and where the process does not end well.
void readApart(const std::string& file, const std::function<std::string()>& work,
               const std::function<void(const std::string&)>& take);

} // namespace tss
