#pragma once
#include "bake/base/Error.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tss {

/// Writes a whole file beside its place and renames it there: the old file stays intact when anything fails,
/// and no partial file is left. Throws InputError with the file and the system's reason.
void writeFileAtomically(const std::string& file, std::string_view content);

/// Throws InputError where that would not write the file: before long work, not after it.
void expectWritable(const std::string& file);

/// The whole content of a regular file. Throws InputError with the file and the system's reason.
std::string readWholeFile(const std::string& file);

/// A path is that of a folder, or of something below it; both are canonical.
bool isWithin(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Git LFS keeps a short text in place of each large file that has not been fetched. Throws InputError where
/// a file begins like one.
inline void expectFetched(const std::string& file, std::string_view begin) {
    if (begin.starts_with("version https://git-lfs.github.com/spec/"))
        throw InputError(Where{file},
                         "is a pointer of Git LFS; expected the file that it stands for: git lfs pull");
}

} // namespace tss
