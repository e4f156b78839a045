#include "bake/report/Columns.h"
#include "bake/report/Report.h"

namespace tss::reporting {

namespace {

std::string base64(const std::string& bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        unsigned int three = 0;
        for (std::size_t i = 0; i < 3; ++i)
            three = three << 8 | (k + i < bytes.size() ? static_cast<unsigned char>(bytes[k + i]) : 0u);
        for (std::size_t i = 0; i < 4; ++i)
            out += k + i > bytes.size() ? '=' : digits[three >> (18 - 6 * i) & 63];
    }
    return out;
}

} // namespace

std::string pageOf(const Report& report) {
    Json json = Json::parse(jsonOf(report));
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
