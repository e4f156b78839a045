#include "bake/geometry/MeshFileParts.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace tss {

namespace {

enum class PlyFormat { Text, Little, Big };

struct PlyType {
    std::size_t size = 0; ///< 0: of no PLY
    bool real = false, isSigned = true;
};

struct PlyProperty {
    PlyType type, count; ///< count.size 0: a single value
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t begin = 0, end = 0; ///< its lines in the header
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Text;
    std::vector<PlyElement> elements;
    std::size_t end = 0; ///< where what follows it begins
};

[[noreturn]] void refuse(const std::string& what) {
    throw InputError("cannot be read as a mesh: " + what);
}

PlyType plyType(const std::string& name) {
    if (name == "char" || name == "int8") return {1, false, true};
    if (name == "uchar" || name == "uint8") return {1, false, false};
    if (name == "short" || name == "int16") return {2, false, true};
    if (name == "ushort" || name == "uint16") return {2, false, false};
    if (name == "int" || name == "int32") return {4, false, true};
    if (name == "uint" || name == "uint32") return {4, false, false};
    if (name == "float" || name == "float32") return {4, true, true};
    if (name == "double" || name == "float64") return {8, true, true};
    refuse("its header has a property of type " + name + ", which is none of PLY");
}

PlyHeader readHeader(const std::string& bytes) {
    PlyHeader header;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t end = std::min(bytes.find('\n', at), bytes.size() - 1) + 1;
        std::istringstream line(bytes.substr(at, end - at));
        std::string word, type, of;
        line >> word >> type;
        if (word == "end_header") {
            header.end = end;
            return header;
        }
        if (word == "format")
            header.format = type == "ascii"                  ? PlyFormat::Text
                            : type == "binary_little_endian" ? PlyFormat::Little
                                                             : PlyFormat::Big;
        if (word == "element") {
            PlyElement& element = header.elements.emplace_back();
            element.name = type;
            line >> element.count;
            element.begin = at;
        }
        if (word == "property" && !header.elements.empty()) {
            PlyProperty property;
            if (type == "list" && line >> type >> of) {
                property.count = plyType(type);
                type = of;
            }
            property.type = plyType(type);
            header.elements.back().properties.push_back(property);
        }
        if (!header.elements.empty()) header.elements.back().end = end;
        at = end;
    }
    refuse("its header has no line end_header");
}

/// Goes through the values behind a header.
class PlyValues {
public:
    PlyValues(const std::string& bytes, const PlyHeader& header)
        : bytes_(bytes), format_(header.format), at_(header.end) {}

    std::size_t at() const { return at_; }

    void skip(const PlyType& type) {
        if (format_ == PlyFormat::Text)
            nextWord();
        else
            take(type.size);
    }

    std::int64_t whole(const PlyType& type) {
        if (type.real) refuse("an index or a count of it is of a type with a point");
        if (format_ == PlyFormat::Text) {
            const std::string word = nextWord();
            char* end = nullptr;
            const long long value = std::strtoll(word.c_str(), &end, 10);
            if (*end != '\0') refuse("expected a whole number, found \"" + word + "\"");
            return value;
        }
        const char* from = take(type.size);
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < type.size; ++k) {
            const std::size_t byte = format_ == PlyFormat::Little ? type.size - 1 - k : k;
            value = value << 8 | static_cast<unsigned char>(from[byte]);
        }
        const std::uint64_t sign = std::uint64_t(1) << (8 * type.size - 1);
        return type.isSigned ? static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign)
                             : static_cast<std::int64_t>(value);
    }

    /// How many values a property has here: one, or as its list says.
    std::uint64_t countOf(const PlyProperty& property) {
        if (property.count.size == 0) return 1;
        const std::int64_t count = whole(property.count);
        if (count < 0) refuse("a list of it has fewer than no values");
        return static_cast<std::uint64_t>(count);
    }

    void skip(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
            for (const PlyProperty& property : element.properties)
                for (std::uint64_t left = countOf(property); left > 0; --left) skip(property.type);
    }

