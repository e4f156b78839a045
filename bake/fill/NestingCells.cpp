#include "bake/fill/NestingCells.h"

#include "bake/motion/CellTools.h"

#include <algorithm>
#include <limits>
#include <random>

namespace tss {

namespace {

/// A query whether a point is inside a solid takes the time of so many probes.
constexpr std::uint64_t probesOfInside = 10;

/// Whether a ball of that radius, scene units, may fit inside the solid. False is proven.
bool ballFits(const Solid& solid, double radius) {
    const MeshQuery& surface = solid.boundary();
    std::vector<Eigen::AlignedBox3d> boxes{bounds(solid.mesh())};
    for (int probes = 0; !boxes.empty(); ++probes) {
        const Eigen::AlignedBox3d one = boxes.back();
        boxes.pop_back();
        const double half = 0.5 * one.diagonal().norm();
        if (half < radius && surface.comesWithin(one.center(), radius - half)) continue;
        if (!surface.comesWithin(one.center(), half) && !solid.inside(one.center())) continue;
        if (half < 0.02 * radius || probes > 20'000) return true;
        Eigen::Index k = 0;
        one.sizes().maxCoeff(&k);
        Eigen::AlignedBox3d lower = one, upper = one;
        lower.max()[k] = upper.min()[k] = one.center()[k];
        boxes.push_back(lower);
        boxes.push_back(upper);
    }
    return false;
}

} // namespace

NestingExaminer::NestingExaminer(const Solid& a, const Solid& b, const MotionRates& rates, double reach)
    : surfaceA_(a.mesh()), surfaceB_(b.mesh()), rates_(rates), reach_(reach),
      rounding_(coordinateRounding(rates.motion(), surfaceA_.extent(), surfaceB_.extent())),
      questions_{NestingQuestion{a, surfaceA_, false}, NestingQuestion{b, surfaceB_, true}} {
    const auto partsA = witnessesOf(a.mesh()), partsB = witnessesOf(b.mesh());
    questions_[0].enclosing = !a.open() && partsA.size() == 1;
    questions_[1].enclosing = !b.open() && partsB.size() == 1;
    if (!a.hollow()) questions_[0].parts = partsB;
    if (!b.hollow()) questions_[1].parts = partsA;
    questions_[0].all = partsB;
    questions_[1].all = partsA;
    for (NestingQuestion& question : questions_)
        std::erase_if(question.parts, [&](const PartWitnesses& part) { return tooLarge(question, part); });
    const Eigen::AlignedBox3d box = bounds(b.mesh());
    if (box.isEmpty()) return;
    centreB_ = box.center();
    radiusB_ = 0.5 * box.diagonal().norm();
}

NestingCell NestingExaminer::whole() const {
    NestingCell cell{wholeBox(rates_.motion()), {}};
    for (std::uint32_t k = 0; k < 2; ++k)
        for (std::uint32_t p = 0; p < questions_[k].parts.size(); ++p) cell.parts.push_back({k, p, 0});
    return cell;
}

NestingVerdict NestingExaminer::examine(const NestingCell& given) const {
    NestingVerdict result;
    Cell cell = given.cell;
    if (!shrinkToPlanes(rates_.motion(), cell)) return result;
    const CellMotion motion(rates_, cell);
    const Pose inverse = motion.centrePose().inverse();
    std::vector<NestingPart> left;
    for (NestingPart part : given.parts)
        if (!outside(motion, inverse, part, result.probes)) left.push_back(part);
    if (left.empty()) return result;
    std::array<bool, 2> within{}; // per question: all witnesses of some part are inside at the centre pose
    for (const NestingPart& part : left)
        if (!within[part.question]) within[part.question] = inside(motion, inverse, part, result.probes);
    if (within[0] || within[1]) {
        if (cross(motion, inverse, result.probes)) return result;
        if (decidedBySurfaces(motion, within, result)) return result;
    }
    const std::size_t k = widest(motion);
    if (motion.dofs() == 0 || !(cell.upper[k] > cell.lower[k])) { // too small to split
        for (const NestingPart& part : left) result.undecided[part.question] = true;
        return result;
    }
    const auto [lower, upper] = splitCell(rates_, cell, k);
    result.halves = {{lower, left}, {upper, left}};
    return result;
}

bool NestingExaminer::leadsInside(const NestingCell& from, NestingPart part, std::uint64_t seed) const {
    constexpr int mostSteps = 2000, patience = 12;
    const Motion& motion = rates_.motion();
    std::vector<double> q(motion.dofs.size());
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = 0.5 * (from.cell.lower[k] + from.cell.upper[k]);
    if (!withinLimits(motion, q)) return false;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(-1, 1);
    double farthest = sticksOut(part, pose(motion, q), std::numeric_limits<double>::infinity());
    double length = 0.1; // of a step, share of each DOF's range
    for (int step = 0, failed = 0; step < mostSteps && length > 1e-5; ++step) {
        std::vector<double> next = q;
        for (std::size_t k = 0; k < q.size(); ++k) {
            const Dof& dof = motion.dofs[k];
            next[k] =
                std::clamp(q[k] + length * share(random) * (dof.upper - dof.lower), dof.lower, dof.upper);
        }
        const Pose at = pose(motion, next);
        const double out = sticksOut(part, at, farthest);
        if (out < farthest && withinLimits(motion, next)) {
            farthest = out;
            q = std::move(next);
            failed = 0;
            length = std::min(1.0, length * 1.3);
            if (out < -apartShare * reach_ && surfaceA_.apart(surfaceB_, at, apartShare * reach_))
                return true;
        } else if (++failed == patience) {
            failed = 0;
            length *= 0.6;
        }
    }
    return false;
}

double NestingExaminer::sticksOut(NestingPart& part, const Pose& at, double enough) const {
    const NestingQuestion& question = questions_[part.question];
    const PartWitnesses& witnesses = question.parts[part.part];
    const auto count = static_cast<std::uint32_t>(witnesses.size()), first = part.witness;
    const Pose placed = question.outerMoves ? at.inverse() : at;
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < count && farthest < enough; ++i) {
        const std::uint32_t number = (first + i) % count;
        if (witnesses[number].radius > 0) continue;
        const Vec3 place = placed * witnesses[number].centre;
        const double distance = question.outer.boundary().distance(place);
        if (distance <= farthest) continue; // on whichever side
        const double out = question.outer.inside(place) ? -distance : distance;
        if (!(out > farthest)) continue;
        farthest = out;
        part.witness = number;
    }
    return farthest;
}

bool NestingExaminer::tooLarge(const NestingQuestion& question, const PartWitnesses& part) const {
    const double longest = bounds(question.outer.mesh()).diagonal().norm();
    for (const Witness& x : part)
        for (const Witness& y : part)
            if ((x.centre - y.centre).norm() > longest) return true;
    const double radius = part.front().radius;
    return question.enclosing && radius > 0 && !ballFits(question.outer, radius + settledShare * reach_);
}

Vec3 NestingExaminer::placeIn(const NestingQuestion& question, const CellMotion& motion, const Pose& inverse,
                              const Vec3& vertex) const {
    return question.outerMoves ? Vec3(inverse * vertex) : motion.centrePose() * vertex;
}

double NestingExaminer::moveOf(const NestingQuestion& question, const CellMotion& motion,
                               const Vec3& vertex) const {
    if (!question.outerMoves) return motion.pointMotion(motion.centrePose() * vertex).move + rounding_;
    const double whole = moveOfB(motion);
    return motion.relativeMove() < 1
               ? std::min(whole, motion.pointMotion(vertex).move / (1 - motion.relativeMove()) + rounding_)
               : whole;
}

double NestingExaminer::moveOfB(const CellMotion& motion) const {
    return motion.pointMotion(motion.centrePose() * centreB_).move +
           std::min(motion.relativeMove(), 2.0) * radiusB_ + rounding_;
}

bool NestingExaminer::outside(const CellMotion& motion, const Pose& inverse, NestingPart& part,
                              std::uint64_t& probes) const {
    const NestingQuestion& question = questions_[part.question];
    const Solid& outer = question.outer;
    const PartWitnesses& witnesses = question.parts[part.part];
    for (std::uint32_t i = 0; i < witnesses.size(); ++i) {
        const std::uint32_t at = (part.witness + i) % static_cast<std::uint32_t>(witnesses.size());
        const auto& [centre, radius] = witnesses[at];
        if (radius > 0 && !question.enclosing) continue;
        const double move = moveOf(question, motion, centre);
        const Vec3 place = placeIn(question, motion, inverse, centre);
        // To get in, the point would have to cross the boundary, and is near it then; of a closed body
        // the boundary is its surface.
        const double near = radius + settledShare * reach_ - move;
        ++probes;
        bool stays =
            near > 0 && (outer.open() ? question.surface : outer.boundary()).comesWithin(place, near);
        if (!stays && ((near > 0 && !outer.open()) || !outer.boundary().comesWithin(place, move))) {
            probes += probesOfInside;
            stays = !outer.inside(place);
        }
        if (!stays) continue;
        part.witness = at;
        return true;
    }
    return false;
}

bool NestingExaminer::inside(const CellMotion& motion, const Pose& inverse, const NestingPart& part,
                             std::uint64_t& probes) const {
    const NestingQuestion& question = questions_[part.question];
    const PartWitnesses& witnesses = question.parts[part.part];
    return std::all_of(witnesses.begin(), witnesses.end(), [&](const Witness& witness) {
        if (witness.radius > 0) return true; // only vertices are asked
        probes += probesOfInside;
        return question.outer.inside(placeIn(question, motion, inverse, witness.centre));
    });
}

bool NestingExaminer::cross(const CellMotion& motion, const Pose& inverse, std::uint64_t& probes) const {
    return std::any_of(questions_.begin(), questions_.end(), [&](const NestingQuestion& question) {
        if (question.outer.open()) return false; // whose openings may be crossed
        return std::any_of(question.all.begin(), question.all.end(), [&](const PartWitnesses& part) {
            bool in = false, out = false;
            for (const Witness& witness : part) {
                if (witness.radius > 0) continue;
                const Vec3 place = placeIn(question, motion, inverse, witness.centre);
                ++probes;
                if (question.outer.boundary().comesWithin(place, moveOf(question, motion, witness.centre)))
                    continue;
                probes += probesOfInside;
                (question.outer.inside(place) ? in : out) = true;
                if (in && out) return true;
            }
            return false;
        });
    });
}

bool NestingExaminer::decidedBySurfaces(const CellMotion& motion, const std::array<bool, 2>& within,
                                        NestingVerdict& result) const {
    const double move = moveOfB(motion);
    const auto nearer = [&](double distance) {
        return !surfaceA_.apart(surfaceB_, motion.centrePose(), distance, &result.probes);
    };
    if (move < settledShare * reach_ && nearer(settledShare * reach_ - move)) return true;
    // A centre beyond a limit plane stands for the poses of Q next to it only where the cell is small.
    if (!withinLimits(rates_.motion(), motion.centre()) && move > 0.05 * reach_) return false;
    if (nearer(apartShare * reach_)) return false;
    result.inside = within;
    return true;
}

std::size_t NestingExaminer::widest(const CellMotion& motion) const {
    // No bound for the vertices of A before the turns are small.
    if (motion.relativeMove() < 1) return widestDof(motion, centreB_, radiusB_);
    std::size_t most = 0;
    for (std::size_t k = 1; k < motion.dofs(); ++k)
        if (motion.relativeShare(k) > motion.relativeShare(most)) most = k;
    return most;
}

} // namespace tss
