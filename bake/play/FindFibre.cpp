#include "bake/play/FindFibre.h"

#include "bake/geometry/FibreLine.h"
#include "bake/geometry/MeshQuery.h"

#include <algorithm>

namespace tss {

std::vector<Vec3> findFibre(const SceneModel& scene, const MuscleModel& muscle) {
    const Body& body = scene.bodies.at(static_cast<std::size_t>(muscle.body));
    if (muscle.muscle.form == MuscleForm::Ring) return ringLine(body.mesh);
    std::vector<Vec3> fibre = fibreLine(body.mesh);
    if (muscle.bone < 0) return fibre;
    const Body& bone = scene.bodies.at(static_cast<std::size_t>(muscle.bone));
    if (bone.mesh.empty()) return fibre;
    const MeshQuery query(bone.mesh);
    const Pose toBone = bone.placement.inverse(Eigen::Isometry) * body.placement;
    if (query.distance(toBone * fibre.back()) < query.distance(toBone * fibre.front()))
        std::ranges::reverse(fibre);
    return fibre;
}

} // namespace tss
