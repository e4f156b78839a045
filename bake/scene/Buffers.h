#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

namespace tss {

/// Big arrays may stand in files beside the scene: a value {"buffer": i, "byteOffset": o, "count": n} is n
/// elements of the attribute's type, packed and little-endian, of the i-th of the layer's "buffers": [{"uri",
/// "byteLength", "sha256"}]. Puts the numbers where they are named and takes the key "buffers" away. A buffer
/// is a regular file, no link, of a bare name in the scene's own folder, with the size and the hash that are
/// stated; no byte is used twice, so that a small file stays small in memory. What is wrong goes to the
/// problems.
void inlineBuffers(Value& root, const std::string& fileName, Problems& problems);

/// Takes the numeric arrays of at least `fewest` elements out of the layer, which then names them in the one
/// buffer STEM.HASH.bin. Returns its name and its bytes; both empty when there are no such arrays.
struct Buffer {
    std::string uri, bytes;
};
Buffer takeBuffer(Layer& layer, const std::string& stem, std::size_t fewest = 256);

} // namespace tss
