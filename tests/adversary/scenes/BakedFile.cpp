#include "tests/adversary/scenes/BakedFile.h"

#include <algorithm>
#include <set>

namespace adversary {

bool scaleRadii(BakedFile& file, std::size_t body, double factor) {
    for (Json& width : *file.values(file.spheres.at(body), "widths")) width = factor * width.get<double>();
    return true;
}

bool growRadius(BakedFile& file, std::size_t body, double by, double factor) {
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

bool changeGaps(BakedFile& file, const std::function<double(double)>& change, bool all) {
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

} // namespace adversary
