#include "bake/scene/SceneLayer.h"
#include "bake/scene/SceneParts.h"

namespace tss {

namespace {

Place metadataPlace(const char* key) {
    return Place() / "metadata" / key;
}

double number(const SceneReading& reading, const char* key, double fallback, bool positive = false) {
    const auto found = reading.layer.metadata.find(key);
    if (found == reading.layer.metadata.end()) return fallback;
    const double* value = found->second.as<double>();
    if (value && (!positive || *value > 0)) return *value;
    reading.problems.add(metadataPlace(key), "expected a number", positive ? " above 0" : "", ", found ",
                         describe(found->second));
    return fallback;
}

std::string text(const SceneReading& reading, const char* key, const std::string& fallback) {
    const auto found = reading.layer.metadata.find(key);
    if (found == reading.layer.metadata.end()) return fallback;
    if (const auto* value = found->second.as<std::string>()) return *value;
    reading.problems.add(metadataPlace(key), "expected a string, found ", describe(found->second));
    return fallback;
}

/// The layer's metadata; what is absent has USD's fallback (centimetres, Y up).
void readMetadata(SceneReading& reading) {
    SceneModel& scene = reading.scene;
    const auto& prims = reading.layer.children;
    scene.defaultPrim = text(reading, "defaultPrim", prims.empty() ? "Scene" : prims.front().name);
    if (reading.layer.metadata.contains("defaultPrim") && !findPrim(reading.layer, "/" + scene.defaultPrim))
        reading.problems.add(metadataPlace("defaultPrim"), "expected the name of a root prim, found \"",
                             scene.defaultPrim, "\"");
    if (const Prim* root = findPrim(reading.layer, "/" + scene.defaultPrim))
        scene.displayName = originalNameOf(*root);
    scene.metersPerUnit = number(reading, "metersPerUnit", 0.01, true);
    scene.timeCodesPerSecond = number(reading, "timeCodesPerSecond", 24, true);
    scene.startTimeCode = number(reading, "startTimeCode", 0);
    scene.endTimeCode = number(reading, "endTimeCode", scene.startTimeCode);
    if (scene.endTimeCode < scene.startTimeCode)
        reading.problems.add(metadataPlace("endTimeCode"),
                             "expected a time that is not before startTimeCode");
    const std::string up = text(reading, "upAxis", "Y");
    if (up != "Y" && up != "Z")
        reading.problems.add(metadataPlace("upAxis"), "expected \"Y\" or \"Z\", found \"", up, "\"");
    scene.upAxis = up == "Z" ? 'Z' : 'Y';
}

void writeMetadata(Layer& layer, const SceneModel& scene) {
    layer.metadata["defaultPrim"] = scene.defaultPrim;
    layer.metadata["metersPerUnit"] = scene.metersPerUnit;
    layer.metadata["upAxis"] = std::string(1, scene.upAxis);
    if (scene.timeCodesPerSecond != 24) layer.metadata["timeCodesPerSecond"] = scene.timeCodesPerSecond;
    if (scene.startTimeCode == 0 && scene.endTimeCode == 0) return;
    layer.metadata["startTimeCode"] = scene.startTimeCode;
    layer.metadata["endTimeCode"] = scene.endTimeCode;
}

} // namespace

int SceneReading::resolve(const PrimReader& prim, const Attribute& relationship,
                          const std::string& path) const {
    const int entry = index.find(path);
    if (entry < 0)
        prim.targetProblem(relationship, "expected the path of a prim of the scene, found \"", path, "\"");
    return entry;
}

bool SceneReading::ownPrim(int entry, const char* what) const {
    const bool own = !index.entries[entry].composed;
    if (!own) problems.add(index.entries[entry].place, "expected ", what, " on a prim without references");
    return own;
}

int SceneReading::body(const PrimReader& prim, const Attribute& relationship, const std::string& path) const {
    if (path.empty() || resolve(prim, relationship, path) < 0) return -1;
    const auto found = bodyAt.find(path);
    if (found != bodyAt.end()) return found->second;
    prim.targetProblem(relationship, "expected the path of a Mesh or an Xform, found \"", path, "\"");
    return -1;
}

SceneModel readScene(std::shared_ptr<const Layer> layer, Problems& problems) {
    SceneReading reading(*layer, problems);
    readMetadata(reading);
    readBodies(reading);
    readJoints(reading);
    readPairs(reading);
    readMuscles(reading);
    readSkins(reading);
    checkCarried(reading);
    readTables(reading);
    reading.scene.layer = std::move(layer);
    return std::move(reading.scene);
}

SceneModel readScene(std::shared_ptr<const Layer> layer, const std::string& fileName) {
    Problems problems(fileName);
    return readScene(std::move(layer), problems);
}

SceneModel readScene(const Layer& layer, const std::string& fileName) {
    return readScene(std::make_shared<const Layer>(layer), fileName);
}

Layer toLayer(const SceneModel& scene) {
    Layer layer;
    writeMetadata(layer, scene);
    writeOriginalName(makePrim(layer, "/" + scene.defaultPrim, "Xform"), scene.displayName);
    writeBodies(layer, scene);
    writeJoints(layer, scene);
    for (const Pair& pair : scene.pairs) writePair(layer, scene, pair);
    writeMuscles(layer, scene);
    writeSkins(layer, scene);
    storeTables(layer, scene);
    return layer;
}

} // namespace tss
