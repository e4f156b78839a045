#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"
#include "bake/scene/ValueType.h"

namespace tss {

/// Big arrays may stand in files beside the scene: a value {"buffer": i, "byteOffset": o, "count": n} is n
/// elements of the attribute's type, packed and little-endian, of the i-th of the layer's "buffers": [{"uri",
/// "byteLength", "sha256"}]. A buffer is a regular file, no link, of a bare name in the scene's own folder,
/// with the size and the hash that are stated; no byte is used twice, so that a small file stays small in
/// memory. What is wrong goes to the problems.
class BufferReader {
public:
    BufferReader(std::string fileName, Problems& problems)
        : file_(std::move(fileName)), problems_(problems) {}

    void readAll(const Value& list, const Place& place);
    /// Puts the numbers in the place of a value that names them.
    void fill(Value& value, const ValueType& type, const Place& place);

private:
    std::optional<std::string> read(const Value::Object& keys, const Place& place);
    /// A whole number of at least 0.
    std::optional<std::uint64_t> whole(const Value::Object& keys, const char* key, const Place& place);
    std::optional<Value> view(const Value::Object& keys, const ValueType& type, const Place& place);

    struct Loaded {
        std::optional<std::string> bytes; ///< none: it could not be read
        std::size_t left = 0;             ///< bytes that no value has used yet
    };

    std::string file_;
    Problems& problems_;
    std::optional<std::vector<Loaded>> buffers_; ///< none: the file does not speak of buffers
};

/// Takes the numeric arrays of at least `fewest` elements out of the layer, which then names them in the one
/// buffer STEM.HASH.bin. Returns its name and its bytes; both empty when there are no such arrays.
struct Buffer {
    std::string uri, bytes;
};
Buffer takeBuffer(Layer& layer, const std::string& stem, std::size_t fewest = 256);

} // namespace tss
