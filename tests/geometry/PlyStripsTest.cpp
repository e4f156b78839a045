#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/geometry/MeshAudit.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

using namespace tss;

#ifdef OSGTSS_IMPORT

namespace {

/// A box of edges 1, 2, 3: its sides, and its ends, of which one has a corner twice.
const std::vector<int> boxStrips{0, 4, 1, 5, 3, 7, 2, 6, 0, 4, -1, 0, 1, 2, 3, 3, -1, 4, 6, 5, 7};

std::vector<float> stripBoxPoints() {
    std::vector<float> points;
    for (int k = 0; k < 8; ++k)
        for (const int axis : {0, 1, 2}) points.push_back((k >> axis & 1) ? static_cast<float>(axis + 1) : 0);
    return points;
}

std::string stripHeader(const std::string& format, std::size_t count, const std::string& more = "") {
    return "ply\nformat " + format +
           " 1.0\ncomment a scan\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n" +
           more + "element tristrips " + std::to_string(count) +
           "\nproperty list int int vertex_indices\nend_header\n";
}

std::string stripText(const std::vector<int>& strip, const std::string& more = "",
                      const std::string& values = "") {
    std::string text = stripHeader("ascii", 1, more);
    const std::vector<float> points = stripBoxPoints();
    for (std::size_t k = 0; k < points.size(); ++k)
        text += std::to_string(points[k]) + (k % 3 == 2 ? "\n" : " ");
    text += values + std::to_string(strip.size());
    for (const int index : strip) text += " " + std::to_string(index);
    return text + "\n";
}

template <class T>
void addBytes(std::string& bytes, T value, bool big) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T)); // of a little-endian machine
    if (big) std::ranges::reverse(raw);
    bytes.append(raw.data(), raw.size());
}

std::string stripBytes(bool big) {
    std::string bytes = stripHeader(big ? "binary_big_endian" : "binary_little_endian", 2);
    for (const float x : stripBoxPoints()) addBytes(bytes, x, big);
    const auto half = boxStrips.begin() + 11; // the ends in a list of their own
    for (const std::vector<int>& strip :
         {std::vector<int>(boxStrips.begin(), half), std::vector<int>(half, boxStrips.end())}) {
        addBytes(bytes, static_cast<int>(strip.size()), big);
        for (const int index : strip) addBytes(bytes, index, big);
    }
    return bytes;
}

TriangleMesh stripMesh(const std::string& bytes) {
    const std::string file = std::string(OSGTSS_BINARY_DIR) + "/import_strips.ply";
    std::ofstream(file, std::ios::binary) << bytes;
    return importMesh(file);
}

std::string whyNoStrips(const std::string& bytes) {
    try {
        stripMesh(bytes);
    } catch (const InputError& error) {
        return error.message;
    }
    return "";
}

} // namespace

TEST_CASE("the triangle strips of a PLY are all of their triangles, turned alike") {
    for (const std::string& bytes : {stripText(boxStrips), stripBytes(false), stripBytes(true),
                                     stripText(boxStrips,
                                               "element face 0\nproperty list uchar int vertex_indices\n"
                                               "element edge 2\nproperty list uchar int ends\n",
                                               "2 0 1\n2 1 2\n")}) {
        INFO(bytes.substr(0, 40));
        const MeshAudit audit = auditMesh(stripMesh(bytes));
        CHECK(audit.vertices == 8);
        CHECK(audit.triangles == 12);
        CHECK(audit.watertight);
        CHECK(std::abs(audit.signedVolume) == Approx(6));
    }
}

TEST_CASE("triangle strips that cannot be read are refused, and so are faces beside them") {
    CHECK(whyNoStrips(stripText({0, 1, -2})) ==
          "cannot be read as a mesh: a triangle strip of it names vertex -2");
    CHECK(whyNoStrips(stripText({0, 1, 9})) != "");
    CHECK(whyNoStrips(
              stripText(boxStrips, "element face 1\nproperty list uchar int vertex_indices\n", "3 0 1 2\n"))
              .find("both faces and triangle strips") != std::string::npos);
    const std::string bytes = stripBytes(false);
    for (const std::size_t less : {1, 5, 50})
        CHECK(whyNoStrips(bytes.substr(0, bytes.size() - less)).find("ends before its triangle strips do") !=
              std::string::npos);
    std::string many = stripBytes(false);
    many.replace(many.find("strips 2"), 8, "strips 99999999999");
    CHECK(whyNoStrips(many).find("ends before") != std::string::npos);
}

#endif
