#include "bake/pipeline/BakeOptions.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace tss {

namespace {

template <class Value>
using Word = std::pair<const char*, Value>;

// The words of the command line, the scene file and a table's method.
constexpr std::array<Word<SphereMethod>, 4> sphereWords{{{"medial", SphereMethod::Medial},
                                                         {"shrinking", SphereMethod::Shrinking},
                                                         {"growth", SphereMethod::Growth},
                                                         {"surface", SphereMethod::Surface}}};
constexpr std::array<Word<SearchMethod>, 2> searchWords{
    {{"certified", SearchMethod::Certified}, {"sampled", SearchMethod::Sampled}}};
constexpr std::array<Word<ReduceMethod>, 4> reduceWords{{{"cover", ReduceMethod::Cover},
                                                         {"cooccurrence", ReduceMethod::Cooccurrence},
                                                         {"minimal", ReduceMethod::Minimal},
                                                         {"none", ReduceMethod::None}}};
constexpr std::array<Word<AtRest>, 3> atRestWords{
    {{"offset", AtRest::Offset}, {"ignore", AtRest::Ignore}, {"collide", AtRest::Collide}}};
constexpr std::array<Word<Inside>, 2> insideWords{{{"free", Inside::Free}, {"contact", Inside::Contact}}};
constexpr std::array<Word<bool>, 2> flagWords{{{"true", true}, {"false", false}}};

template <class Value, std::size_t count>
std::string wordOf(const std::array<Word<Value>, count>& words, Value value) {
    return std::ranges::find_if(words, [&](const auto& word) { return word.second == value; })->first;
}

template <class Value, std::size_t count>
Value choice(const std::string& key, const std::string& text, const std::array<Word<Value>, count>& choices) {
    std::string expected;
    for (const auto& [name, value] : choices) {
        if (text == name) return value;
        expected += (expected.empty() ? "" : ", ") + std::string(name);
    }
    throw InputError("--" + key + ": expected one of " + expected + ", found \"" + text + "\"");
}

int count(const std::string& key, const std::string& text, int least) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < least)
        throw InputError("--" + key + ": expected a whole number of at least " + std::to_string(least) +
                         ", found \"" + text + "\"");
    return value;
}

double length(const std::string& key, const std::string& text, double metersPerUnit, bool zeroAllowed) {
    double value = 0;
    try {
        value = parseLength(text, metersPerUnit);
    } catch (const InputError& error) {
        throw InputError("--" + key + ": " + error.message);
    }
    if (value < 0 || (value == 0 && !zeroAllowed))
        throw InputError("--" + key + ": expected a length " + (zeroAllowed ? ">= 0" : "> 0") + ", found \"" +
                         text + "\"");
    return value;
}

bool flag(const std::string& key, const std::string& text) {
    return choice(key, text, flagWords);
}

/// "T_min,dt,T_max,R": plain numbers are fractions of the bounding diagonal, with units they are lengths.
GrowthOptions growth(const std::string& text, double metersPerUnit) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t comma = std::min(text.find(',', from), text.size());
        parts.push_back(text.substr(from, comma - from));
        from = comma + 1;
    }
    const auto plain = [](const std::string& part) {
        return part.find_first_not_of("+-.0123456789eE") == std::string::npos;
    };
    const auto fractions = std::ranges::count_if(parts, plain);
    if (parts.size() != 4 || (fractions != 0 && fractions != 4))
        throw InputError(
            "--growth: expected START,STEP,END,MAXRADIUS, all fractions of the bounding diagonal or all "
            "lengths with units, found \"" +
            text + "\"");
    GrowthOptions growth;
    growth.relative = fractions == 4;
    double* const values[] = {&growth.start, &growth.step, &growth.end, &growth.maxRadius};
    for (std::size_t k = 0; k < 4; ++k) *values[k] = length("growth", parts[k], metersPerUnit, false);
    return growth;
}

} // namespace

double parseNumber(const std::string& text, const std::string& what) {
    double value = 0;
    const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-');
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError(what + ": expected a finite number, found \"" + text + "\"");
    return value;
}

