#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/ReadTree.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/SceneParts.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"

#include <cstdlib>

using namespace tss;

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

/// Whatever could be read is written so that it reads back the same, in both encodings.
void checkRoundTrip(const Layer& layer) {
    const std::string json = writeJson(layer), cbor = writeCbor(layer);
    require(writeJson(parseLayer(json, "")) == json);
    require(writeCbor(parseLayer(cbor, "")) == cbor);
    require(writeJson(parseLayer(cbor, "")) == json);
    require(!writeUsda(layer).empty());
}

/// A scene that was accepted can be saved, and is then the same scene.
void checkScene(const std::shared_ptr<const Layer>& layer) {
    const SceneModel scene = readScene(layer, "fuzz.tss");
    for (const Pair& pair : scene.pairs) staleness(scene, pair);
    for (const SkinModel& skin : scene.skins) staleness(scene, skin);
    Layer saved = *layer;
    storeTables(saved, scene);
    const std::string once = writeJson(saved);
    const SceneModel again = readScene(saved, "fuzz.tss");
    storeTables(saved, again);
    require(writeJson(saved) == once);
}

#ifdef OSGTSS_FUZZ_CBOR
constexpr bool cbor = true;
#else
constexpr bool cbor = false;
#endif

} // namespace

/// libFuzzer's entry: any bytes, of the one encoding, are either a scene or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (looksLikeCbor(bytes) != cbor) return 0; // the other program's
    try {
        const auto layer = std::make_shared<const Layer>(parseLayer(bytes, "fuzz.tss"));
        checkRoundTrip(*layer);
        checkScene(layer);
    } catch (const InputError&) {
    }
    Problems all("fuzz.tss", Problems::Mode::Collect); // reading on after a problem must be as safe
    try {
        readScene(std::make_shared<const Layer>(parseLayer(bytes, "fuzz.tss", all)), all);
    } catch (const InputError&) {
    }
    std::vector<std::string> pointers;
    for (const InputError& error : all.errors) pointers.push_back(error.where.pointer);
    if (!cbor) require(locateJson(bytes, pointers).size() == pointers.size());
    return 0;
}
