#pragma once
#include "bake/compare/Machine.h"
#include "bake/report/Drawing.h"
#include "bake/report/SkinStudy.h"
#include "bake/report/Study.h"

namespace tss::reporting {

/// Everything that a report says.
struct Report {
    std::string scene; ///< file name without folders
    compare::Machine machine;
    ReportOptions options;
    std::vector<PairStudy> pairs;
    std::vector<SkinStudy> skins;
    std::vector<std::vector<Plot>> pairPlots, skinPlots; ///< one list each
    std::vector<std::vector<Picture>> pairPictures;      ///< one list a pair
    std::string plotProblem;
    double seconds = 0;
};

/// Measures all methods on a scene and writes report.md, index.html, report.json, report.csv and plots/ into
/// the folder, which is made where it is not there (METHOD 8). scene: meshes, joints and skins; tables in it
/// are not used, they are made anew. Throws InputError for a scene without pairs and skins and for paths that
/// are not in it.
Report makeReport(const SceneModel& scene, const std::string& sceneFile, const std::string& folder,
                  const ReportOptions& options, const Progress& progress = {});

/// report.md, report.csv, report.json.
std::string markdownOf(const Report& report);
std::string csvOf(const Report& report);
std::string jsonText(const Report& report);

/// The report as a page of its own, index.html: one file that fetches nothing, from the data of report.json
/// and pictures of the pairs.
std::string pageOf(const Report& report);

/// That page, with REPORT_DATA where its data goes.
std::string_view pageTemplate();

} // namespace tss::reporting