double parseLength(const std::string& text, double metersPerUnit) {
    constexpr const char* form = "a number, or a number with um, mm, cm, m, km, in or ft";
    static constexpr std::pair<const char*, double> units[] = {
        {"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"in", 0.0254}, {"ft", 0.3048}, {"m", 1}};
    for (const auto& [unit, meters] : units) {
        const std::string suffix = unit;
        if (text.size() <= suffix.size() ||
            text.compare(text.size() - suffix.size(), suffix.size(), suffix) != 0)
            continue;
        return parseNumber(text.substr(0, text.size() - suffix.size()),
                           "length \"" + text + "\" (" + form + ")") *
               meters / metersPerUnit;
    }
    return parseNumber(text, std::string("length (") + form + ")");
}

std::string lengthText(double length, double metersPerUnit) {
    const double meters = length * metersPerUnit, size = std::abs(meters);
    if (size >= 1) return fmt::format("{:.4g} m", meters);
    if (size >= 1e-5 || size == 0) return fmt::format("{:.4g} mm", 1e3 * meters);
    return fmt::format("{:.4g} um", 1e6 * meters);
}

std::string lengthOption(double length, double metersPerUnit) {
    std::string text = lengthText(length, metersPerUnit);
    std::erase(text, ' ');
    return text;
}

double roundedDownToDigit(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    return std::floor(value / power) * power;
}

namespace {

/// "medial (default), shrinking, growth or surface".
template <class Value, std::size_t count>
std::string listed(const std::array<Word<Value>, count>& words) {
    std::string text;
    for (std::size_t k = 0; k < count; ++k)
        text += std::string(k == 0          ? ""
                            : k + 1 < count ? ", "
                                            : " or ") +
                words[k].first + (k == 0 ? " (default)" : "");
    return text;
}

using Text = const std::string&;

std::vector<BakeOption> makeBakeOptions() {
    return {
        {"spheres", listed(sphereWords),
         [](BakeOptions& o, Text key, Text text, double) { o.spheres = choice(key, text, sphereWords); }},
        {"growth",
         "START,STEP,END,MAXRADIUS of --spheres growth: fractions of the bounding diagonal (default "
         "0.01,0.01,0.101,0.02) or lengths",
         [](BakeOptions& o, Text, Text text, double unit) { o.growth = growth(text, unit); }},
        {"tolerance",
         "how far the spheres may stick out of the meshes (default: 1/500 of the smaller body's diagonal)",
         [](BakeOptions& o, Text key, Text text, double unit) {
             o.tolerance = length(key, text, unit, false);
         }},
        {"epsilon", "gap that the table may add to that of all spheres; 0 (default): lossless",
         [](BakeOptions& o, Text key, Text text, double unit) { o.epsilon = length(key, text, unit, true); }},
        {"depth", "the gap too is right down to this depth; 0 (default): yes or no only",
         [](BakeOptions& o, Text key, Text text, double unit) { o.depth = length(key, text, unit, true); }},
        {"max-spheres", "at most so many spheres a body: the best tolerance for them",
         [](BakeOptions& o, Text key, Text text, double) { o.maxSpheres = count(key, text, 1); }},
        {"max-tests",
         "at most so many tests a table where all that may touch are kept: the best tolerance for them "
         "(default 1000000, of many pairs a share of 40 million; each takes some 240 bytes while it is "
         "baked)",
         [](BakeOptions& o, Text key, Text text, double) {
             o.mostTests = static_cast<std::size_t>(count(key, text, 1));
         }},
        {"reduce", listed(reduceWords),
         [](BakeOptions& o, Text key, Text text, double) { o.reduce = choice(key, text, reduceWords); }},
        {"search", listed(searchWords),
         [](BakeOptions& o, Text key, Text text, double) { o.search = choice(key, text, searchWords); }},
        {"samples", "poses explored by --search sampled and --reduce minimal",
         [](BakeOptions& o, Text key, Text text, double) { o.samples = count(key, text, 1); }},
        {"at-rest", "the region in which the meshes overlap at rest: " + listed(atRestWords),
         [](BakeOptions& o, Text key, Text text, double) { o.atRest = choice(key, text, atRestWords); }},
        {"inside", "a body that stands inside the other, surfaces apart: " + listed(insideWords),
         [](BakeOptions& o, Text key, Text text, double) { o.inside = choice(key, text, insideWords); }},
        {"budget", "",
         [](BakeOptions& o, Text, Text text, double) {
             o.budget = parseNumber(text, "--budget");
             if (*o.budget < 0) throw InputError("--budget: expected seconds >= 0, found \"" + text + "\"");
         }},
        {"conservative", "",
         [](BakeOptions& o, Text key, Text text, double) { o.conservative = flag(key, text); }},
        {"keep-spheres", "",
         [](BakeOptions& o, Text key, Text text, double) { o.keepSpheres = flag(key, text); }},
    };
}

const BakeOption* findOption(const std::string& key) {
    for (const BakeOption& option : bakeOptions())
        if (key == option.name) return &option;
    return nullptr;
}

} // namespace

const std::vector<BakeOption>& bakeOptions() {
    static const std::vector<BakeOption> all = makeBakeOptions();
    return all;
}

bool isOption(const std::string& key) {
    return findOption(key) != nullptr;
}

void setOption(BakeOptions& options, const std::string& key, const std::string& text, double metersPerUnit) {
    const BakeOption* option = findOption(key);
    if (!option) throw InputError("bake setting \"" + key + "\" is not known");
    option->set(options, key, text, metersPerUnit);
}

std::string methodName(const BakeOptions& options) {
    return wordOf(sphereWords, options.spheres) + "/" + wordOf(searchWords, options.search) + "/" +
           wordOf(reduceWords, options.reduce);
}

BakeOptions optionsFor(const BakeSettings& ofScene, const BakeSettings& given, double metersPerUnit) {
    BakeOptions options;
    options.metersPerUnit = metersPerUnit;
    for (const auto& [key, text] : ofScene) setOption(options, key, text, metersPerUnit);
    for (const auto& [key, text] : given) setOption(options, key, text, metersPerUnit);
    return options;
}

BakeOptions optionsFor(const SceneModel& scene, const Pair& pair) {
    constexpr std::size_t together = 40'000'000, least = 10'000;
    BakeOptions options = optionsFor(pair.settings, {}, scene.metersPerUnit);
    if (!pair.settings.contains("max-tests"))
        options.mostTests = std::clamp(together / scene.pairs.size(), least, options.mostTests);
    return options;
}

} // namespace tss
