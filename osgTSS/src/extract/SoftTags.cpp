#include "SoftTags.h"

#include "bake/base/Error.h"

#include <osg/ValueObject>

#include <cmath>
#include <limits>
#include <sstream>

namespace osgTSS {

namespace {

struct Word {
    std::string key, value;
};

Word split(const std::string& word) {
    const auto sign = word.find('=');
    return {word.substr(0, sign), sign == std::string::npos ? "" : word.substr(sign + 1)};
}

double numberOf(const Word& word, const char* tag, double least, double most) {
    std::istringstream text(word.value);
    double value = 0;
    text >> value;
    if (text.fail() || text.peek() != EOF || !(value >= least) || !(value <= most))
        throw tss::InputError(std::string(tag) + ": expected a number for " + word.key + ", found \"" +
                              word.value + "\"");
    return value;
}

constexpr double any = std::numeric_limits<double>::max();

} // namespace

std::optional<std::string> tagWords(const osg::Node& node, const char* tag) {
    std::string words;
    bool plain = false;
    if (node.getUserValue(tag, words)) return words;
    if (node.getUserValue(tag, plain) && plain) return "";
    return std::nullopt;
}

std::vector<std::string> wordsOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

tss::SkinModel parseSkin(const std::string& words) {
    tss::SkinModel skin;
    for (const std::string& text : wordsOf(words)) {
        const Word word = split(text);
        if (text == "self")
            skin.selfContact = true;
        else if (word.key == "thickness")
            skin.thickness = numberOf(word, skinTag, 0, any);
        else if (word.key == "travel")
            skin.travel = numberOf(word, skinTag, 0, any);
        else if (word.key == "stretch")
            skin.stretchCompliance = numberOf(word, skinTag, 0, any);
        else if (word.key == "bend")
            skin.bendCompliance = numberOf(word, skinTag, 0, any);
        else
            throw tss::InputError(std::string(skinTag) +
                                  ": expected self, thickness=, travel=, stretch= or bend=, found \"" + text +
                                  "\"");
    }
    return skin;
}

TaggedMuscle parseMuscle(const std::string& words) {
    TaggedMuscle tag;
    for (const std::string& text : wordsOf(words)) {
        const Word word = split(text);
        if (text == "tube")
            tag.model.muscle.form = tss::MuscleForm::Tube;
        else if (text == "sheet")
            tag.model.muscle.form = tss::MuscleForm::Sheet;
        else if (text == "ring")
            tag.model.muscle.form = tss::MuscleForm::Ring;
        else if (word.key == "contract")
            tag.model.muscle.maxContraction = numberOf(word, muscleTag, 0, std::nextafter(1.0, 0.0));
        else if (word.key == "anchor")
            tag.model.muscle.anchor = numberOf(word, muscleTag, 0, 1);
        else if (word.key == "skin" && !word.value.empty())
            tag.skins.push_back(word.value);
        else if (word.key == "to" && !word.value.empty())
            tag.to = word.value;
        else
            throw tss::InputError(
                std::string(muscleTag) +
                ": expected tube, sheet, ring, contract=, anchor=, skin=NAME or to=NAME, found \"" + text +
                "\"");
    }
    return tag;
}

tss::TimeSamples parseActivation(const std::string& words, double timeCodesPerSecond) {
    tss::TimeSamples samples;
    for (const std::string& word : wordsOf(words)) {
        std::istringstream text(word);
        double seconds = 0, value = 0;
        char colon = 0;
        text >> seconds >> colon >> value;
        const double time = seconds * timeCodesPerSecond;
        if (text.fail() || colon != ':' || text.peek() != EOF || !std::isfinite(value) ||
            !std::isfinite(time) || (!samples.empty() && time <= samples.times.back()))
            throw tss::InputError(std::string(activationTag) +
                                  ": expected a number, or SECOND:VALUE one after the other, found \"" +
                                  word + "\"");
        samples.times.push_back(time);
        samples.values.push_back(value);
    }
    return samples;
}

} // namespace osgTSS
