#include "bake/tool/Summary.h"

#include "bake/check/EarlyContact.h"
#include "bake/geometry/PartSet.h"
#include "bake/model/SourceHash.h"
#include "bake/table/Table.h"
#include "bake/table/TableKernels.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sys/xattr.h>

namespace tss::tool {

namespace {

Json knownOrNull(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

/// Lengths in scene units; of the contact zone where the spheres stand there alone.
Json fitOf(const FitRecord& fit) {
    return {{"coverage", knownOrNull(fit.coverage)},
            {"coverageMean", knownOrNull(fit.coverageMean)},
            {"coverageP95", knownOrNull(fit.coverageP95)},
            {"protrusion", knownOrNull(fit.protrusion)},
            {"protrusionMean", knownOrNull(fit.protrusionMean)},
            {"protrusionP95", knownOrNull(fit.protrusionP95)},
            {"volumeRatio", knownOrNull(fit.volumeRatio)}};
}

void addRecord(Json& json, const BakeRecord& record) {
    json["spheresA"] = record.spheresA;
    json["spheresB"] = record.spheresB;
    json["candidatePairs"] = record.candidatePairs;
    json["fit"] = {{"A", fitOf(record.fitA)}, {"B", fitOf(record.fitB)}};
}

void addTable(Json& json, const Table& table) {
    addRecord(json, table.record);
    const UsedSpheres used = usedSpheres(table);
    json["usedA"] = used.a;
    json["usedB"] = used.b;
    json["tests"] = table.testCount();
    json["products"] = 4 * table.testCount(); // 3 squares and the squared radius, as the paper counts
    if (table.record.candidatePairs == 0 && table.testCount() > 0) json["candidatePairs"] = nullptr;
    json["lowerBound"] = table.record.lowerBound ? Json(table.record.lowerBound) : Json();
    json["boundMiss"] = knownOrNull(table.boundMiss);
    json["boundEarly"] = knownOrNull(table.boundEarly);
    json["earlyOfSolids"] = knownOrNull(earlyOfSolids(table));
    json["epsilon"] = table.epsilon;
    json["certified"] = table.certified;
    json["overlapAtRest"] = std::ranges::count_if(table.restGaps, [](double g) { return g < 0; });
    json["method"] = table.method;
    json["bytes"] = tableBytes(table);
}

/// Where the meshes overlap at rest, in scene units; shares are of the whole surface.
Json regionOf(const RestRegion& region, const SceneModel& scene, const Pair& pair) {
    if (region.empty()) return nullptr;
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    const double areaA = area(a, region.a), areaB = area(b, region.b);
    return {{"areaA", areaA},
            {"areaB", areaB},
            {"shareA", areaA / area(a)},
            {"shareB", areaB / area(b)},
            {"depth", region.depth < 0 ? Json() : Json(region.depth)}};
}

/// How much of either surface the bounds are about, of 1; null where none is stated.
void addBounded(Json& json) {
    const bool stated =
        json["certified"].get<bool>() && !(json["boundMiss"].is_null() && json["boundEarly"].is_null());
    const Json& region = json["restRegion"];
    const BoundedShares bounded =
        region.is_null() ? BoundedShares()
                         : boundedShares(region["shareA"].get<double>(), region["shareB"].get<double>());
    json["boundedA"] = stated ? Json(bounded.a) : Json();
    json["boundedB"] = stated ? Json(bounded.b) : Json();
}

/// How the run time asks the table, how ill-conditioned that is, and the gaps where rounding may turn the
/// verdict.
void addKernel(Json& json, const PreparedTable& prepared) {
    json["kernel"] = {{"form", name(prepared.form())},
                      {"precision", name(prepared.precision())},
                      {"features", prepared.kernels().featureCount()},
                      {"condition", prepared.kernels().condition()},
                      {"band", prepared.signBand()},
                      {"bytes", prepared.bytes()}};
    if (!prepared.kernels().clusters().empty())
        json["kernel"]["clusters"] = {{"count", prepared.kernels().clusters().count()},
                                      {"groups", prepared.kernels().clusters().levels()[1].size()},
                                      {"tests", prepared.kernels().clusters().testsEach()}};
    if (!prepared.verdicts().empty())
        json["kernel"]["verdicts"] = {{"asked", prepared.verdicts().asked()},
                                      {"bytes", prepared.verdicts().bytes()}};
}

/// What the meshes do where the table says contact already.
void addEarlyContact(Json& json, const SceneModel& scene, const Pair& pair, const PreparedTable& prepared) {
    const std::optional<EarlyContact> early = measureEarlyContact(scene, pair, prepared);
    if (!early) return;
    json["clearanceAtRest"] = early->atRest;
    json["earlyContact"] = {{"poses", early->poses},
                            {"freePoses", early->freePoses},
                            {"stuck", early->stuck()},
                            {"held", early->held},
                            {"close", early->close},
                            {"share", early->share},
                            {"atRest", early->restReported},
                            {"touching", early->touching()},
                            {"coarse", early->coarse()},
                            {"tolerance", early->tolerance > 0 ? Json(early->tolerance) : Json()},
                            {"shareThen", early->tolerance > 0 ? Json(early->shareThen) : Json()}};
}

Json summary(const SceneModel& scene, const Pair& pair, MeshHashes& meshes) {
    Json json = {{"path", pair.path},
                 {"bodyA", scene.bodies[pair.bodyA].path},
                 {"bodyB", scene.bodies[pair.bodyB].path},
                 {"dofs", pairMotion(scene, pair).dofCount()},
                 {"joint", describeDofs(pairMotion(scene, pair), scene.metersPerUnit)},
                 {"baked", pair.table || pair.proof},
                 {"neverCollides", pair.proof != nullptr},
                 {"stale", staleness(scene, pair, &meshes)},
                 {"seconds", nullptr}};
    if (pair.table) {
        addTable(json, *pair.table);
        const PreparedTable prepared(*pair.table);
        addKernel(json, prepared);
        addEarlyContact(json, scene, pair, prepared);
        const auto atRest = pair.settings.find("at-rest");
        json["ignoresRest"] = atRest != pair.settings.end() && atRest->second == "ignore";
        json["restRegion"] = regionOf(pair.table->restRegion, scene, pair);
    }
    if (pair.proof) {
        addRecord(json, pair.proof->record);
        json.update({{"usedA", 0},
                     {"usedB", 0},
                     {"tests", 0},
                     {"boundMiss", 0},
                     {"boundEarly", 0},
                     {"epsilon", 0},
                     {"certified", true},
                     {"bytes", 0},
                     {"clearance", pair.proof->clearance},
                     {"restRegion", regionOf(pair.proof->restRegion, scene, pair)},
                     {"method", pair.proof->method}});
    }
    if (pair.table || pair.proof) addBounded(json);
    return json;
}

Json summary(const SceneModel& scene, const SkinModel& skin) {
    Json json = {{"path", skin.path},      {"baked", skin.table != nullptr},  {"muscles", Json::array()},
                 {"bones", Json::array()}, {"stale", staleness(scene, skin)}, {"seconds", nullptr}};
    for (int muscle : skin.muscles) json["muscles"].push_back(scene.muscles[muscle].path);
    for (int bone : skin.bones) json["bones"].push_back(scene.bodies[bone].path);
    if (skin.table) {
        addTable(json, skin.table->table);
        json["travel"] = skin.table->travel;
    }
    return json;
}

} // namespace

Json summary(const SceneModel& scene) {
    Json json = {{"pairs", Json::array()}, {"skins", Json::array()}};
    MeshHashes meshes;
    for (const Pair& pair : scene.pairs) json["pairs"].push_back(summary(scene, pair, meshes));
    for (const SkinModel& skin : scene.skins) json["skins"].push_back(summary(scene, skin));
    json["metersPerUnit"] = scene.metersPerUnit;
    return json;
}

namespace {

double bounded(double exempt) {
    constexpr double rounding = 1e-12; // of sums of areas
    const double share = 1 - exempt;
    return share > rounding ? share : 0;
}

std::string percent(double share) {
    const double tenths = std::floor(1000 * share); // of a percent
    return share <= 0      ? "nothing"
           : tenths < 1    ? "less than 0.1 %"
           : tenths >= 999 ? "over 99.9 %"
                           : fmt::format("{:.1f} %", tenths / 10);
}

} // namespace

BoundedShares boundedShares(double exemptA, double exemptB) {
    return {bounded(exemptA), bounded(exemptB)};
}

std::string boundedText(const BoundedShares& bounded) {
    return fmt::format("{} of A and {} of B", percent(bounded.a), percent(bounded.b));
}

namespace {
constexpr const char* attribute = "user.tss.seconds";
constexpr std::size_t limit = 60000; // what common file systems take
} // namespace

void writeBakeTimes(const std::string& file, const BakeTimes& times) {
    Json json(times);
    const std::string text = json.dump();
    // Best effort: a file system without extended attributes only leaves the figure unknown.
    if (text.size() <= limit) ::setxattr(file.c_str(), attribute, text.data(), text.size(), 0);
}

BakeTimes readBakeTimes(const std::string& file) {
    std::string text(limit, '\0');
    const ssize_t size = ::getxattr(file.c_str(), attribute, text.data(), text.size());
    if (size <= 0) return {};
    text.resize(static_cast<std::size_t>(size));
    const Json json = Json::parse(text, nullptr, false);
    BakeTimes times;
    if (json.is_object())
        for (const auto& [path, seconds] : json.items())
            if (seconds.is_number()) times[path] = seconds.get<double>();
    return times;
}

void addTimes(Json& summary, const BakeTimes& times) {
    for (const char* kind : {"pairs", "skins"})
        for (Json& item : summary[kind]) {
            const auto found = times.find(item["path"].get<std::string>());
            if (found != times.end()) item["seconds"] = found->second;
        }
}

} // namespace tss::tool
