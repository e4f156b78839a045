#include "bake/pipeline/BakeOptions.h"

#include "bake/base/Error.h"
#include "bake/base/Words.h"

#include <osgTSS/Bake>
#include <osgTSS/LoadOptions>

#include <algorithm>
#include <sstream>

namespace osgTSS {

namespace {

const char* const ownWords[] = {"pairs", "switches", "limits", "static", "ignore", "still", "cache"};
const char* const loadWords[] = {"clock", "light", "noRotation", "overlay"};

std::string oneOf(const std::string& key, const std::string& value, const std::vector<std::string>& choices) {
    if (std::ranges::find(choices, value) != choices.end()) return value;
    std::string text;
    for (const std::string& choice : choices) text += (text.empty() ? "" : ", ") + choice;
    throw tss::InputError("option " + key + ": expected one of " + text + "; found \"" + value + "\"");
}

std::vector<std::string> parts(const std::string& value) {
    std::istringstream text(value);
    std::vector<std::string> found;
    for (std::string part; std::getline(text, part, ',');)
        if (!part.empty()) found.push_back(part);
    return found;
}

/// "Gun:rotX:-5:20": the word is what stands behind the third colon from the end.
std::pair<std::string, std::string> limitOf(const std::string& part) {
    std::size_t at = part.size();
    for (int colons = 0; colons < 3 && at != std::string::npos && at > 0; ++colons)
        at = part.rfind(':', at - 1);
    if (at == std::string::npos || at == 0)
        throw tss::InputError("option limits: expected NAME:rotZ:-24:18 or NAME:transX:0:5, found \"" + part +
                              "\"");
    return {part.substr(0, at), part.substr(at + 1)};
}

/// A wrong value is no pair's fault: it is told before any is baked.
void addSetting(std::map<std::string, std::string>& settings, const std::string& key,
                const std::string& value) {
    tss::BakeOptions trial;
    tss::setOption(trial, key, value, 1);
    settings[key] = value;
}

} // namespace

BakeOptions::BakeOptions(const std::string& words) : BakeOptions(LoadOptions(words).others) {}

BakeOptions::BakeOptions(const std::map<std::string, std::string>& words) {
    for (const auto& [key, value] : words) {
        if (key == "pairs")
            pairs = oneOf(key, value, {"neighbours", "siblings", "all", "tagged"});
        else if (key == "switches")
            activeOnly = oneOf(key, value, {"all", "active"}) == "active";
        else if (key == "limits")
            for (const std::string& part : parts(value)) {
                if (part == "written")
                    writtenLimits = true;
                else
                    limits.push_back(limitOf(part));
            }
        else if (key == "static")
            still = parts(value);
        else if (key == "ignore")
            ignored = parts(value);
        else if (key == "still")
            boneStill = tss::parseNumber(value, "option still");
        else if (key == "cache")
            cache = value;
        else if (tss::isOption(key))
            addSetting(settings, key, value);
        else
            unknown.push_back(key);
    }
}

std::string nearestOption(const std::string& word) {
    std::vector<std::string> names;
    for (const tss::BakeOption& option : tss::bakeOptions()) names.emplace_back(option.name);
    names.insert(names.end(), std::begin(ownWords), std::end(ownWords));
    names.insert(names.end(), std::begin(loadWords), std::end(loadWords));
    std::string best;
    std::size_t least = 1 + word.size() / 3;
    for (const std::string& name : names)
        if (const std::size_t d = tss::editDistance(word, name); d <= least && d < name.size()) {
            if (d == least && !best.empty()) continue;
            least = d;
            best = name;
        }
    return best;
}

} // namespace osgTSS
