#include "tests/adversary/scenes/FileDamage.h"

#include "tests/search/Scenes.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

namespace adversary {

namespace {

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

/// False where it does not apply.
using Change = std::function<bool(BakedFile&)>;

bool scaleRadii(BakedFile& file, std::size_t body, double factor) {
    for (Json& width : *file.values(file.spheres.at(body), "widths")) width = factor * width.get<double>();
    return true;
}

bool growRadius(BakedFile& file, std::size_t body, double by, double factor = 1) {
    Json& widths = *file.values(file.spheres.at(body), "widths");
    Json& width = widths[file.any(widths.size())];
    width = std::max(1e-12, factor * width.get<double>() + 2 * by);
    return true;
}

bool moveCentres(BakedFile& file, std::size_t body, double by, bool all) {
    Json& points = *file.values(file.spheres.at(body), "points");
    const std::size_t one = file.any(points.size());
    const auto way = file.random.direction();
    for (std::size_t k = 0; k < points.size(); ++k)
        for (int c = 0; c < 3 && (all || k == one); ++c)
            points[k][std::size_t(c)] = points[k][std::size_t(c)].get<double>() + by * way[c];
    return true;
}

bool factorClaim(BakedFile& file, const std::string& name, double factor) {
    const double value = file.claimed(name, 0);
    if (!(value > 0)) return false;
    file.claim(name, factor * value);
    return true;
}

/// Keeps the tests that `keep` wants, and the thresholds with them.
bool keepTests(BakedFile& file, const std::function<bool(std::size_t)>& keep) {
    if (file.tests() < 2) return false;
    const Json columns = *file.tableValues("tss:columns"), offsets = *file.tableValues("tss:rowOffsets");
    const Json* gaps = file.tableValues("tss:restGaps");
    Json left = Json::array(), leftGaps = Json::array(), rows = Json::array({0});
    for (std::size_t row = 0; row + 1 < offsets.size(); ++row) {
        for (std::size_t k = offsets[row]; k < offsets[row + 1].get<std::size_t>(); ++k)
            if (keep(k)) {
                left.push_back(columns[k]);
                if (gaps) leftGaps.push_back((*gaps)[k]);
            }
        rows.push_back(left.size());
    }
    if (left.size() == columns.size()) return false;
    file.set(file.table, "tss:columns", "int[]", left);
    file.set(file.table, "tss:rowOffsets", "int[]", rows);
    if (gaps) file.set(file.table, "tss:restGaps", "double[]", leftGaps);
    return true;
}

bool changeColumns(BakedFile& file, const std::function<int(int, int)>& change) {
    if (file.tests() == 0) return false;
    const int count = static_cast<int>(file.values(file.spheres.at(1), "widths")->size());
    if (count < 2) return false;
    for (Json& column : *file.tableValues("tss:columns")) column = change(column.get<int>(), count);
    return true;
}

bool changeGaps(BakedFile& file, const std::function<double(double)>& change, bool all = true) {
    if (file.tests() == 0) return false;
    Json gaps = file.tableValues("tss:restGaps") ? *file.tableValues("tss:restGaps")
                                                 : Json(std::vector<double>(file.tests(), 0.0));
    const std::size_t one = file.any(gaps.size());
    for (std::size_t k = 0; k < gaps.size(); ++k)
        if (all || k == one) gaps[k] = change(gaps[k].get<double>());
    file.set(file.table, "tss:restGaps", "double[]", gaps);
    return true;
}

bool perBody(BakedFile& file, const std::string& name, const char* type, const Json& value) {
    file.set(file.table, name, type, Json::array({value, value}));
    return true;
}

bool setting(BakedFile& file, const std::string& name, const std::string& text) {
    file.set(file.pair, "tss:bake:" + name, "string", text);
    return true;
}

bool moveMesh(BakedFile& file, std::size_t body, double factor, double by) {
    const auto way = file.random.direction();
    for (Json& point : *file.values(file.meshes.at(body), "points"))
        for (int c = 0; c < 3; ++c)
            point[std::size_t(c)] = factor * point[std::size_t(c)].get<double>() + by * way[c];
    return true;
}

/// A limit of the first joint that has one, in the table too.
bool widen(BakedFile& file, double share) {
    for (Json* joint : file.joints) {
        Json *lower = file.values(joint, "physics:lowerLimit"),
             *upper = file.values(joint, "physics:upperLimit");
        if (!lower || !upper) continue;
        const double range = upper->get<double>() - lower->get<double>();
        const double reached = upper->get<double>() + share * range;
        if (!(range > 0)) continue;
        *upper = reached;
        // The table says the limits as they are read, in double.
        (*file.tableValues("tss:upper"))[0] = double(float(reached));
        return true;
    }
    return false;
}

bool moveJoint(BakedFile& file, double by) {
    Json* joint = file.joints.at(file.any(file.joints.size()));
    Json* place = file.values(joint, "physics:localPos0");
    if (!place) {
        file.set(joint, "physics:localPos0", "point3f", Json::array({by, by, 0}));
        return true;
    }
    (*place)[file.any(3)] = place->at(0).get<double>() + by;
    return true;
}

/// Everything that the file calls the surface of a body becomes exempt.
bool exempt(BakedFile& file, std::size_t body, std::size_t triangles) {
    const Json& counts = *file.values(file.meshes.at(body), "faceVertexCounts");
    Json parts = Json::array(), cuts = Json::array();
    for (std::size_t t = 0; t < std::min(triangles, counts.size()); ++t) {
        parts.push_back(t);
        cuts.push_back(1);
    }
    const std::string number = body == 0 ? "0" : "1";
    file.set(file.table, "tss:restTriangles" + number, "int[]", parts);
    file.set(file.table, "tss:restCuts" + number, "int[]", cuts);
    return true;
}

bool hasRegion(BakedFile& file) {
    return file.tableValues("tss:restTriangles0") && file.tableValues("tss:restTriangles1");
}

void withoutRegion(BakedFile& file) {
    for (const char* name : {"tss:restTriangles0", "tss:restCuts0", "tss:restTriangles1", "tss:restCuts1"})
        (*file.table)["properties"].erase(name);
}

bool countsAsStored(BakedFile& file) {
    Json counts = Json::array();
    for (Json* set : {file.spheres.at(0), file.spheres.at(1)})
        counts.push_back(file.values(set, "widths")->size());
    file.set(file.table, "tss:generatedSpheres", "uint64[]", counts);
    return true;
}

/// A proof in the place of the table.
bool becomeProof(BakedFile& file, double clearance) {
    Json& table = *file.table;
    table["typeName"] = "TssNeverCollides";
    Json properties = Json::object();
    for (const char* kept : {"tss:sourceHash", "tss:method"})
        if (table["properties"].contains(kept)) properties[kept] = table["properties"][kept];
    table["properties"] = properties;
    table.erase("primChildren");
    file.set(file.table, "tss:clearance", "double", clearance);
    file.set(file.table, "tss:cells", "uint64", 10);
    return true;
}

struct Kind {
    std::string name;
    bool hashed;
    Change change;
};

std::vector<Kind> sphereKinds() {
    return {
        {"radii of A cut by a tenth", false, [](BakedFile& f) { return scaleRadii(f, 0, 0.9); }},
        {"radii of B cut by a tenth", false, [](BakedFile& f) { return scaleRadii(f, 1, 0.9); }},
        {"radii of both cut by a thousandth", false,
         [](BakedFile& f) { return scaleRadii(f, 0, 0.999) && scaleRadii(f, 1, 0.999); }},
        {"radii cut and counted as all there are", false,
         [](BakedFile& f) { return scaleRadii(f, 0, 0.9) && scaleRadii(f, 1, 0.9) && countsAsStored(f); }},
        {"a radius of A halved", false, [](BakedFile& f) { return growRadius(f, 0, 0, 0.5); }},
        {"a radius of B all but gone", false, [](BakedFile& f) { return growRadius(f, 1, 0, 1e-6); }},
        {"a radius of A grown by the tolerance", false,
         [](BakedFile& f) { return growRadius(f, 0, f.length); }},
        {"a radius of B grown much", false, [](BakedFile& f) { return growRadius(f, 1, 8 * f.length); }},
        {"all radii grown by a tenth", false,
         [](BakedFile& f) { return scaleRadii(f, 0, 1.1) && scaleRadii(f, 1, 1.1); }},
        {"a centre of A moved", false, [](BakedFile& f) { return moveCentres(f, 0, f.length, false); }},
        {"a centre of B moved a little", false,
         [](BakedFile& f) { return moveCentres(f, 1, 0.01 * f.length, false); }},
        {"all centres of A moved", false, [](BakedFile& f) { return moveCentres(f, 0, f.length, true); }},
        {"all centres of B moved far", false,
         [](BakedFile& f) { return moveCentres(f, 1, 20 * f.length, true); }},
        {"the centres of A in another order", false,
         [](BakedFile& f) {
             Json& points = *f.values(f.spheres.at(0), "points");
             std::rotate(points.begin(), points.begin() + 1, points.end());
             return points.size() > 1;
         }},
        {"the radii of B in another order", false,
         [](BakedFile& f) {
             Json& widths = *f.values(f.spheres.at(1), "widths");
             std::rotate(widths.begin(), widths.begin() + 1, widths.end());
             return widths.size() > 1;
         }},
    };
}

std::vector<Kind> testKinds() {
    return {
        {"a test left out", false,
         [](BakedFile& f) {
             const std::size_t out = f.tests() ? f.any(f.tests()) : 0;
             return keepTests(f, [out](std::size_t k) { return k != out; });
         }},
        {"the first test left out", false,
         [](BakedFile& f) { return keepTests(f, [](std::size_t k) { return k != 0; }); }},
        {"every other test left out", false,
         [](BakedFile& f) { return keepTests(f, [](std::size_t k) { return k % 2 == 0; }); }},
        {"one test left", false,
         [](BakedFile& f) { return keepTests(f, [](std::size_t k) { return k == 0; }); }},
        {"no test left", false, [](BakedFile& f) { return keepTests(f, [](std::size_t) { return false; }); }},
        {"columns one further", false,
         [](BakedFile& f) { return changeColumns(f, [](int c, int n) { return (c + 1) % n; }); }},
        {"columns all the first", false,
         [](BakedFile& f) { return changeColumns(f, [](int, int) { return 0; }); }},
        {"columns reversed", false,
         [](BakedFile& f) { return changeColumns(f, [](int c, int n) { return n - 1 - c; }); }},
        {"thresholds lower by the tolerance", false,
         [](BakedFile& f) { return changeGaps(f, [&](double g) { return g - f.length; }); }},
        {"a threshold lower by far", false,
         [](BakedFile& f) {
             return changeGaps(
                 f, [&](double g) { return g - 20 * f.length; }, false);
         }},
        {"a threshold lower by a thousandth", false,
         [](BakedFile& f) {
             return changeGaps(
                 f, [&](double g) { return g - 1e-3 * f.length; }, false);
         }},
        {"thresholds higher by the tolerance", false,
         [](BakedFile& f) { return changeGaps(f, [&](double g) { return g + f.length; }); }},
        {"thresholds doubled", false,
         [](BakedFile& f) {
             return f.tableValues("tss:restGaps") && changeGaps(f, [](double g) { return 2 * g; });
         }},
        {"thresholds gone", false,
         [](BakedFile& f) { return (*f.table)["properties"].erase("tss:restGaps") > 0; }},
    };
}

std::vector<Kind> claimKinds() {
    const auto claims = [](const char* name, double value) {
        return [=](BakedFile& f) {
            if (f.claimed(name, 0) == value) return false;
            f.claim(name, value);
            return true;
        };
    };
    const auto factor = [](const char* name, double by) {
        return [=](BakedFile& f) { return factorClaim(f, name, by); };
    };
    return {
        {"no misses claimed", false, claims("tss:boundMiss", 0)},
        {"no misses claimed and coverage said to be whole", false,
         [](BakedFile& f) {
             if (!(f.claimed("tss:boundMiss", -1) != 0)) return false;
             f.claim("tss:boundMiss", 0);
             return perBody(f, "tss:coverage", "double[]", 0);
         }},
        {"half as late claimed", false, factor("tss:boundMiss", 0.5)},
        {"nothing claimed of misses", false, claims("tss:boundMiss", -1)},
        {"nothing early claimed", false, claims("tss:boundEarly", 0)},
        {"half as early claimed", false, factor("tss:boundEarly", 0.5)},
        {"half as early claimed, spheres said to stick out less", false,
         [](BakedFile& f) {
             return factorClaim(f, "tss:boundEarly", 0.5) && perBody(f, "tss:protrusion", "double[]", 1e-9);
         }},
        {"early by far claimed", false, factor("tss:boundEarly", 100)},
        {"a smaller epsilon claimed", false, factor("tss:epsilon", 0.01)},
        {"a larger epsilon claimed", false, claims("tss:epsilon", 1)},
        {"a larger depth claimed", false,
         [](BakedFile& f) {
             f.claim("tss:gapDepth", 40 * f.length);
             return true;
         }},
        {"a margin claimed", false,
         [](BakedFile& f) {
             f.claim("tss:gapMargin", 10 * f.length);
             return true;
         }},
        {"no depth claimed", false,
         [](BakedFile& f) { return (*f.table)["properties"].erase("tss:gapDepth") > 0; }},
        {"made from other numbers of spheres", false,
         [](BakedFile& f) { return perBody(f, "tss:generatedSpheres", "uint64[]", 3); }},
        {"a proof in the table's place", false, [](BakedFile& f) { return becomeProof(f, 1e-6); }},
        {"a proof with a clearance in the table's place", false,
         [](BakedFile& f) { return becomeProof(f, f.length); }},
    };
}

std::vector<Kind> sourceKinds() {
    return {
        {"a limit wider by a tenth", true, [](BakedFile& f) { return widen(f, 0.1); }},
        {"a limit twice as wide", true, [](BakedFile& f) { return widen(f, 1); }},
        {"a joint moved", true, [](BakedFile& f) { return moveJoint(f, 4 * f.length); }},
        {"the moving mesh moved", true, [](BakedFile& f) { return moveMesh(f, 1, 1, 4 * f.length); }},
        {"the still mesh moved a little", true,
         [](BakedFile& f) { return moveMesh(f, 0, 1, 0.1 * f.length); }},
        {"the still mesh larger", true, [](BakedFile& f) { return moveMesh(f, 0, 1.1, 0); }},
        {"the moving mesh smaller", true, [](BakedFile& f) { return moveMesh(f, 1, 0.9, 0); }},
        {"a vertex pulled out", true,
         [](BakedFile& f) {
             Json& points = *f.values(f.meshes.at(1), "points");
             Json& point = points[f.any(points.size())];
             point[f.any(3)] = point[0].get<double>() + 10 * f.length;
             return true;
         }},
        {"overlap at rest said to be ignored", true,
         [](BakedFile& f) { return setting(f, "at_rest", "ignore"); }},
        {"a coarser tolerance said", true,
         [](BakedFile& f) { return setting(f, "tolerance", std::to_string(4 * f.length)); }},
        {"inscribed spheres said", true, [](BakedFile& f) { return setting(f, "conservative", "false"); }},
        {"a planar limit gone, or put", true,
         [](BakedFile& f) { return (*f.joints.at(0))["properties"].erase("tss:limitPlanes") > 0; }},
        {"another rest", true,
         [](BakedFile& f) {
             f.set(f.joints.at(0), "tss:rest", "double[]", Json::array({0.01}));
             return f.joints.size() == 1 && f.values(f.joints[0], "physics:lowerLimit");
         }},
        {"all of both surfaces exempt", false,
         [](BakedFile& f) { return exempt(f, 0, 1u << 30) && exempt(f, 1, 1u << 30); }},
        {"all of A exempt from some of B", false,
         [](BakedFile& f) { return exempt(f, 0, 1u << 30) && exempt(f, 1, 4); }},
        {"a triangle of each exempt", false,
         [](BakedFile& f) { return !hasRegion(f) && exempt(f, 0, 1) && exempt(f, 1, 1); }},
        {"nothing exempt", false,
         [](BakedFile& f) {
             const bool had = hasRegion(f);
             withoutRegion(f);
             return had;
         }},
        {"the exempt parts half as deep", false,
         [](BakedFile& f) { return factorClaim(f, "tss:restDepth", 0.5); }},
        {"the exempt parts deeper", false, [](BakedFile& f) { return factorClaim(f, "tss:restDepth", 3); }},
        {"damaged radii in a file that says it is fresh", true,
         [](BakedFile& f) { return scaleRadii(f, 0, 0.95) && countsAsStored(f); }},
    };
}

const std::vector<Kind>& kindsOfDamage() {
    static const std::vector<Kind> all = [] {
        std::vector<Kind> list;
        for (const auto make : {sphereKinds, testKinds, claimKinds, sourceKinds})
            for (Kind& kind : make()) list.push_back(std::move(kind));
        return list;
    }();
    return all;
}

} // namespace

const std::vector<Damage>& damages() {
    static const std::vector<Damage> all = [] {
        std::vector<Damage> list;
        for (const Kind& kind : kindsOfDamage()) list.push_back({kind.name, kind.hashed});
        return list;
    }();
    return all;
}

std::string damaged(const std::string& text, std::size_t damage, double length, std::uint64_t seed) {
    BakedFile file(text, length, seed);
    if (!file.table || file.spheres.size() < 2 || file.meshes.size() < 2 || !file.pair) return {};
    return kindsOfDamage().at(damage).change(file) ? file.doc.dump() : std::string();
}

} // namespace adversary
