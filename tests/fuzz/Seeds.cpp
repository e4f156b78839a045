// Writes the seeds of the fuzzers, FOLDER/json and FOLDER/cbor, a dictionary of the words in them,
// FOLDER/words, and the buffers that they name.
#include "bake/base/AtomicFile.h"
#include "bake/scene/Buffers.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "tests/scene/RandomLayer.h"
#include "tests/scene/Samples.h"

#include <filesystem>
#include <set>

using namespace tss;

namespace {

/// The words of a value that a mutation may put elsewhere: its texts and keys.
void collectWords(std::string_view json, std::set<std::string>& words) {
    constexpr std::size_t longest = 40;
    while (true) {
        const auto open = json.find('"');
        if (open == std::string_view::npos) return;
        const auto close = json.find('"', open + 1);
        const std::string word(json.substr(open, close - open + 1));
        if (word.size() <= longest && word.find('\\') == std::string::npos) words.insert(word);
        json.remove_prefix(close + 1);
    }
}

/// libFuzzer's form of a dictionary: "..." a line, with \ before quotes.
std::string dictionary(const std::set<std::string>& words) {
    std::string lines;
    for (const std::string& word : words) lines += "\"\\\"" + word.substr(1, word.size() - 2) + "\\\"\"\n";
    return lines;
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) return 2;
    const std::string folder = arguments[1];
    for (const char* encoding : {"/json", "/cbor"}) std::filesystem::create_directories(folder + encoding);
    std::vector<Layer> layers;
    for (const SceneModel& scene : {samples::jaw(), samples::brow(), samples::everything()})
        layers.push_back(layerOf(scene));
    Prim copy;
    copy.name = "Copy";
    copy.metadata["references"] = Value(Value::Object{{"prepend", Value(Value::Array{Value("/Scene/A")})}});
    copy.metadata["instanceable"] = Value(true);
    Layer composed = layers.back();
    composed.children.push_back(copy);
    layers.push_back(composed);
    const Buffer buffer = takeBuffer(composed, "seed", 4);
    writeFileAtomically(folder + "/" + buffer.uri, buffer.bytes);
    layers.push_back(composed);
    std::set<std::string> words;
    for (const Layer& layer : layers) collectWords(writeJson(layer), words);
    for (std::uint64_t seed = 0; seed < 40; ++seed) layers.push_back(RandomLayer(seed).layer());
    constexpr std::size_t largest = 12000; // bytes: the smaller, the more runs a second
    std::erase_if(layers, [](const Layer& layer) { return writeJson(layer).size() > largest; });
    for (std::size_t i = 0; i < layers.size(); ++i) {
        writeFileAtomically(folder + "/json/" + std::to_string(i), writeJson(layers[i]));
        writeFileAtomically(folder + "/cbor/" + std::to_string(i), writeCbor(layers[i]));
    }
    writeFileAtomically(folder + "/words", dictionary(words));
}
