#include "bake/scene/SceneFile.h"

#include "bake/model/CheckIndices.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/SceneParts.h"
#include "bake/scene/WriteLayer.h"

namespace tss {

SceneModel loadScene(const std::string& file) {
    return readScene(std::make_shared<const Layer>(readLayer(file)), file);
}

Layer layerOf(const SceneModel& scene) {
    checkIndices(scene);
    if (!scene.layer) return toLayer(scene);
    Layer layer = *scene.layer;
    storeTables(layer, scene);
    return layer;
}

void saveScene(const SceneModel& scene, const std::string& file) {
    inFile(file, [&] {
        const auto layer = std::make_shared<const Layer>(layerOf(scene));
        readScene(layer, file); // what cannot be read is not written
        saveLayer(*layer, file);
    });
}

} // namespace tss
