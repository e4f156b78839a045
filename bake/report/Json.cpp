#include "bake/report/Report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tss::reporting {

namespace {

using Json = nlohmann::ordered_json;

Json orNull(double value) {
    return value < 0 ? Json(nullptr) : Json(value);
}

Json jsonOf(const ErrorFigures& figures, double mm) {
    return {{"poses", figures.poses},
            {"touching", figures.touching},
            {"missed", figures.missed},
            {"early", figures.early},
            {"deepestMissMm", figures.deepestMiss * mm},
            {"meanMissMm", figures.meanMiss * mm},
            {"farthestEarlyMm", figures.farthestEarly * mm},
            {"meanEarlyMm", figures.meanEarly * mm},
            {"someMeasured", figures.sampled}};
}

Json jsonOf(const Row& row, double mm) {
    return {{"method", row.method},
            {"setting", row.setting},
            {"family", row.about.family},
            {"about", row.about.about},
            {"statedMissMm", orNull(row.about.stated.miss * mm)},
            {"statedEarlyMm", orNull(row.about.stated.early * mm)},
            {"uniform", jsonOf(row.uniform, mm)},
            {"nearContact", jsonOf(row.near, mm)},
            {"firstContact",
             {{"motions", row.firstContact.motions},
              {"never", row.firstContact.never},
              {"worstMm", row.firstContact.worstLength * mm},
              {"earliestMm", row.firstContact.earliest * mm},
              {"latestMm", row.firstContact.latest * mm},
              {"worstOfLeadingDof", row.firstContact.worstAngle},
              {"meanOfLeadingDof", row.firstContact.meanAngle}}},
            {"tests", orNull(row.tests)},
            {"products", orNull(row.products)},
            {"bytes", row.about.bytes},
            {"times",
             {{"medianNs", row.times.median},
              {"p10Ns", row.times.low},
              {"p90Ns", row.times.high},
              {"rounds", row.times.rounds},
              {"queriesARound", row.times.queries},
              {"buildSeconds", row.about.buildSeconds}}}};
}

Json jsonOf(const BakePoint& point, double mm) {
    return {{"name", point.name},
            {"about", point.about},
            {"toleranceMm", point.tolerance * mm},
            {"epsilonMm", point.epsilon * mm},
            {"protrusionMm", point.protrusion * mm},
            {"spheresA", point.spheresA},
            {"spheresB", point.spheresB},
            {"usedA", point.usedA},
            {"usedB", point.usedB},
            {"tests", point.tests},
            {"restTests", point.restTests},
            {"lowerBound", point.lowerBound},
            {"bytes", point.bytes},
            {"times", {{"sphereSeconds", point.sphereSeconds}, {"tableSeconds", point.tableSeconds}}}};
}

Json jsonOf(const std::vector<BakePoint>& points, double mm) {
    Json list = Json::array();
    for (const BakePoint& point : points) list.push_back(jsonOf(point, mm));
    return list;
}

Json jsonOf(const RegionCurve& region) {
    return {
        {"lower", region.lower}, {"upper", region.upper}, {"middle", region.middle}, {"share", region.share}};
}

Json notRunOf(const std::vector<NotRun>& notRun) {
    Json list = Json::array();
    for (const NotRun& entry : notRun) list.push_back({{"method", entry.method}, {"reason", entry.reason}});
    return list;
}

Json jsonOf(const PairStudy& study) {
    const double mm = study.millimetres;
    Json json{{"path", study.path},
              {"a", study.nameA},
              {"b", study.nameB},
              {"trianglesA", study.trianglesA},
              {"trianglesB", study.trianglesB},
              {"dofs", study.dofs},
              {"neverCollides", study.neverCollides},
              {"clearanceMm", study.clearance * mm},
              {"times", {{"seconds", study.seconds}, {"fclDirectlyNs", study.fclDirectly.median}}}};
    if (study.neverCollides) return json;
    json["uniformPoses"] = study.uniformPoses;
    json["touchingUniform"] = study.touchingUniform;
    json["nearPoses"] = study.nearPoses;
    json["leftOut"] = study.leftOut;
    json["earlyBoundMm"] = orNull(study.earlyBound * mm);
    json["freeWithinEarlyBound"] = study.freeWithinBound;
    json["timedPoses"] = study.timedPoses;
    for (const Row& row : study.rows) json["rows"].push_back(jsonOf(row, mm));
    json["notRun"] = notRunOf(study.notRun);
    Json steps{
        {"motion", study.steps.motion}, {"leadingDof", study.leadingDof}, {"leading", study.steps.leading}};
    for (const StepSeries& series : study.steps.series)
        steps["series"].push_back({{"name", series.name}, {"tests", series.tests}});
    json["steps"] = steps;
    json["angularRegion"] = {
        {"unit", study.leadingUnit},
        {"spheres", jsonOf(study.region.spheres)},
        {"meshes", jsonOf(study.region.meshes)},
        {"stepsInSpheres", std::count(study.steps.inRegion.begin(), study.steps.inRegion.end(), char{1})},
        {"stepsInMeshes", study.steps.inMeshRegion}};
    for (const SamplingPoint& point : study.sampling)
        json["sampling"].push_back({{"samples", point.samples},
                                    {"reduce", point.reduce},
                                    {"tests", point.tests},
                                    {"missedUniform", point.missedUniform},
                                    {"missedNearContact", point.missedNear},
                                    {"times", {{"seconds", point.seconds}}}});
    json["base"] = study.base.name;
    json["tolerances"] = jsonOf(study.tolerances, mm);
    json["epsilons"] = jsonOf(study.epsilons, mm);
    json["recipes"] = jsonOf(study.recipes, mm);
    return json;
}

Json jsonOf(const SkinStudy& study) {
    const double mm = study.millimetres;
    Json json{{"path", study.path},
              {"muscles", study.muscles},
              {"skinSpheres", study.skinSpheres},
              {"muscleSpheres", study.muscleSpheres},
              {"usedSkin", study.usedSkin},
              {"usedMuscle", study.usedMuscle},
              {"tests", study.tests},
              {"carried",
               {{"usedSkin", study.carriedSkin},
                {"usedMuscle", study.carriedMuscle},
                {"tests", study.carriedTests}}},
              {"activations", study.activations},
              {"thicknessMm", study.thickness * mm},
              {"judged", study.judged},
              {"touching", study.touching},
              {"productsAnEllipsoidTest", study.productsEllipsoid},
              {"times", {{"seconds", study.seconds}}}};
    for (const SkinMethod& method : study.methods)
        json["methods"].push_back({{"method", method.name},
                                   {"about", method.about},
                                   {"tests", method.tests},
                                   {"products", method.products},
                                   {"missed", method.missed},
                                   {"early", method.early},
                                   {"deepestMissMm", method.deepestMiss * mm},
                                   {"farthestEarlyMm", method.farthestEarly * mm},
                                   {"testsAtEachActivation", method.perStep},
                                   {"times", {{"medianNs", method.nanoseconds}}}});
    const SkinMotionStudy& motion = study.motion;
    Json answers = Json::array();
    for (const SkinAnswer& a : motion.answers)
        answers.push_back({{"sweeps", a.sweeps},
                           {"usual", a.usual},
                           {"deepestMm", a.deepest * mm},
                           {"meanDepthMm", a.meanDepth * mm},
                           {"farthestFromConvergedMm", a.farthest * mm},
                           {"rmsFromConvergedMm", a.rms * mm},
                           {"areaChange", a.areaChange},
                           {"times", {{"medianNs", a.nanoseconds}}}});
    json["motion"] = {{"about", motion.motion},
                      {"steps", motion.steps},
                      {"verticesThatMove", motion.touched},
                      {"deepestIfAtRestMm", motion.untouched * mm},
                      {"deepestConvergedMm", motion.converged * mm},
                      {"farthestMoveMm", motion.farthestMove * mm},
                      {"muscleVolumeChange", motion.muscleVolume},
                      {"answers", answers}};
    json["notRun"] = notRunOf(study.notRun);
    return json;
}

} // namespace

std::string jsonOf(const Report& report) {
    Json json{{"scene", report.scene},
              {"machine",
               {{"processor", report.machine.processor},
                {"cores", report.machine.cores},
                {"compiler", report.machine.compiler},
                {"build", report.machine.build},
                {"vectors", report.machine.vectors},
                {"libraries", report.machine.libraries}}},
              {"quick", report.options.quick},
              {"seed", report.options.seed},
              {"times", {{"seconds", report.seconds}}},
              {"pairs", Json::array()},
              {"skins", Json::array()}};
    for (std::size_t k = 0; k < report.pairs.size(); ++k) {
        Json pair = jsonOf(report.pairs[k]);
        for (const Plot& plot : report.pairPlots[k]) pair["plots"].push_back(plot.file);
        json["pairs"].push_back(std::move(pair));
    }
    for (std::size_t k = 0; k < report.skins.size(); ++k) {
        Json skin = jsonOf(report.skins[k]);
        for (const Plot& plot : report.skinPlots[k]) skin["plots"].push_back(plot.file);
        json["skins"].push_back(std::move(skin));
    }
    return json.dump(1) + "\n";
}

} // namespace tss::reporting
