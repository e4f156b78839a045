#include "bake/fill/NestedBodies.h"

#include "bake/base/Parallel.h"
#include "bake/fill/Witnesses.h"
#include "bake/motion/CellTools.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <random>
#include <utility>

namespace tss {

namespace {

/// The search gives up after so many probes. A probe is a distance query of a vertex, a tenth of a
/// microsecond where most vertices are far from the surface, or a look at two triangles.
constexpr std::uint64_t mostProbes = 30'000'000;

/// A query whether a point is inside a solid takes the time of so many probes.
constexpr std::uint64_t probesOfInside = 10;

/// Shares of the reach. Surfaces nearer than `settled` do not count as apart: spheres on them touch, even as
/// protrusionFor() makes them. Surfaces farther than `apart` count as apart. In between either verdict will
/// do, so that small cells can be decided.
constexpr double settled = 0.85, apart = 0.75;

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

/// Whether some part of the inner body's surface ever stands inside the outer body. Asked twice, with each
/// body as the outer one.
struct Question {
    const Solid& outer;
    const MeshQuery& surface; ///< of the outer body, without what closes its openings
    bool outerMoves;          ///< the outer body is B
    bool enclosing = false;   ///< one closed part: what a part inside it encloses is inside it as well
    std::vector<PartWitnesses> parts = {}; ///< of the inner body, those that may fit inside
    std::vector<PartWitnesses> all = {};   ///< of the inner body, all
};

/// A part for which a cell is not yet decided.
struct OpenPart {
    std::uint32_t question, part;
    std::uint32_t witness; ///< the one that was outside in the cell before, tried first
};

struct OpenCell {
    Cell cell;
    std::vector<OpenPart> parts;
};

struct CellResult {
    std::vector<OpenCell> halves;
    std::array<bool, 2> inside{};    ///< per question: a part is inside with the surfaces apart
    std::array<bool, 2> undecided{}; ///< per question: the cell is too small to split
    std::uint64_t probes = 0;
};

/// Decides cells of Q. Used by many threads at once.
class Examiner {
public:
    Examiner(const Solid& a, const Solid& b, const MotionRates& rates, double reach)
        : surfaceA_(a.mesh()), surfaceB_(b.mesh()), rates_(rates), reach_(reach),
          rounding_(coordinateRounding(rates.motion(), surfaceA_.extent(), surfaceB_.extent())),
          questions_{Question{a, surfaceA_, false}, Question{b, surfaceB_, true}} {
        const auto partsA = witnessesOf(a.mesh()), partsB = witnessesOf(b.mesh());
        questions_[0].enclosing = !a.open() && partsA.size() == 1;
        questions_[1].enclosing = !b.open() && partsB.size() == 1;
        if (!a.hollow()) questions_[0].parts = partsB;
        if (!b.hollow()) questions_[1].parts = partsA;
        questions_[0].all = partsB;
        questions_[1].all = partsA;
        for (Question& question : questions_)
            std::erase_if(question.parts,
                          [&](const PartWitnesses& part) { return tooLarge(question, part); });
        const Eigen::AlignedBox3d box = bounds(b.mesh());
        if (box.isEmpty()) return;
        centreB_ = box.center();
        radiusB_ = 0.5 * box.diagonal().norm();
    }

    OpenCell whole() const {
        OpenCell cell{wholeBox(rates_.motion()), {}};
        for (std::uint32_t k = 0; k < 2; ++k)
            for (std::uint32_t p = 0; p < questions_[k].parts.size(); ++p) cell.parts.push_back({k, p, 0});
        return cell;
    }

    CellResult examine(const OpenCell& given) const {
        CellResult result;
        Cell cell = given.cell;
        if (!shrinkToPlanes(rates_.motion(), cell)) return result;
        const CellMotion motion(rates_, cell);
        const Pose inverse = motion.centrePose().inverse();
        std::vector<OpenPart> left;
        for (OpenPart part : given.parts)
            if (!outside(motion, inverse, part, result.probes)) left.push_back(part);
        if (left.empty()) return result;
        std::array<bool, 2>
            within{}; // per question: all witnesses of some part are inside at the centre pose
        for (const OpenPart& part : left)
            if (!within[part.question]) within[part.question] = inside(motion, inverse, part, result.probes);
        if (within[0] || within[1]) {
            if (cross(motion, inverse, result.probes)) return result;
            if (decidedBySurfaces(motion, within, result)) return result;
        }
        const std::size_t k = widest(motion);
        if (motion.dofs() == 0 || !(cell.upper[k] > cell.lower[k])) { // too small to split
            for (const OpenPart& part : left) result.undecided[part.question] = true;
            return result;
        }
        const auto [lower, upper] = splitCell(rates_, cell, k);
        result.halves = {{lower, left}, {upper, left}};
        return result;
    }

