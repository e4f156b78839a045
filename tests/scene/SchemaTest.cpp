#include "bake/scene/Schema.h"

#include "bake/base/AtomicFile.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

using namespace tss;
using Json = nlohmann::ordered_json;

namespace {

const std::string root = OSGTSS_SOURCE_DIR;
const std::string schemaFile = root + "/scenes/osgtss.schema.json", formatFile = root + "/docs/FORMAT.md";

/// What the JSON Schema says of an attribute's default.
Json valueSchema(const Attribute& attribute) {
    Json value;
    if (attribute.typeName == "bool") value["type"] = {"boolean", "null"};
    if (!attribute.choices.empty()) {
        std::istringstream words{std::string(attribute.choices)};
        for (std::string word; words >> word;) value["enum"].push_back(word);
        value["enum"].push_back(nullptr);
    }
    Json number;
    if (std::isfinite(attribute.range.lowest)) number["minimum"] = attribute.range.lowest;
    if (std::isfinite(attribute.range.highest)) number["maximum"] = attribute.range.highest;
    if (number.is_null()) return value;
    const bool array = attribute.typeName.ends_with("[]");
    if (!array) number["type"] = {"number", "null"};
    return array ? Json{{"items", number}} : number;
}

Json propertySchema(const Attribute& attribute) {
    Json schema;
    if (!attribute.meaning.empty()) schema["description"] = attribute.meaning;
    if (attribute.typeName == "rel") {
        schema["$ref"] = "#/$defs/relationship";
        return schema;
    }
    schema["$ref"] = "#/$defs/attribute";
    schema["properties"]["typeName"]["const"] = attribute.typeName;
    if (const Json value = valueSchema(attribute); !value.is_null()) schema["properties"]["default"] = value;
    if (attribute.name.starts_with("primvars:skel:")) {
        schema["properties"]["elementSize"] = {{"type", "integer"}, {"minimum", 1}};
        schema["properties"]["interpolation"]["enum"] = {"vertex", "constant"};
    }
    return schema;
}

/// Of every type; a name that two types have has one meaning for both, that of the first.
Json propertySchemas() {
    Json all = Json::object();
    for (const SchemaType& type : schemaTypes())
        for (const Attribute& attribute : type.attributes)
            if (attribute.name != "tss:drive:path0" && !all.contains(attribute.name))
                all[std::string(attribute.name)] = propertySchema(attribute); // the other is by pattern
    return all;
}

/// The choices or the range behind an attribute's meaning.
std::string limits(const Attribute& attribute) {
    std::ostringstream text;
    std::istringstream words{std::string(attribute.choices)};
    for (std::string word; words >> word;) text << (text.str().empty() ? "; `" : ", `") << word << "`";
    const Range& range = attribute.range;
    if (std::isfinite(range.highest))
        text << "; from " << range.lowest << " to " << range.highest;
    else if (std::isfinite(range.lowest))
        text << "; " << range.lowest << " or more";
    return text.str();
}

/// FORMAT.md with its tables of attributes as the schema has them.
std::string formatWithTables(const std::string& text) {
    std::istringstream lines(text);
    std::string out;
    const std::string head = "| attribute of `";
    for (std::string line; std::getline(lines, line);) {
        out += line + "\n";
        if (!line.starts_with(head)) continue;
        const std::string type = line.substr(head.size(), line.find('`', head.size()) - head.size());
        out += "|---|---|---|\n";
        for (const SchemaType& schema : schemaTypes())
            for (const Attribute& attribute : schema.attributes)
                if (schema.name == type && !attribute.meaning.empty())
                    out += "| `" + std::string(attribute.name) + "` | " +
                           (attribute.typeName == "rel" ? "relationship" : std::string(attribute.typeName)) +
                           " | " + std::string(attribute.meaning) + limits(attribute) + " |\n";
        while (std::getline(lines, line) && line.starts_with("|")) {
        }
        out += line + "\n";
    }
    return out;
}

} // namespace

TEST_CASE("the JSON Schema and the tables of FORMAT.md are written from the tables of fields", "[.write]") {
    const std::string schema = readWholeFile(schemaFile);
    const std::string head =
        "\"propertyNames\": {\"pattern\": \"^[A-Za-z_][A-Za-z0-9_]*(:[A-Za-z0-9_]+)*$\"},\n"
        "   \"properties\": {\n";
    const auto begin = schema.find(head) + head.size(), end = schema.find("\n   },\n", begin);
    REQUIRE(end < schema.size());
    std::string lines;
    const Json properties = propertySchemas();
    for (const auto& [name, property] : properties.items())
        lines += (lines.empty() ? "    " : ",\n    ") + Json(name).dump() + ": " + property.dump();
    writeFileAtomically(schemaFile, schema.substr(0, begin) + lines + schema.substr(end));
    writeFileAtomically(formatFile, formatWithTables(readWholeFile(formatFile)));
}

TEST_CASE("the JSON Schema has exactly the properties that are read and written, with types and ranges") {
    const Json known = Json::parse(readWholeFile(schemaFile))["$defs"]["properties"]["properties"];
    const Json wanted = propertySchemas();
    CHECK(wanted.size() > 60);
    CHECK(known.size() == wanted.size());
    for (const auto& [name, schema] : wanted.items()) {
        INFO(name);
        REQUIRE(known.contains(name));
        CHECK(known[name] == schema);
    }
}

TEST_CASE("the tables of FORMAT.md have the attributes that are read and written, with their meaning") {
    const std::string text = readWholeFile(formatFile);
    CHECK((text == formatWithTables(text)));
    for (const SchemaType& type : schemaTypes()) {
        INFO(type.name);
        if (type.name.starts_with("Tss"))
            CHECK(text.find("| attribute of `" + std::string(type.name) + "` |") != text.npos);
    }
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
    CHECK(accepts(R"({"tss:epsilon": {"typeName": "double", "default": null}})"));
    CHECK_FALSE(accepts(R"({"p": {"typeName": "float[]", "default": {"buffer": 0}}})"));
    CHECK_FALSE(accepts(R"({"p": {"default": 3}})"));
    CHECK_FALSE(accepts(R"({"points": {"typeName": "point3d[]"}})"));
    CHECK_FALSE(accepts(R"({"physics:axis": {"typeName": "token", "default": "W"}})"));
    CHECK_FALSE(accepts(R"({"tss:epsilon": {"typeName": "double", "default": -1}})"));
    CHECK_FALSE(accepts(R"({"primvars:tss:tether": {"typeName": "float[]", "default": [0.5, 2]}})"));
}
