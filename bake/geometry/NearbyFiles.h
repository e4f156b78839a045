#pragma once
#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <string>

namespace tss {

/// The files that an importer may open: regular ones, in the folder of the mesh file or below it, also
/// through links. A pipe is not waited for, and no path leads out.
class NearbyFiles : public Assimp::DefaultIOSystem {
public:
    /// file: the mesh file, as the user gave it.
    explicit NearbyFiles(const std::string& file);

    bool Exists(const char* file) const override;
    /// Null for a file that may not be opened.
    Assimp::IOStream* Open(const char* file, const char* mode) override;

    /// The last file that was asked for and may not be opened, and why; empty where there was none.
    const std::string& refused() const { return refused_; }

private:
    /// Empty for a file that may be opened; else why not.
    std::string whyNot(const std::string& file) const;

    std::filesystem::path file_, folder_, realFolder_;
    std::string refused_;
};

/// A PLY whose header has no end, for which an importer would look for ever. Throws InputError.
void expectEndedPly(const std::string& file);

/// A binary glTF whose chunks say that they are longer than the file is, which an importer would make room
/// for. Throws InputError.
void expectWholeGlb(const std::string& file);

} // namespace tss