    /// Whether random steps from the centre of a cell, each farther in than the one before, lead to a pose at
    /// which the part stands inside with the surfaces apart. Steps become shorter where none leads farther
    /// in.
    bool leadsInside(const OpenCell& from, const OpenPart& part, std::uint64_t seed) const {
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
                if (out < -apart * reach_ && surfaceA_.apart(surfaceB_, at, apart * reach_)) return true;
            } else if (++failed == patience) {
                failed = 0;
                length *= 0.6;
            }
        }
        return false;
    }

private:
    /// The largest signed distance of the part's vertices from the outer body, < 0: all are inside. No more
    /// than the first that is `enough` or more.
    double sticksOut(const OpenPart& part, const Pose& at, double enough) const {
        const Question& question = questions_[part.question];
        const Pose placed = question.outerMoves ? at.inverse() : at;
        double farthest = -std::numeric_limits<double>::infinity();
        for (const Witness& witness : question.parts[part.part]) {
            if (witness.radius > 0) continue;
            const Vec3 place = placed * witness.centre;
            const double distance = question.outer.boundary().distance(place);
            farthest = std::max(farthest, question.outer.inside(place) ? -distance : distance);
            if (farthest >= enough) break;
        }
        return farthest;
    }

    /// Whether the part fits nowhere in the outer body, however it moves: it is longer, or its largest ball
    /// does not fit.
    bool tooLarge(const Question& question, const PartWitnesses& part) const {
        const double longest = bounds(question.outer.mesh()).diagonal().norm();
        for (const Witness& x : part)
            for (const Witness& y : part)
                if ((x.centre - y.centre).norm() > longest) return true;
        const double radius = part.front().radius;
        return question.enclosing && radius > 0 && !ballFits(question.outer, radius + settled * reach_);
    }

    /// A vertex of a part in the frame of the outer body, at the centre of the cell.
    Vec3 placeIn(const Question& question, const CellMotion& motion, const Pose& inverse,
                 const Vec3& vertex) const {
        return question.outerMoves ? Vec3(inverse * vertex) : motion.centrePose() * vertex;
    }

    /// How far a vertex may move against the outer body in the cell (for those of A as in findNearSurface()).
    double moveOf(const Question& question, const CellMotion& motion, const Vec3& vertex) const {
        if (!question.outerMoves) return motion.pointMotion(motion.centrePose() * vertex).move + rounding_;
        const double whole = moveOfB(motion);
        return motion.relativeMove() < 1
                   ? std::min(whole,
                              motion.pointMotion(vertex).move / (1 - motion.relativeMove()) + rounding_)
                   : whole;
    }

    /// How far any point of B may move in the cell: no turn takes points farther apart than twice their
    /// radius.
    double moveOfB(const CellMotion& motion) const {
        return motion.pointMotion(motion.centrePose() * centreB_).move +
               std::min(motion.relativeMove(), 2.0) * radiusB_ + rounding_;
    }

