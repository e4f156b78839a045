#include "Tell.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace osgTSS {

using Json = nlohmann::ordered_json;

void tellPictures(const Speech& speech, unsigned int frames, const std::vector<std::string>& files) {
    if (!speech.quiet)
        fmt::print(speech.json ? stderr : stdout, "{} picture{}, {} to {}\n", files.size(),
                   files.size() == 1 ? "" : "s", files.front(), files.back());
    if (speech.json) fmt::print("{}\n", Json{{"frames", frames}, {"files", files}}.dump());
}

int tellFailure(const Speech& speech, int code, const std::string& message) {
    fmt::print(stderr, "tss-render: {}\n", message);
    if (speech.json) fmt::print("{}\n", Json{{"error", {{"message", message}}}, {"exit", code}}.dump());
    return code;
}

} // namespace osgTSS
