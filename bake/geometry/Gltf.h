#pragma once
#include <optional>
#include <string>
#include <vector>

namespace tss {

/// A glTF file, text or binary, without what is not used of it.
struct PlainGltf {
    std::string bytes;
    std::vector<std::string> leftOut; ///< in a few words each: "2 bones"
};

/// The file without its skins: assimp crashes on one that has no inverse bind matrices, as glTF lets it.
/// Nothing where it is no glTF 2 that can be read as JSON: what it is then the importer says. Throws
/// InputError for nodes that are more than 1000 levels deep, for positions that are no floats, and where the
/// file needs an extension that is not read and may change surfaces.
std::optional<PlainGltf> plainGltf(const std::string& file);

} // namespace tss
