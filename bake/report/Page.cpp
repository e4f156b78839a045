#include "bake/report/Page.h"

#include "bake/report/Report.h"

#include <nlohmann/json.hpp>

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
    auto json = nlohmann::ordered_json::parse(jsonOf(report));
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
