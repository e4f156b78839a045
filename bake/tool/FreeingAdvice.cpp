#include "bake/tool/FreeingAdvice.h"

#include "bake/geometry/MeshAudit.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/pipeline/FreeingMove.h"
#include "bake/tool/DofSpec.h"

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

/// As an option of `tss make` has it; what is nothing beside `size` is 0.
std::string vectorText(const Vec3& v, double size) {
    const auto coordinate = [&](double x) { return std::abs(x) < 1e-6 * size ? 0.0 : x; };
    return fmt::format("{:.7g},{:.7g},{:.7g}", coordinate(v.x()), coordinate(v.y()), coordinate(v.z()));
}

std::string dofOption(const Dof& dof, double size) {
    const std::string limits = fmt::format("{:.7g}:{:.7g}", toUser(dof, dof.lower), toUser(dof, dof.upper));
    if (dof.kind == DofKind::Translation)
        return fmt::format("--dof trans:{}:{}", vectorText(dof.axis, dof.axis.norm()), limits);
    return fmt::format("--dof rot:{}:{}:{}", vectorText(dof.origin, size), vectorText(dof.axis, 1), limits);
}

std::string dofOptions(const Motion& motion, double size) {
    std::string text;
    for (const Dof& dof : motion.dofs)
        text += fmt::format("{}{}", text.empty() ? "" : " ", dofOption(dof, size));
    return text;
}

class Adviser {
public:
    Adviser(const SceneModel& scene, const Pair& pair, const Console& console)
        : unit_(scene.metersPerUnit), pair_(pair), console_(console), motion_(pairMotion(scene, pair)) {
        // What `tss make` has made: B has the axes of A, moved by --b-offset.
        const Pose atZero = pose(motion_, std::vector<double>(motion_.dofCount(), 0.0));
        plain_ = pair.joints.size() == scene.joints.size() &&
                 (atZero.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-6;
        already_ = plain_ ? Vec3(atZero.translation()) : Vec3(Vec3::Zero());
        dofs_ = plain_ && std::none_of(motion_.dofs.begin(), motion_.dofs.end(),
                                       [](const Dof& dof) { return dof.kind == DofKind::Path; });
    }

    Json say(const TriangleMesh& a, const TriangleMesh& b) {
        Json advice = Json::array();
        const std::vector<FreeingMove> moves = freeingMoves(a, b, motion_, {dofs_});
        if (moves.empty()) return advice;
        size_ = std::min(bounds(a).diagonal().norm(), bounds(b).diagonal().norm());
        console_.say(fmt::format(
            "{}: the meshes overlap where the joint rests. {}, found by trying, the best first:", pair_.path,
            plain_ ? "Options of tss make, in place of those given, that move B out of A"
                   : "Shifts of B that move it out of A, such as by --b-offset"));
        for (const FreeingMove& move : moves) advice.push_back(sayMove(move));
        return advice;
    }

private:
    std::string length(double value) const { return lengthText(value, unit_); }

    Json sayMove(const FreeingMove& move) const {
        const std::string shift = fmt::format("--b-offset={}", vectorText(already_ + move.shift, size_));
        std::string option = shift;
        if (move.axes.norm() > 1e-6 * size_) option += fmt::format(" {}", dofOptions(move.motion, size_));
        std::string text = fmt::format("  {}\n    B lies {} elsewhere, free at {} of {} poses", option,
                                       length(move.moved), move.free, move.poses);
        if (move.freeAtRest) text += fmt::format(", {} apart at rest", length(move.atRest));
        if (move.free > 0) text += fmt::format(", {} where it is closest", length(move.least));
        if (move.stops > 0) text += fmt::format("; stopped by contact at {}, as before", move.stops);
        std::string tolerance;
        // Spheres of both bodies stick out: together they are to leave some of the room.
        if (move.free > 0 && 0.3 * move.least < size_ / 500) tolerance = roundedText(0.3 * move.least, unit_);
        if (!tolerance.empty()) text += fmt::format("; then bake with --tolerance {}", tolerance);
        console_.say(text);
        return {{"option", option},
                {"shift", {move.shift.x(), move.shift.y(), move.shift.z()}},
                {"axes", {move.axes.x(), move.axes.y(), move.axes.z()}},
                {"moved", move.moved},
                {"freePoses", move.free},
                {"stops", move.stops},
                {"poses", move.poses},
                {"apartAtRest", move.atRest},
                {"least", move.least},
                {"tolerance", tolerance},
                {"beyond", sayBeyond(move, shift)}};
    }

    /// What it would meet if it went on, and limits that let it.
    Json sayBeyond(const FreeingMove& move, const std::string& shift) const {
        if (move.beyond.empty()) return nullptr;
        std::string where;
        Motion wider = move.motion;
        for (const StopBeyond& stop : move.beyond) {
            const Dof& dof = motion_.dofs[stop.dof];
            where += fmt::format("{}at {:.4g}{} of {}", where.empty() ? "" : " and ", toUser(dof, stop.value),
                                 dof.kind == DofKind::Rotation ? " degrees" : "", dof.name);
            // A little farther, so that it is contact that stops it.
            const double more = 0.05 * (dof.upper - dof.lower);
            Dof& widened = wider.dofs[stop.dof];
            if (stop.value < dof.lower)
                widened.lower = stop.value - more;
            else
                widened.upper = stop.value + more;
        }
        const std::string option = dofs_ ? fmt::format("{} {}", shift, dofOptions(wider, size_)) : "";
        console_.say(fmt::format("    B meets nothing within these limits then; it would {}{}{}", where,
                                 dofs_ ? ". For limits that end at contact:\n    " : "", option));
        return {{"where", where}, {"option", option}};
    }

    const double unit_;
    const Pair& pair_;
    const Console& console_;
    const Motion motion_;
    bool plain_ = false, dofs_ = false;
    Vec3 already_;
    double size_ = 0;
};

} // namespace

Json adviseMoves(const SceneModel& scene, const Pair& pair, const Console& console) {
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    if (a.empty() || b.empty()) return Json::array();
    return Adviser(scene, pair, console).say(cleaned(a), cleaned(b));
}

} // namespace tss::tool
