#include "bake/tool/FreeingAdvice.h"

#include "bake/geometry/MeshAudit.h"
#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/pipeline/FreeingMove.h"
#include "bake/robot/PairEvidence.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tss::tool {

namespace {

/// "x,y,z" as options of `tss make` take it; coordinates that are negligible beside `size` are written as 0.
std::string vectorText(const Vec3& v, double size) {
    const auto coordinate = [&](double x) { return std::abs(x) < 1e-6 * size ? 0.0 : x; };
    return fmt::format("{:.7g},{:.7g},{:.7g}", coordinate(v.x()), coordinate(v.y()), coordinate(v.z()));
}

/// A DOF as --dof and --joint take it.
std::string dofText(const Dof& dof, double size) {
    const std::string limits = fmt::format("{:.7g}:{:.7g}", toUser(dof, dof.lower), toUser(dof, dof.upper));
    if (dof.kind == DofKind::Translation)
        return fmt::format("trans:{}:{}", vectorText(dof.axis, dof.axis.norm()), limits);
    return fmt::format("rot:{}:{}:{}", vectorText(dof.origin, size), vectorText(dof.axis, 1), limits);
}

/// " of NAME", the name of a DOF, which in a chain begins with that of its joint; empty where it has none.
std::string ofDof(const Dof& dof) {
    const std::string name = dof.name.ends_with(':') ? dof.name.substr(0, dof.name.size() - 1) : dof.name;
    return name.empty() ? "" : " of " + name;
}

/// The options of `tss make` that can say where B lies: --b-offset and --dof, a --joint, or, where it is not
/// known that the scene was made by either, --offset.
enum class MadeBy { TwoMeshes, Joint, Unknown };

MadeBy madeBy(const SceneModel& scene, const Pair& pair) {
    const auto parsed = [&](int joint) {
        const std::vector<Dof>& dofs = scene.joints[joint].dofs;
        return std::ranges::all_of(dofs, [](const Dof& dof) { return isParsedName(dof.name); });
    };
    const auto solid = std::ranges::count_if(scene.bodies, [](const Body& b) { return !b.mesh.empty(); });
    if (pair.joints.size() == scene.joints.size() && solid == 2 && std::ranges::all_of(pair.joints, parsed))
        return MadeBy::TwoMeshes;
    const bool upright = scene.bodies[pair.bodyA].placement.linear().isIdentity(1e-6);
    const bool oneJoint = pair.joints.size() == 1 && scene.joints[pair.joints[0]].body0 == pair.bodyA;
    return upright && oneJoint ? MadeBy::Joint : MadeBy::Unknown;
}

/// Limits that go a little past each stop of the move, so that it is contact that ends the motion; a turn is
/// widened to no more than a whole one.
Motion widened(const FreeingMove& move, const Motion& before) {
    Motion wider = move.motion;
    for (const StopBeyond& stop : move.beyond) {
        const Dof& dof = before.dofs[stop.dof];
        const double more = 0.05 * (dof.upper - dof.lower);
        if (stop.value < dof.lower)
            wider.dofs[stop.dof].lower = stop.value - more;
        else
            wider.dofs[stop.dof].upper = stop.value + more;
    }
    for (std::size_t k = 0; k < wider.dofs.size(); ++k) {
        Dof& dof = wider.dofs[k];
        const double excess = dof.upper - dof.lower - fullTurn;
        if (dof.kind != DofKind::Rotation || !(excess > 0)) continue;
        const bool loweredLimit = before.dofs[k].lower > dof.lower;
        const bool raisedLimit = before.dofs[k].upper < dof.upper;
        if (loweredLimit) dof.lower += excess / (raisedLimit ? 2 : 1);
        if (raisedLimit) dof.upper -= excess / (loweredLimit ? 2 : 1);
    }
    return wider;
}

class Adviser {
public:
    Adviser(const SceneModel& scene, const Pair& pair, bool onlyBest, const Console& console)
        : unit_(scene.metersPerUnit), pair_(pair), onlyBest_(onlyBest), console_(console),
          motion_(pairMotion(scene, pair)), a_(originalName(scene.bodies[pair.bodyA])),
          b_(originalName(scene.bodies[pair.bodyB])) {
        // In scenes that `tss make` made, B has the axes of A and is moved by the offset.
        const Pose atZero = pose(motion_, std::vector<double>(motion_.dofCount(), 0.0));
        if ((atZero.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-6) madeBy_ = madeBy(scene, pair);
        if (madeBy_ != MadeBy::Unknown) offset_ = atZero.translation();
        if (madeBy_ == MadeBy::TwoMeshes) a_ = 'A', b_ = 'B';
        canSayDofs_ = madeBy_ != MadeBy::Unknown && std::ranges::none_of(motion_.dofs, [](const Dof& dof) {
                          return dof.kind == DofKind::Path;
                      });
    }

    Json say(const TriangleMesh& a, const TriangleMesh& b) {
        Json advice = Json::array();
        constexpr double seconds = 20;
        const auto [moves, complete, elsewhere, apart] = freeingMoves(a, b, motion_, {canSayDofs_, seconds});
        if (elsewhere) sayElsewhere(*elsewhere);
        if (apart) sayApart(*apart);
        if (!complete)
            console_.say(fmt::format("{}: the meshes overlap where the joint rests; the search for moves "
                                     "that free it ended after {} s{}",
                                     pair_.path, seconds,
                                     moves.empty() ? ", and none was found" : ", smaller ones may exist"));
        if (moves.empty()) return advice;
        size_ = std::min(diagonal(a), diagonal(b));
        console_.say(
            fmt::format("{}: the meshes overlap where the joint rests. Options of tss make that move "
                        "{} out of {}, found by\n  trying, the best{}{}:",
                        pair_.path, b_, a_, onlyBest_ ? " alone (--json has all)" : " first",
                        madeBy_ == MadeBy::TwoMeshes ? "; they take the place of those given" : ""));
        for (const FreeingMove& move : moves) advice.push_back(sayMove(move, !onlyBest_ || advice.empty()));
        return advice;
    }

private:
    std::string length(double value) const { return lengthText(value, unit_); }

    /// What to type to move B by `shift`, and with it the axes of the motion where `axes` asks for that.
    std::string option(const Vec3& shift, const Motion& motion, bool axes) const {
        if (madeBy_ != MadeBy::TwoMeshes && !axes)
            return fmt::format("--offset {}={}", shellWord(b_), vectorText(shift, size_));
        const std::string by = vectorText(offset_ + shift, size_);
        std::vector<std::string> texts;
        if (axes)
            for (const Dof& dof : motion.dofs) texts.push_back(dofText(dof, size_));
        if (madeBy_ == MadeBy::Joint)
            return fmt::format("--joint '{}={},{}:{};offset:{}'", primName(pair_.path), a_, b_,
                               fmt::join(texts, ";"), by);
        std::string text = "--b-offset=" + by;
        for (const std::string& dof : texts) text += " --dof " + dof;
        return text;
    }

    /// Apart at rest: what overlaps on purpose is not known.
    void sayElsewhere(const TouchingElsewhere& elsewhere) const {
        console_.say(fmt::format(
            "{}: the meshes are apart at rest and touch at {} of {} poses. Where they should not, look at "
            "origin, axis\n  and limits.{} Where it is the joint's own surfaces that overlap, let it rest "
            "there ({}): they are free\n  then, and moves of {} that give them room are looked for",
            pair_.path, elsewhere.touching, elsewhere.poses,
            motion_.dofCount() > 1
                ? " Where one value drives the others, as of gears, let a path say so (--dof path).\n "
                : "",
            restAt(elsewhere.values), b_));
    }

    /// Overlapping at rest: whether on purpose is not known.
    void sayApart(const ApartElsewhere& found) const {
        console_.say(fmt::format("{}: the meshes overlap where the joint rests, and what overlaps there is "
                                 "excepted; at {} of {} poses they\n  are apart. Where they should not "
                                 "overlap, let it rest where they are {} apart ({})",
                                 pair_.path, found.apart, found.poses, length(found.distance),
                                 restAt(found.values)));
    }

    /// The option or the attribute by which a joint rests at these values.
    std::string restAt(const std::vector<double>& q) const {
        std::vector<std::string> values;
        const bool named = madeBy_ != MadeBy::TwoMeshes && pair_.joints.size() > 1;
        for (std::size_t k = 0; k < motion_.dofCount(); ++k) {
            values.push_back(fmt::format("{:.4g}", toUser(motion_.dofs[k], q[k])));
            if (named) values.back() += ofDof(motion_.dofs[k]);
        }
        return fmt::format("{}{}", madeBy_ == MadeBy::TwoMeshes ? "--rest=" : "tss:rest ",
                           fmt::join(values, named ? ", " : ","));
    }

    Json sayMove(const FreeingMove& move, bool aloud) const {
        const std::string words = option(move.shift, move.motion, move.axes.norm() > 1e-6 * size_);
        const char* beside = madeBy_ == MadeBy::TwoMeshes ? ""
                             : words.starts_with("--offset")
                                 ? "beside the options given: "
                                 : "in place of that --joint (in a robot's file, move the axis likewise): ";
        std::string text = fmt::format("  {}\n    {}{} lies {} elsewhere, free at {} of {} poses", words,
                                       beside, b_, length(move.moved), move.free, move.poses);
        if (move.freeAtRest) text += fmt::format(", {} apart at rest", length(move.atRest));
        if (move.free > 0) text += fmt::format(", {} where it is closest", length(move.least));
        if (const std::size_t near = move.poses - move.free - move.meets; near > 0)
            text += fmt::format(", at {} less than {} apart", near, length(move.margin));
        if (move.stops > 0) text += fmt::format("; stopped by contact at {}, as before", move.stops);
        std::string tolerance;
        // Spheres of both bodies stick out: together they are to leave some of the room.
        if (move.free > 0 && 0.3 * move.least < size_ / 500)
            tolerance = lengthOption(roundedDownToDigit(0.3 * move.least), unit_);
        if (!tolerance.empty()) text += fmt::format("; then bake with --tolerance {}", tolerance);
        if (aloud) console_.say(text);
        return {{"option", words},
                {"shift", {move.shift.x(), move.shift.y(), move.shift.z()}},
                {"axes", {move.axes.x(), move.axes.y(), move.axes.z()}},
                {"moved", move.moved},
                {"freePoses", move.free},
                {"stops", move.stops},
                {"poses", move.poses},
                {"apartAtRest", move.atRest},
                {"least", move.least},
                {"tolerance", tolerance},
                {"beyond", sayBeyond(move)}};
    }

    /// What it would meet if it went on, and limits that let it.
    Json sayBeyond(const FreeingMove& move) const {
        if (move.beyond.empty()) return nullptr;
        std::string where;
        for (const StopBeyond& stop : move.beyond) {
            const Dof& dof = motion_.dofs[stop.dof];
            where += fmt::format("{}at {:.4g}{}{}", where.empty() ? "" : " and ", toUser(dof, stop.value),
                                 dof.kind == DofKind::Rotation ? " degrees" : "", ofDof(dof));
        }
        const std::string words = canSayDofs_ ? option(move.shift, widened(move, motion_), true) : "";
        if (!onlyBest_)
            console_.say(fmt::format(
                "    {} meets nothing within these limits then; beyond them it does, {} at the latest{}{}",
                b_, where, canSayDofs_ ? ". For limits that go on past contact:\n    " : "", words));
        return {{"where", where}, {"option", words}};
    }

    const double unit_;
    const Pair& pair_;
    const bool onlyBest_;
    const Console& console_;
    const Motion motion_;
    std::string a_, b_; ///< the bodies, as the user knows them
    MadeBy madeBy_ = MadeBy::Unknown;
    bool canSayDofs_ = false;    ///< as options
    Vec3 offset_ = Vec3::Zero(); ///< of B, by the options that it was made with
    double size_ = 0;            ///< diagonal of the smaller body
};

} // namespace

Json adviseMoves(const SceneModel& scene, const Pair& pair, std::size_t pairs, const Console& console) {
    constexpr std::size_t readable = 3; // pairs, of which a page of text has room for all moves
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    if (a.empty() || b.empty()) return Json::array();
    return Adviser(scene, pair, pairs > readable, console).say(cleaned(a), cleaned(b));
}

} // namespace tss::tool
