#include "bake/report/Columns.h"
#include "bake/report/Report.h"

#include <algorithm>

namespace tss::reporting {

namespace {

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
              {"times", {{"seconds", study.seconds}, {"fclDirectlyNs", study.fclDirectly.median}}}};
    if (study.never) {
        json["never"] = *study.never;
        return json;
    }
    json["notes"] = study.notes;
    json["uniformPoses"] = study.uniformPoses;
    json["touchingUniform"] = study.touchingUniform;
    json["nearPoses"] = study.nearPoses;
    json["leftOut"] = study.leftOut;
    json["earlyBoundMm"] = study.earlyBound ? Json(*study.earlyBound * mm) : Json(nullptr);
    json["freeWithinEarlyBound"] = study.freeWithinBound;
    json["timedPoses"] = study.timedPoses;
    json["rows"] = jsonOf(methodColumns(study), study.rows);
    json["notRun"] = notRunOf(study.notRun);
    Json steps{
        {"motion", study.steps.motion}, {"leadingDof", study.leadingDof}, {"leading", study.steps.leading}};
    for (const StepSeries& series : study.steps.series)
        steps["series"].push_back({{"name", series.name}, {"tests", series.tests}});
    json["steps"] = steps;
    json["angularRegion"] = {{"unit", study.leadingUnit},
                             {"spheres", jsonOf(study.region.spheres)},
                             {"meshes", jsonOf(study.region.meshes)},
                             {"stepsInSpheres", std::ranges::count(study.steps.inRegion, char{1})},
                             {"stepsInMeshes", study.steps.inMeshRegion}};
    json["sampling"] = jsonOf(samplingColumns(), study.sampling);
    json["base"] = study.base.name;
    const Columns<BakePoint> models = modelColumns(study);
    json["tolerances"] = jsonOf(models, study.tolerances);
    json["epsilons"] = jsonOf(models, study.epsilons);
    json["recipes"] = jsonOf(models, study.recipes);
    return json;
}

Json jsonOf(const SkinStudy& study) {
    const double mm = study.millimetres;
    Json json{{"path", study.path},
              {"muscles", study.muscles},
              {"bones", study.bones},
              {"below", study.partCount()},
              {"part", study.partName()},
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
    json["methods"] = jsonOf(methodColumns(study), study.methods);
    const SkinMotionStudy& motion = study.motion;
    json["motion"] = {{"about", motion.motion},
                      {"steps", motion.steps},
                      {"verticesThatMove", motion.touched},
                      {"deepestIfAtRestMm", motion.untouched * mm},
                      {"deepestConvergedMm", motion.converged * mm},
                      {"farthestMoveMm", motion.farthestMove * mm},
                      {"muscleVolumeChange", motion.muscleVolume},
                      {"answers", jsonOf(answerColumns(study), motion.answers)}};
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
    const auto add = [&](const char* kind, const auto& studies, const auto& plots) {
        for (std::size_t k = 0; k < studies.size(); ++k) {
            Json& study = json[kind].emplace_back(jsonOf(studies[k]));
            for (const Plot& plot : plots[k]) study["plots"].push_back(plot.file);
        }
    };
    add("pairs", report.pairs, report.pairPlots);
    add("skins", report.skins, report.skinPlots);
    return json.dump(1) + "\n";
}

} // namespace tss::reporting
