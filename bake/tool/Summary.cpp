#include "bake/tool/Summary.h"

#include "bake/check/EarlyContact.h"
#include "bake/geometry/PartSet.h"
#include "bake/model/SourceHash.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/table/EarlyBound.h"
#include "bake/table/TableKernels.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// How the run time asks the table, how ill-conditioned that is, and the gaps where rounding may turn the
/// verdict.
void addKernel(Json& json, const Table& table) {
    const PreparedTable prepared(table);
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
void addEarlyContact(Json& json, const SceneModel& scene, const Pair& pair) {
    const std::optional<EarlyContact> early = measureEarlyContact(scene, pair);
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

std::string describeEarlyContact(const Json& pair, double metersPerUnit) {
    const double atRest = pair["clearanceAtRest"].get<double>();
    const Json& early = pair["earlyContact"];
    std::string text = fmt::format(
        "  meshes       {} at rest; contact reported at {:.0f} % of {} poses where {}\n",
        atRest > 0 ? lengthText(atRest, metersPerUnit) + " apart" : "touch or overlap",
        100 * early["share"].get<double>(), early["freePoses"].dump(),
        pair.value("restRegion", Json()).is_null() ? "they do not touch" : "nothing else touches");
    // Not advised where the pair is baked that way already.
    const bool ignored = pair.value("ignoresRest", false);
    const char* excepted = ignored ? ""
                                   : "; where the bodies overlap on purpose, as in\n               a socket, "
                                     "bake with --at-rest ignore";
    if (early["stuck"].get<bool>() && !ignored)
        text += fmt::format("  stuck        the meshes touch or overlap at {} of {} poses. Where B does not "
                            "lie right, move it (tss\n               make --b-offset){}\n",
                            early["poses"].get<int>() - early["freePoses"].get<int>(),
                            early["poses"].get<int>(), excepted);
    else if (early["held"].get<bool>())
        text += fmt::format(
            "  held         at rest: every small step from there is contact, whichever way. {}Let "
            "it rest where nothing\n               touches (tss make --rest, --b-offset){}\n",
            pair["dofs"].get<int>() > 1
                ? "Where one value drives the\n               others, as of gears, let "
                  "a path say so (tss make --dof path). "
                : "",
            excepted);
    if (const int poses = early["poses"].get<int>(), free = early["freePoses"].get<int>();
        early["touching"].get<bool>())
        text += fmt::format("  touching     the meshes touch at {} of {} poses: where they should not, look "
                            "at origin, axis and limits\n",
                            poses - free, poses);
    if (!early["coarse"].get<bool>()) return text;
    text += fmt::format("  too coarse   for the clearance of this joint: it {} where nothing touches\n",
                        early["atRest"].get<bool>() ? "sticks at rest," : "is stopped early, or sticks,");
    if (!early["tolerance"].is_null())
        text +=
            fmt::format("  propose      --tolerance {}: contact at no more than {:.0f} % of those poses\n",
                        lengthOption(early["tolerance"].get<double>(), metersPerUnit),
                        100 * early["shareThen"].get<double>());
    return text;
}

std::string length(const Json& value, double metersPerUnit) {
    return value.is_null() ? "not known" : lengthText(value.get<double>(), metersPerUnit);
}

std::string squareText(double area, double metersPerUnit) {
    const double squareMetres = area * metersPerUnit * metersPerUnit;
    return squareMetres < 0.001 ? fmt::format("{:.3g} mm2", 1e6 * squareMetres)
           : squareMetres < 1   ? fmt::format("{:.3g} cm2", 1e4 * squareMetres)
                                : fmt::format("{:.3g} m2", squareMetres);
}

/// The exempt region, about which the bounds say nothing, as the end of their line.
std::string exemptText(const Json& item, double metersPerUnit) {
    const Json region = item.value("restRegion", Json());
    if (region.is_null()) return "";
    const auto part = [&](const char* area, const char* share) {
        return fmt::format("{} ({:.3g} %)", squareText(region[area].get<double>(), metersPerUnit),
                           100 * region[share].get<double>());
    };
    const bool ignored = region["depth"].is_null();
    return fmt::format(", but for {} of A and {} of B that overlap at rest{}", part("areaA", "shareA"),
                       part("areaB", "shareB"),
                       ignored ? " and are left out"
                               : ": contact where they go deeper, spheres by " +
                                     lengthText(region["depth"].get<double>(), metersPerUnit));
}

/// A warning where more than half of a body's surface is exempt.
std::string exemptWarning(const Json& item) {
    const Json region = item.value("restRegion", Json());
    if (region.is_null()) return "";
    std::string text;
    for (const auto& [body, share] : {std::pair{"A", "shareA"}, std::pair{"B", "shareB"}})
        if (const double percent = 100 * region[share].get<double>(); percent > 50)
            text += fmt::format(
                "  excepted     {:.3g} % of the surface of {} overlap at rest: of that part no contact is "
                "told{}\n",
                percent, body, region["depth"].is_null() ? "" : " but where it goes deeper than at rest");
    return text;
}

/// How the table is asked, and what a query finds by the values of the joint alone.
std::string kernelText(const Json& kernel, double metersPerUnit) {
    std::string text = fmt::format("  query        {} in {}, condition {:.3g}, verdicts right beyond {}\n",
                                   kernel["form"].get<std::string>(), kernel["precision"].get<std::string>(),
                                   kernel["condition"].get<double>(), length(kernel["band"], metersPerUnit));
    if (kernel.contains("clusters"))
        text += fmt::format("  clusters     {}, each of {} tests, in {} groups\n",
                            kernel["clusters"]["count"].dump(), kernel["clusters"]["tests"].dump(),
                            kernel["clusters"]["groups"].dump());
    if (kernel.contains("verdicts"))
        text +=
            fmt::format("  verdicts     tests are asked in {:.3g} % of the limits; {} bytes\n",
                        100 * kernel["verdicts"]["asked"].get<double>(), kernel["verdicts"]["bytes"].dump());
    return text;
}

} // namespace

Json summary(const SceneModel& scene, const Pair& pair) {
    Json json = {{"path", pair.path},
                 {"bodyA", scene.bodies[pair.bodyA].path},
                 {"bodyB", scene.bodies[pair.bodyB].path},
                 {"dofs", pairMotion(scene, pair).dofCount()},
                 {"joint", describeDofs(pairMotion(scene, pair), scene.metersPerUnit)},
                 {"baked", pair.table || pair.proof},
                 {"neverCollides", pair.proof != nullptr},
                 {"stale", staleness(scene, pair)},
                 {"seconds", nullptr}};
    if (pair.table) {
        addTable(json, *pair.table);
        addKernel(json, *pair.table);
        addEarlyContact(json, scene, pair);
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

Json summary(const SceneModel& scene) {
    Json json = {{"pairs", Json::array()}, {"skins", Json::array()}};
    for (const Pair& pair : scene.pairs) json["pairs"].push_back(summary(scene, pair));
    for (const SkinModel& skin : scene.skins) json["skins"].push_back(summary(scene, skin));
    json["metersPerUnit"] = scene.metersPerUnit;
    return json;
}

namespace {

std::string describeEarly(const Json& item, double metersPerUnit) {
    const Json &surfaces = item["boundEarly"], &solids = item["earlyOfSolids"];
    if (solids.is_null()) return length(surfaces, metersPerUnit);
    const std::string text = length(solids, metersPerUnit);
    if (surfaces.is_null()) return text + " unless one body stands inside the other";
    // Where it is known that no part stands inside, the two bounds are nearly the same.
    return surfaces.get<double>() <= 2 * solids.get<double>()
               ? length(surfaces, metersPerUnit)
               : fmt::format("{}, {} where one body stands inside the other", text,
                             length(surfaces, metersPerUnit));
}

/// A body of a pair has a surface, and no sphere was made of it.
bool hasNoSpheres(const Json& item) {
    return (item["spheresA"] == 0 || item["spheresB"] == 0) && item["boundMiss"].is_null() &&
           !item.contains("travel");
}

/// The lines of a pair or skin that has a table.
std::string describeTable(const Json& item, double metersPerUnit) {
    std::string text;
    text += fmt::format("  used         {} + {}\n  tests a step {} ({} products)\n", item["usedA"].dump(),
                        item["usedB"].dump(), item["tests"].dump(), item["products"].dump());
    const Json& met = item["candidatePairs"];
    text += fmt::format(
        "  can meet     {}{}\n",
        met.is_null() ? "more pairs than are counted" : counted(met.get<std::size_t>(), "pair"),
        item["lowerBound"].is_null()
            ? ""
            : "; no table has fewer than " + counted(item["lowerBound"].get<std::size_t>(), "test"));
    if (hasNoSpheres(item))
        text +=
            "  no spheres   were made of a body: the table reports no contact, and nothing is known of it\n";
    else if (item["tests"] == 0 && !item["certified"].get<bool>() && !item.contains("travel"))
        text += "  no contact   at any sampled pose: no proof that the bodies never meet\n";
    const double travel = item.value("travel", 0.0);
    if (travel > 0)
        text += fmt::format(
            "  good         while skin strays no farther than {} from where muscles and bones carry it\n",
            lengthText(travel, metersPerUnit));
    if (item.contains("travel") && !item["certified"].get<bool>())
        text += "  explored     each muscle and joint value by itself, then joints together, from limit to limit: "
                "nothing is proven\n";
    if (item.contains("residual"))
        text += fmt::format("  residual     {} at most: so deep it goes into what is below it, beyond its "
                            "depth at rest, in {} steps\n"
                            "               of the scene's own motion\n",
                            length(item["residual"], metersPerUnit), item["residualSteps"].dump());
    if (!item.contains("travel")) // a skin's table has no bound of depth
        text += fmt::format("  bounds       miss {}, early {}, epsilon {}, {}{}\n",
                            length(item["boundMiss"], metersPerUnit), describeEarly(item, metersPerUnit),
                            length(item["epsilon"], metersPerUnit),
                            hasNoSpheres(item)              ? "of no spheres"
                            : item["certified"].get<bool>() ? "certified for every pose"
                                                            : "sampled poses only",
                            exemptText(item, metersPerUnit));
    if (item.contains("earlyContact")) text += describeEarlyContact(item, metersPerUnit);
    return text;
}

std::string describeItem(const Json& item, double metersPerUnit) {
    std::string text;
    text += item["path"].get<std::string>() + "\n";
    if (item.contains("joint")) text += "  joint        " + item["joint"].get<std::string>() + "\n";
    for (const char* under : {"muscles", "bones"})
        if (!item.value(under, Json::array()).empty())
            text += fmt::format("  {:<12} {}\n", under,
                                fmt::join(item[under].get<std::vector<std::string>>(), ", "));
    if (!item["baked"].get<bool>()) {
        text += "  not baked yet\n";
        return text;
    }
    if (const auto stale = item["stale"].get<std::string>(); !stale.empty())
        text += "  stale        " + stale + ": bake it again\n";
    if (item["spheresA"] != 0 || item["spheresB"] != 0)
        text += fmt::format("  spheres      {} + {}\n", item["spheresA"].dump(), item["spheresB"].dump());
    if (item.value("neverCollides", false)) {
        text += fmt::format("  never collide: the surfaces stay more than {} apart over the whole motion{}; "
                            "no table, no callback\n",
                            length(item["clearance"], metersPerUnit), exemptText(item, metersPerUnit));
    } else {
        text += describeTable(item, metersPerUnit);
    }
    text += exemptWarning(item);
    if (item.contains("kernel")) text += kernelText(item["kernel"], metersPerUnit);
    text +=
        fmt::format("  made by      {}, {} bytes", item["method"].get<std::string>(), item["bytes"].dump());
    if (!item["seconds"].is_null()) text += fmt::format(", {:.2f} s", item["seconds"].get<double>());
    text += "\n";
    return text;
}

} // namespace

std::string describe(const Json& scene) {
    std::string text;
    for (const char* kind : {"pairs", "skins"})
        for (const Json& item : scene[kind]) text += describeItem(item, scene["metersPerUnit"].get<double>());
    return text.empty() ? "no pairs and no skins in this scene\n" : text;
}

} // namespace tss::tool
