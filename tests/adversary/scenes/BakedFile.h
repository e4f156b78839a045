#pragma once
#include "tests/search/Scenes.h"

#include <functional>
#include <nlohmann/json.hpp>

namespace adversary {

using Json = nlohmann::ordered_json;
using scenes::Random;

/// The prims of a baked pair in its file.
class BakedFile {
public:
    BakedFile(const std::string& text, double length, std::uint64_t seed)
        : doc(Json::parse(text)), length(length), random(seed * 0x9E3779B97F4A7C15u + 5) {
        for (Json& prim : doc["primChildren"]) visit(prim);
    }

    /// The array of a property; empty where it is absent.
    Json* values(Json* prim, const std::string& name) {
        if (!prim) return nullptr;
        Json& properties = (*prim)["properties"];
        return properties.contains(name) && properties[name].contains("default")
                   ? &properties[name]["default"]
                   : nullptr;
    }
    Json* tableValues(const std::string& name) { return values(table, name); }

    void set(Json* prim, const std::string& name, const char* type, const Json& value) {
        (*prim)["properties"][name] = {{"typeName", type}, {"default", value}, {"variability", "uniform"}};
    }
    void claim(const std::string& name, double value) { set(table, name, "double", value); }
    double claimed(const std::string& name, double absent) {
        const Json* value = tableValues(name);
        return value ? value->get<double>() : absent;
    }
    std::size_t tests() {
        const Json* columns = tableValues("tss:columns");
        return columns ? columns->size() : 0;
    }
    std::size_t any(std::size_t count) { return std::size_t(random.below(static_cast<int>(count))); }

    Json doc;
    double length;
    Random random;
    Json *table = nullptr, *proof = nullptr, *pair = nullptr;
    std::vector<Json*> spheres, meshes, joints;

private:
    void visit(Json& prim) {
        const std::string type = prim.value("typeName", "");
        if (type == "TssTable") table = &prim;
        if (type == "TssNeverCollides") proof = &prim;
        if (type == "Points") spheres.push_back(&prim);
        if (type == "Mesh") meshes.push_back(&prim);
        if (type.starts_with("Physics") && type.ends_with("Joint")) joints.push_back(&prim);
        if (prim.contains("properties") && prim["properties"].contains("tss:table")) pair = &prim;
        if (prim.contains("primChildren"))
            for (Json& child : prim["primChildren"]) visit(child);
    }
};

// Changes to it; those that return a bool return false where they do not apply.

bool scaleRadii(BakedFile& file, std::size_t body, double factor);
bool growRadius(BakedFile& file, std::size_t body, double by, double factor = 1);
bool moveCentres(BakedFile& file, std::size_t body, double by, bool all);
bool factorClaim(BakedFile& file, const std::string& name, double factor);
/// Keeps the tests that `keep` wants, and the thresholds with them.
bool keepTests(BakedFile& file, const std::function<bool(std::size_t)>& keep);
bool changeColumns(BakedFile& file, const std::function<int(int, int)>& change);
bool changeGaps(BakedFile& file, const std::function<double(double)>& change, bool all = true);
bool perBody(BakedFile& file, const std::string& name, const char* type, const Json& value);
bool setting(BakedFile& file, const std::string& name, const std::string& text);
bool moveMesh(BakedFile& file, std::size_t body, double factor, double by);
/// A limit of the first joint that has one, in the table too.
bool widen(BakedFile& file, double share);
bool moveJoint(BakedFile& file, double by);
/// Everything that the file calls the surface of a body becomes exempt.
bool exempt(BakedFile& file, std::size_t body, std::size_t triangles);
bool hasRegion(BakedFile& file);
void withoutRegion(BakedFile& file);
bool countsAsStored(BakedFile& file);
/// A proof in the place of the table.
bool becomeProof(BakedFile& file, double clearance);

} // namespace adversary
