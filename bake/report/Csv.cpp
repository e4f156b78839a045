#include "bake/report/Report.h"

#include <fmt/format.h>

namespace tss::reporting {

namespace {

std::string cell(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

std::string orEmpty(double value) {
    return value < 0 ? "" : fmt::format("{}", value);
}

} // namespace

std::string csvOf(const Report& report) {
    std::string text =
        "pair,method,setting,family,poses,touching,missed,early,nearPoses,nearTouching,nearMissed,nearEarly,"
        "deepestMissMm,farthestEarlyMm,statedMissMm,statedEarlyMm,firstContactWorstMm,nsMedian,nsLow,nsHigh,"
        "tests,products,bytes,buildSeconds\n";
    for (const PairStudy& study : report.pairs)
        for (const Row& row : study.rows) {
            const double mm = study.millimetres;
            text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                                cell(study.path), cell(row.method), cell(row.setting), cell(row.about.family),
                                row.uniform.poses, row.uniform.touching, row.uniform.missed,
                                row.uniform.early, row.near.poses, row.near.touching, row.near.missed,
                                row.near.early, mm * std::max(row.uniform.deepestMiss, row.near.deepestMiss),
                                mm * std::max(row.uniform.farthestEarly, row.near.farthestEarly),
                                orEmpty(row.about.stated.miss * mm), orEmpty(row.about.stated.early * mm),
                                mm * row.firstContact.worstLength, row.times.median, row.times.low,
                                row.times.high, orEmpty(row.tests), orEmpty(row.products), row.about.bytes,
                                row.about.buildSeconds);
        }
    for (const SkinStudy& study : report.skins)
        for (const SkinMethod& method : study.methods)
            text +=
                fmt::format("{},{},,skin,{},{},{},{},,,,,{},{},,,,{},,,{},{},,\n", cell(study.path),
                            cell(method.name), study.judged, study.touching, method.missed, method.early,
                            study.millimetres * method.deepestMiss, study.millimetres * method.farthestEarly,
                            method.nanoseconds, method.tests, method.products);
    return text;
}

} // namespace tss::reporting