    /// Whether some witness shows that the part is not inside at any pose of the cell: its point stays
    /// outside the outer solid, or its ball reaches through the surface.
    bool outside(const CellMotion& motion, const Pose& inverse, OpenPart& part, std::uint64_t& probes) const {
        const Question& question = questions_[part.question];
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
            const double near = radius + settled * reach_ - move;
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

    /// Whether all witness vertices of the part are inside the outer solid at the cell's centre pose.
    bool inside(const CellMotion& motion, const Pose& inverse, const OpenPart& part,
                std::uint64_t& probes) const {
        const Question& question = questions_[part.question];
        const PartWitnesses& witnesses = question.parts[part.part];
        return std::all_of(witnesses.begin(), witnesses.end(), [&](const Witness& witness) {
            if (witness.radius > 0) return true; // only vertices are asked
            probes += probesOfInside;
            return question.outer.inside(placeIn(question, motion, inverse, witness.centre));
        });
    }

    /// Whether the surfaces are shown to cross at every pose of the cell: a connected part has one point that
    /// stays inside the other solid and one that stays outside.
    bool cross(const CellMotion& motion, const Pose& inverse, std::uint64_t& probes) const {
        return std::any_of(questions_.begin(), questions_.end(), [&](const Question& question) {
            if (question.outer.open()) return false; // whose openings may be crossed
            return std::any_of(question.all.begin(), question.all.end(), [&](const PartWitnesses& part) {
                bool in = false, out = false;
                for (const Witness& witness : part) {
                    if (witness.radius > 0) continue;
                    const Vec3 place = placeIn(question, motion, inverse, witness.centre);
                    ++probes;
                    if (question.outer.boundary().comesWithin(place,
                                                              moveOf(question, motion, witness.centre)))
                        continue;
                    probes += probesOfInside;
                    (question.outer.inside(place) ? in : out) = true;
                    if (in && out) return true;
                }
                return false;
            });
        });
    }

    /// Whether the distance of the surfaces decides the cell: they stay near each other all over it, or they
    /// are apart at its centre pose, where a part is inside.
    bool decidedBySurfaces(const CellMotion& motion, const std::array<bool, 2>& within,
                           CellResult& result) const {
        const double move = moveOfB(motion);
        const auto nearer = [&](double distance) {
            return !surfaceA_.apart(surfaceB_, motion.centrePose(), distance, &result.probes);
        };
        if (move < settled * reach_ && nearer(settled * reach_ - move)) return true;
        // A centre beyond a limit plane stands for the poses of Q next to it only where the cell is small.
        if (!withinLimits(rates_.motion(), motion.centre()) && move > 0.05 * reach_) return false;
        if (nearer(apart * reach_)) return false;
        result.inside = within;
        return true;
    }

    std::size_t widest(const CellMotion& motion) const {
        // No bound for the vertices of A before the turns are small.
        if (motion.relativeMove() < 1) return widestDof(motion, centreB_, radiusB_);
        std::size_t most = 0;
        for (std::size_t k = 1; k < motion.dofs(); ++k)
            if (motion.relativeShare(k) > motion.relativeShare(most)) most = k;
        return most;
    }

    MeshQuery surfaceA_, surfaceB_;
    const MotionRates& rates_;
    double reach_, rounding_;
    std::array<Question, 2> questions_;
    Vec3 centreB_ = Vec3::Zero();
    double radiusB_ = 0;
};

/// A bound of the distance from the surface of points inside a solid, scene units: half of the shortest side
/// of its bounding box; infinity where it has openings.
double deepestIn(const Solid& solid) {
    if (solid.hollow() || solid.mesh().vertices.empty()) return 0;
    return solid.open() ? std::numeric_limits<double>::infinity()
                        : (0.5 + 1e-9) * bounds(solid.mesh()).sizes().minCoeff();
}

/// Tries to answer a question from the cells that the search has left when its effort ended: by random steps
/// from some of them. interrupted: no time is left even for that.
void answerFromLeft(const Examiner& examiner, const std::vector<OpenCell>& cells, std::uint32_t question,
                    bool interrupted, std::array<bool, 2>& found, std::array<bool, 2>& undecided) {
    constexpr std::size_t starts = 64;
    std::vector<std::pair<const OpenCell*, OpenPart>> left;
    for (const OpenCell& cell : cells)
        for (const OpenPart& part : cell.parts)
            if (part.question == question) left.emplace_back(&cell, part);
    if (left.empty()) return;
    undecided[question] = true;
    if (interrupted) return;
    std::array<char, starts> inside{};
    parallelFor(starts, [&](std::size_t k) {
        const auto& [cell, part] = left[k * left.size() / starts];
        inside[k] = examiner.leadsInside(*cell, part, k);
    });
    found[question] = std::find(inside.begin(), inside.end(), 1) != inside.end();
    undecided[question] = !found[question];
}

} // namespace

Nesting findNested(const Solid& a, const Solid& b, const Motion& motion, double reach,
                   const Progress& progress) {
    constexpr std::size_t batch = 64; // of fixed size, so that the outcome does not depend on threads
    const MotionRates rates(motion);
    const Examiner examiner(a, b, rates, reach);
    std::array<bool, 2> found{}, undecided{};
    std::vector<OpenCell> cells{examiner.whole()}, halves;
    std::uint64_t probes = 0;
    bool stopped = false;
    // Breadth first, so that a pose with a part inside is found early.
    for (; !cells.empty() && !stopped; cells = std::exchange(halves, {})) {
        for (std::size_t first = 0; first < cells.size() && !stopped; first += batch) {
            std::vector<CellResult> results(std::min(batch, cells.size() - first));
            parallelFor(results.size(), [&](std::size_t k) {
                OpenCell& cell = cells[first + k];
                std::erase_if(cell.parts, [&](const OpenPart& p) { return found[p.question]; });
                if (!cell.parts.empty()) results[k] = examiner.examine(cell);
            });
            for (CellResult& result : results) {
                probes += result.probes;
                for (std::size_t k = 0; k < 2; ++k) {
                    found[k] = found[k] || result.inside[k];
                    undecided[k] = undecided[k] || result.undecided[k];
                }
                for (OpenCell& half : result.halves) halves.push_back(std::move(half));
            }
            const bool interrupted = !report(progress, "nested bodies", double(probes) / double(mostProbes));
            stopped = interrupted || probes > mostProbes;
            if (!stopped) continue;
            cells.erase(cells.begin(), cells.begin() + (first + results.size()));
            std::move(halves.begin(), halves.end(), std::back_inserter(cells));
            halves.clear();
            for (std::uint32_t question = 0; question < 2; ++question)
                if (!found[question])
                    answerFromLeft(examiner, cells, question, interrupted, found, undecided);
        }
    }
    return {{found[0], found[1]},
            {undecided[0] && !found[0], undecided[1] && !found[1]},
            settled * reach,
            std::max(found[0] ? 0 : deepestIn(a), found[1] ? 0 : deepestIn(b))};
}

} // namespace tss
