#include "bake/base/AtomicFile.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" // gcc 12 of its own <regex>, with sanitizers
#endif
#include <regex>
#include <set>

using namespace tss;
using Json = nlohmann::json;

namespace {

const std::string root = OSGTSS_SOURCE_DIR;

Json properties() {
    return Json::parse(readWholeFile(root + "/scenes/osgtss.schema.json"))["$defs"]["properties"];
}

std::vector<std::smatch> matches(const std::string& text, const char* pattern) {
    const std::regex regex(pattern);
    return {std::sregex_iterator(text.begin(), text.end(), regex), {}};
}

} // namespace

TEST_CASE("the JSON Schema has exactly the properties that the reader knows, with their types") {
    const std::string header = readWholeFile(root + "/bake/scene/Schema.h");
    Json known = properties()["properties"];
    std::set<std::string> seen;
    for (const std::smatch& found : matches(header, R"re(Attribute \w+\{"([^"]+)", "([^"]+)")re")) {
        if (found.str(1).starts_with("xformOp:")) continue; // of any precision
        INFO(found.str(1));
        seen.insert(found.str(1));
        REQUIRE(known.contains(found.str(1)));
        CHECK(known[found.str(1)]["properties"]["typeName"]["const"] == found.str(2));
    }
    for (const std::smatch& found :
         matches(header, R"re(inline constexpr const char\* (\w+) = "([^"]+)";)re")) {
        if (found.str(1) == "bakePrefix" || found.str(1) == "originalName") continue;
        INFO(found.str(2));
        seen.insert(found.str(2));
        REQUIRE(known.contains(found.str(2)));
        CHECK(known[found.str(2)]["$ref"] == "#/$defs/relationship");
    }
    CHECK(seen.size() > 60);
    CHECK(known.size() == seen.size()); // and no others
}

TEST_CASE("every scene of the repository and every form of the format is good by the JSON Schema") {
    const std::string python =
        "python3 '" + root + "/tests/scene/check_schema.py' '" + root + "/scenes/osgtss.schema.json' ";
    if (std::system("python3 -c 'import jsonschema; jsonschema.Draft202012Validator' 2>/dev/null") != 0) {
        WARN("skipped, no python3-jsonschema");
        return;
    }
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(root + "/scenes")) {
        if (entry.path().extension() != ".tss") continue;
        if (readWholeFile(entry.path().string())[0] != '{') continue; // binary
        INFO(entry.path());
        CHECK(std::system((python + "'" + entry.path().string() + "'").c_str()) == 0);
        ++scenes;
    }
    CHECK(scenes > 0);
    // It is a schema and no rubber stamp.
    const std::string file = std::string(OSGTSS_BINARY_DIR) + "/schema.tss";
    const std::string head =
        R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [{"name": "A", "properties": )";
    const auto accepts = [&](const std::string& prims) {
        writeFileAtomically(file, head + prims + "}]}");
        const bool good = std::system((python + "'" + file + "' 2>/dev/null >/dev/null").c_str()) == 0;
        std::filesystem::remove(file);
        return good;
    };
    CHECK(
        accepts(R"({"p": {"typeName": "float[]", "default": {"buffer": 0, "byteOffset": 0, "count": 3}}})"));
    CHECK_FALSE(accepts(R"({"p": {"typeName": "float[]", "default": {"buffer": 0}}})"));
    CHECK_FALSE(accepts(R"({"p": {"default": 3}})"));
    CHECK_FALSE(accepts(R"({"points": {"typeName": "point3d[]"}})"));
    CHECK_FALSE(accepts(R"({"physics:axis": {"typeName": "token", "default": "W"}})"));
}