private:
    const char* take(std::size_t size) {
        if (bytes_.size() - at_ < size) refuse("it ends before its triangle strips do");
        at_ += size;
        return bytes_.data() + at_ - size;
    }

    std::string nextWord() {
        constexpr const char* blanks = " \t\r\n";
        const std::size_t begin = bytes_.find_first_not_of(blanks, at_);
        if (begin == bytes_.npos) refuse("it ends before its triangle strips do");
        at_ = std::min(bytes_.find_first_of(blanks, begin), bytes_.size());
        return bytes_.substr(begin, at_ - begin);
    }

    const std::string& bytes_;
    PlyFormat format_;
    std::size_t at_;
};

using StripCorners = std::array<std::int64_t, 3>;

/// The triangles of a strip with all of their corners apart, turned alike; -1 begins another.
void addStrip(const std::vector<std::int64_t>& strip, std::vector<StripCorners>& triangles) {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < strip.size(); ++k) {
        if (strip[k] == -1) begin = k + 1;
        if (k < begin + 2 || strip[k] == -1) continue;
        StripCorners corners{strip[k - 2], strip[k - 1], strip[k]};
        if ((k - begin) % 2 != 0) std::swap(corners[0], corners[1]);
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
            triangles.push_back(corners);
    }
}

std::vector<StripCorners> readStrips(PlyValues& values, const PlyElement& strips) {
    std::vector<StripCorners> triangles;
    std::vector<std::int64_t> strip;
    for (std::uint64_t i = 0; i < strips.count && !strips.properties.empty(); ++i)
        for (const PlyProperty& property : strips.properties) {
            strip.clear();
            for (std::uint64_t left = values.countOf(property); left > 0; --left)
                if (property.count.size > 0)
                    strip.push_back(values.whole(property.type));
                else
                    values.skip(property.type);
            addStrip(strip, triangles);
        }
    return triangles;
}

void writeFace(const StripCorners& corners, PlyFormat format, std::string& bytes) {
    bytes += format == PlyFormat::Text ? "3" : "\3";
    for (const std::int64_t corner : corners) {
        if (corner < 0 || corner > std::numeric_limits<std::int32_t>::max())
            refuse("a triangle strip of it names vertex " + std::to_string(corner));
        if (format == PlyFormat::Text)
            bytes += " " + std::to_string(corner);
        else
            for (int k = 0; k < 4; ++k)
                bytes += static_cast<char>(corner >> 8 * (format == PlyFormat::Little ? k : 3 - k) & 0xff);
    }
    if (format == PlyFormat::Text) bytes += "\n";
}

} // namespace

std::string plainPly(const std::string& file) {
    const std::string bytes = readWholeFile(file);
    const PlyHeader header = readHeader(bytes);
    PlyValues values(bytes, header);
    std::string plain = bytes.substr(0, header.elements.front().begin);
    const PlyElement* strips = nullptr;
    for (const PlyElement& element : header.elements) {
        if (element.name == "face" && element.count > 0)
            refuse("it has both faces and triangle strips; expected one of them");
        if (element.name == "tristrips") strips = &element;
        if (strips || element.name == "face") continue;
        plain += bytes.substr(element.begin, element.end - element.begin);
        values.skip(element);
    }
    if (!strips) return bytes;
    const std::size_t begin = values.at();
    const std::vector<StripCorners> triangles = readStrips(values, *strips);
    plain += "element face " + std::to_string(triangles.size()) +
             "\nproperty list uchar int vertex_indices\nend_header\n" +
             bytes.substr(header.end, begin - header.end);
    if (header.format == PlyFormat::Text && !plain.ends_with('\n')) plain += "\n";
    for (const StripCorners& corners : triangles) writeFace(corners, header.format, plain);
    return plain;
}

} // namespace tss
