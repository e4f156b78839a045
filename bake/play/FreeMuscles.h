#pragma once
#include "bake/model/SceneModel.h"
#include "bake/motion/MuscleSpan.h"

#include <memory>
#include <string>

namespace tss {

/// The muscles of a scene that lie under no skin, in motion: each with its bone, or between its two.
class FreeMuscles {
public:
    /// warnings: those that cannot be played. Keeps a reference to the scene.
    FreeMuscles(const SceneModel& scene, std::vector<std::string>& warnings);

    void activate(double timeCode); ///< at rest before

    /// Their shapes in their bodies' frames, and where these now are. placements: body to world, one per
    /// body.
    void pose(std::vector<TriangleMesh>& meshes, std::vector<Pose>& placements) const;

private:
    struct Item {
        const MuscleModel* model;
        std::shared_ptr<const MuscleDeformer> deformer;
        MuscleShape shape;      ///< of the deformer
        std::vector<int> chain; ///< its muscleChain(), where its origin is on a bone
        double activation;
    };
    const SceneModel& scene_;
    std::vector<Item> items_;
};

/// Whether a skin of the scene names a muscle.
bool underSomeSkin(const SceneModel& scene, std::size_t muscle);

} // namespace tss
