#include "bake/tool/FreeingAdvice.h"

#include "bake/pipeline/BakeOptions.h"
#include "bake/pipeline/FreeingShift.h"
#include "bake/geometry/MeshAudit.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tss::tool {

namespace {

std::string roundedText(double length, double metersPerUnit) {
    const double power = std::pow(10.0, std::floor(std::log10(length)));
    std::string text = lengthText(std::floor(length / power) * power, metersPerUnit);
    std::erase(text, ' ');
    return text;
}

/// The first that frees the rest pose, and the one with the most room.
std::vector<FreeingShift> worthSaying(const std::vector<FreeingShift>& all) {
    std::vector<FreeingShift> some;
    const auto first =
        std::find_if(all.begin(), all.end(), [](const FreeingShift& s) { return s.freeAtRest; });
    if (first != all.end()) some.push_back(*first);
    if (!all.empty() && (first == all.end() || first + 1 != all.end())) some.push_back(all.back());
    return some;
}

} // namespace

Json adviseShifts(const SceneModel& scene, const Pair& pair, const Console& console) {
    const TriangleMesh &meshA = scene.bodies[pair.bodyA].mesh, &meshB = scene.bodies[pair.bodyB].mesh;
    const Motion motion = pairMotion(scene, pair);
    Json advice = Json::array();
    if (meshA.empty() || meshB.empty()) return advice;
    const TriangleMesh a = cleaned(meshA), b = cleaned(meshB);
    const std::vector<FreeingShift> shifts = worthSaying(freeingShifts(a, b, motion));
    if (shifts.empty()) return advice;
    // What `tss make` has moved B by already.
    const Pose atZero = pose(motion, std::vector<double>(motion.dofCount(), 0.0));
    const bool plain = pair.joints.size() == 1 && (atZero.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-6;
    const Vec3 already = plain ? Vec3(atZero.translation()) : Vec3(Vec3::Zero());
    const double size = std::min(bounds(a).diagonal().norm(), bounds(b).diagonal().norm());
    console.say(
        fmt::format("{}: the meshes overlap where the joint rests. {} of tss make, found by trying, that "
                    "moves B out of A:",
                    pair.path, plain ? "An option" : "A shift of B, such as by --b-offset"));
    for (const FreeingShift& shift : shifts) {
        const Vec3 offset = already + shift.shift;
        const auto coordinate = [&](double x) { return std::abs(x) < 1e-6 * size ? 0.0 : x; };
        const std::string option = fmt::format("--b-offset={:.5g},{:.5g},{:.5g}", coordinate(offset.x()),
                                               coordinate(offset.y()), coordinate(offset.z()));
        std::string text =
            fmt::format("  {}   ({} from here) free at {} of {} poses", option,
                        lengthText(shift.shift.norm(), scene.metersPerUnit), shift.free, shift.poses);
        if (shift.freeAtRest)
            text += fmt::format(", {} apart at rest", lengthText(shift.atRest, scene.metersPerUnit));
        std::string tolerance;
        // Spheres of both bodies stick out: together they are to leave some of the room.
        if (shift.free > 0 && 0.3 * shift.least < size / 500)
            tolerance = roundedText(0.3 * shift.least, scene.metersPerUnit);
        if (!tolerance.empty()) text += "; then bake with --tolerance " + tolerance;
        console.say(text);
        advice.push_back({{"option", option},
                          {"shift", {shift.shift.x(), shift.shift.y(), shift.shift.z()}},
                          {"freePoses", shift.free},
                          {"poses", shift.poses},
                          {"apartAtRest", shift.atRest},
                          {"least", shift.least},
                          {"tolerance", tolerance}});
    }
    return advice;
}

} // namespace tss::tool
