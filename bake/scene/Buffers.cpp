#include "bake/scene/Buffers.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Sha256.h"

#include <bit>
#include <cmath>
#include <filesystem>

namespace tss {

namespace fs = std::filesystem;

namespace {

constexpr const char *uriKey = "uri", *lengthKey = "byteLength", *hashKey = "sha256";
constexpr const char *bufferKey = "buffer", *offsetKey = "byteOffset", *countKey = "count";

enum class Scalar { None, Byte, Int, Uint, Float, Double };

/// How a number of this type stands in a buffer; None: it does not.
Scalar scalarOf(const ValueType& type) {
    if (!type.array || type.rows > 1) return Scalar::None;
    if (type.base == ValueType::Base::Float) return Scalar::Float;
    if (type.base == ValueType::Base::Double) return Scalar::Double;
    if (type.base != ValueType::Base::Integer || type.highest > 4294967295.0) return Scalar::None;
    return type.highest == 255 ? Scalar::Byte : type.lowest < 0 ? Scalar::Int : Scalar::Uint;
}

std::size_t sizeOf(Scalar scalar) {
    return scalar == Scalar::Byte ? 1 : scalar == Scalar::Double ? 8 : 4;
}

double decode(Scalar scalar, const char* bytes) {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < sizeOf(scalar); ++k)
        bits |= std::uint64_t(static_cast<std::uint8_t>(bytes[k])) << 8 * k;
    if (scalar == Scalar::Double) return std::bit_cast<double>(bits);
    const auto word = static_cast<std::uint32_t>(bits);
    if (scalar == Scalar::Float) return std::bit_cast<float>(word);
    if (scalar == Scalar::Int) return static_cast<std::int32_t>(word);
    return word;
}

void encode(std::string& out, Scalar scalar, double number) {
    std::uint64_t bits = 0;
    if (scalar == Scalar::Double)
        bits = std::bit_cast<std::uint64_t>(number);
    else if (scalar == Scalar::Float)
        bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
    else
        bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
    for (std::size_t k = 0; k < sizeOf(scalar); ++k) out += static_cast<char>(bits >> 8 * k & 255);
}

std::string hashOf(const std::string& bytes) {
    Sha256 hash;
    hash.add({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return hash.hex();
}

/// No separators, no schemes, not a folder.
bool isBareName(const std::string& uri) {
    return !uri.empty() && uri != "." && uri != ".." &&
           uri.find_first_of(std::string_view("/\\:\0", 4)) == uri.npos;
}

/// The folder that a file stands in, with links to the file followed.
fs::path folderOf(const std::string& file) {
    std::error_code error;
    const fs::path real = fs::canonical(file, error);
    const fs::path folder = (error ? fs::path(file) : real).parent_path();
    return folder.empty() ? "." : folder;
}

/// Moves arrays of a layer into one block of bytes.
class Packer {
public:
    explicit Packer(std::size_t fewest) : fewest_(fewest) {}
    std::string bytes;

    void pack(std::vector<Prim>& prims) {
        for (Prim& prim : prims) {
            for (auto& [name, property] : prim.properties) {
                const ValueType* const type = valueType(property.typeName);
                const Scalar scalar = type ? scalarOf(*type) : Scalar::None;
                if (scalar == Scalar::None) continue;
                if (property.defaultValue) pack(*property.defaultValue, scalar);
                for (Property::Sample& sample : property.timeSamples) pack(sample.value, scalar);
            }
            pack(prim.children);
        }
    }

private:
    void pack(Value& value, Scalar scalar) {
        const Numbers* numbers = value.as<Numbers>();
        if (!numbers || numbers->count() < fewest_) return;
        Value::Object view{{bufferKey, Value(0.0)},
                           {offsetKey, Value(std::uint64_t(bytes.size()))},
                           {countKey, Value(std::uint64_t(numbers->count()))}};
        for (double number : numbers->values) encode(bytes, scalar, number);
        value = Value(std::move(view));
    }

    std::size_t fewest_;
};

} // namespace

void BufferReader::readAll(const Value& list, const Place& place) {
    buffers_.emplace();
    const auto* array = list.as<Value::Array>();
    if (!array) return problems_.add(place, "expected an array of buffers, found ", describe(list));
    for (std::size_t i = 0; i < array->size(); ++i) {
        const auto* keys = (*array)[i].as<Value::Object>();
        if (!keys) problems_.add(place / i, "expected an object, found ", describe((*array)[i]));
        auto bytes = keys ? read(*keys, place / i) : std::nullopt;
        const std::size_t size = bytes ? bytes->size() : 0;
        buffers_->push_back({std::move(bytes), size});
    }
}

std::optional<std::string> BufferReader::read(const Value::Object& keys, const Place& place) {
    const auto text = [&](const char* key) {
        const auto* string = member<std::string>(keys, key);
        if (!string) problems_.add(place / key, "expected the string ", key);
        return string ? *string : std::string();
    };
    const std::string uri = text(uriKey), hash = text(hashKey);
    const auto length = whole(keys, lengthKey, place);
    if (!length || uri.empty() || hash.empty()) return std::nullopt;
    const fs::path file = folderOf(file_) / uri;
    std::error_code error;
    const fs::file_status status = fs::symlink_status(file, error);
    const Place at = place / uriKey;
    if (file_.empty()) {
        problems_.add(at, "expected a scene that is a file: its buffers stand beside it");
    } else if (!isBareName(uri)) {
        problems_.add(at, "expected the bare name of a file beside the scene, found \"", uri, "\"");
    } else if (!fs::exists(status)) {
        problems_.add(at, "the buffer \"", uri,
                      "\" is missing: expected it beside the scene, where `convert --buffers` put it");
    } else if (!fs::is_regular_file(status)) {
        problems_.add(at, "expected a regular file beside the scene and no link: \"", uri, "\"");
    } else if (const auto size = fs::file_size(file, error); error || size != *length) {
        problems_.add(place / lengthKey, "expected the size of \"", uri, "\", ", size, " bytes, found ",
                      *length);
    } else {
        std::string bytes = readWholeFile(file.string());
        const std::string found = hashOf(bytes);
        if (found == hash) return bytes;
        problems_.add(place / hashKey, "expected the SHA-256 of \"", uri, "\", ", found,
                      ": the file is another one than the scene was saved with");
    }
    return std::nullopt;
}

std::optional<std::uint64_t> BufferReader::whole(const Value::Object& keys, const char* key,
                                                 const Place& place) {
    const auto found = keys.find(key);
    const double* number = member<double>(keys, key);
    if (number && *number >= 0 && *number == std::trunc(*number) && *number <= exactIntegers)
        return static_cast<std::uint64_t>(*number);
    problems_.add(place / key, "expected ", key, ", an integer of at least 0",
                  found == keys.end() ? "" : ", found " + describe(found->second));
    return std::nullopt;
}

void BufferReader::fill(Value& value, const ValueType& type, const Place& place) {
    const auto* keys = value.as<Value::Object>();
    if (!buffers_ || !keys || !keys->contains(bufferKey)) return;
    auto numbers = view(*keys, type, place);
    value = numbers ? std::move(*numbers) : Value(Value::Array());
}

std::optional<Value> BufferReader::view(const Value::Object& keys, const ValueType& type,
                                        const Place& place) {
    const auto wrong = [&](const Place& at, const auto&... parts) {
        problems_.add(at, parts...);
        return std::nullopt;
    };
    const Scalar scalar = scalarOf(type);
    if (scalar == Scalar::None)
        return wrong(place, "expected the value itself: ", type.name, " has no form in a buffer");
    for (const auto& [key, value] : keys)
        if (key != bufferKey && key != offsetKey && key != countKey)
            return wrong(place / key, "expected buffer, byteOffset and count, found \"", key, "\"");
    const auto index = whole(keys, bufferKey, place), offset = whole(keys, offsetKey, place),
               count = whole(keys, countKey, place);
    if (!index || !offset || !count) return std::nullopt;
    if (*index >= buffers_->size())
        return wrong(place / bufferKey, "expected an index below ", buffers_->size(),
                     ", the number of buffers, found ", *index);
    Loaded& buffer = (*buffers_)[*index];
    if (!buffer.bytes) return std::nullopt; // which has been said
    const std::string& bytes = *buffer.bytes;
    const std::size_t step = sizeOf(scalar), each = step * static_cast<std::size_t>(type.width);
    if (*offset > bytes.size() || *count > (bytes.size() - *offset) / each)
        return wrong(place / countKey, "expected elements inside of the buffer's ", bytes.size(),
                     " bytes, found ", *count, " of ", each, " bytes from ", *offset);
    if (*count * each > buffer.left)
        return wrong(place, "expected values that use no byte of a buffer twice");
    buffer.left -= *count * each;
    if (*count == 0) return std::nullopt;
    Numbers numbers{{}, type.width == 1 ? 0 : type.width};
    numbers.values.reserve(*count * static_cast<std::size_t>(type.width));
    for (std::size_t at = *offset, end = *offset + *count * each; at < end; at += step)
        numbers.values.push_back(decode(scalar, &bytes[at]));
    return Value(std::move(numbers));
}

Buffer takeBuffer(Layer& layer, const std::string& stem, std::size_t fewest) {
    Packer packer(fewest);
    packer.pack(layer.children);
    if (packer.bytes.empty()) return {};
    const std::string hash = hashOf(packer.bytes);
    constexpr std::size_t nameDigits = 16;
    Buffer buffer{stem + "." + hash.substr(0, nameDigits) + ".bin", std::move(packer.bytes)};
    layer.other["buffers"] =
        Value(Value::Array{Value(Value::Object{{uriKey, Value(buffer.uri)},
                                               {lengthKey, Value(std::uint64_t(buffer.bytes.size()))},
                                               {hashKey, Value(hash)}})});
    return buffer;
}

} // namespace tss
