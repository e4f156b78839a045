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

Json jsonOf(const Report& report) {
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
    return json;
}

std::string cell(const Json& value) {
    if (value.is_null()) return "";
    if (!value.is_string()) return value.dump();
    std::string out = "\"";
    for (const char c : value.get<std::string>()) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

/// headings: of the file; what the rows know none of stays empty.
template <class R>
std::string lines(const std::string& path, const std::vector<std::string>& headings,
                  const Columns<R>& columns, const std::vector<R>& rows) {
    std::string text;
    for (const R& row : rows) {
        text += cell(path);
        for (const std::string& heading : headings) {
            text += ',';
            for (const Column<R>& column : columns)
                if (column.csv == heading) text += cell(column.value(row));
        }
        text += '\n';
    }
    return text;
}

} // namespace

std::string jsonText(const Report& report) {
    return jsonOf(report).dump(1) + "\n";
}

std::string csvOf(const Report& report) {
    std::string text = "pair";
    std::vector<std::string> headings;
    for (const Column<Row>& column : methodColumns(PairStudy{}))
        if (!column.csv.empty()) {
            headings.push_back(column.csv);
            text += "," + column.csv;
        }
    text += "\n";
    for (const PairStudy& study : report.pairs)
        text += lines(study.path, headings, methodColumns(study), study.rows);
    for (const SkinStudy& study : report.skins)
        text += lines(study.path, headings, methodColumns(study), study.methods);
    return text;
}

std::string pageOf(const Report& report) {
    Json json = jsonOf(report);
    for (std::size_t k = 0; k < report.pairs.size(); ++k) {
        const PairStudy& study = report.pairs[k];
        const auto own = [&](const Row& row) {
            return row.method == "tss" && row.setting == study.base.name;
        };
        json["pairs"][k]["tables"] = {
            {"methods", pageTable(methodColumns(study), study.rows, own)},
            {"models", pageTable(modelColumns(study), modelsOf(study), isBase(study))}};
    }
    for (std::size_t k = 0; k < report.skins.size(); ++k) {
        const SkinStudy& study = report.skins[k];
        const auto isUsual = [](const SkinAnswer& a) { return a.usual; };
        json["skins"][k]["tables"] = {
            {"methods", pageTable(methodColumns(study), study.methods)},
            {"answers", pageTable(answerColumns(study), study.motion.answers, isUsual)}};
    }
    for (std::size_t k = 0; k < report.pairPictures.size(); ++k)
        for (const Picture& picture : report.pairPictures[k])
            json["pairs"][k]["pictures"].push_back(
                {{"caption", picture.caption}, {"png", base64(picture.png)}});
    std::string data = json.dump();
    // Nothing in a name ends the script that holds it.
    for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos; at += 6)
        data.replace(at, 1, "\\u003c");
    std::string page(pageTemplate());
    const std::string place = "REPORT_DATA";
    page.replace(page.find(place), place.size(), data);
    return page;
}

} // namespace tss::reporting
