#include "bake/tool/BakeTimes.h"

#include <sys/xattr.h>

namespace tss::tool {

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
