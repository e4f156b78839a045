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

/// Looks at a vertex before it is given up: a tenth of a microsecond each where most are far from the
/// surface, as over many DOFs, where so many are needed. A look at two triangles counts as one.
constexpr std::uint64_t mostProbes = 30'000'000;

/// As many take the time in which a point is asked whether it is inside a solid.
constexpr std::uint64_t probesOfInside = 10;

/// Shares of the reach: surfaces nearer than the first are near enough for spheres to touch, as far as their
/// protrusion may fall short of the tolerance (protrusionFor()); farther than the second they are apart. The
/// room between lets small cells be settled.
constexpr double settled = 0.85, apart = 0.75;

/// False: no ball of that radius, scene units, is inside the solid.
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

/// Does some part of the inner body's surface stand inside the outer body?
struct Question {
    const Solid& outer;
    const MeshQuery& surface; ///< of the outer body, without what closes its openings
    bool outerMoves;          ///< the outer body is B
    bool enclosing = false;   ///< one closed part: what a part inside it encloses is inside it as well
    std::vector<PartWitnesses> parts = {}; ///< that may stand inside
    std::vector<PartWitnesses> all = {};
};

/// A part that may be inside, and the witness of it that was outside nearby.
struct OpenPart {
    std::uint32_t question, part, witness;
};

struct OpenCell {
    Cell cell;
    std::vector<OpenPart> parts;
};

struct CellResult {
    std::vector<OpenCell> halves;
    std::array<bool, 2> inside{}, stuck{};
    std::uint64_t probes = 0;
};

/// Looks at cells; asked by many threads at once.
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
        std::array<bool, 2> deep{}; // some part is inside at the centre, as far as its vertices tell
        for (const OpenPart& part : left)
            if (!deep[part.question]) deep[part.question] = inside(motion, inverse, part, result.probes);
        if (deep[0] || deep[1]) {
            if (cross(motion, inverse, result.probes)) return result;
            if (judgeSurfaces(motion, deep, result)) return result;
        }
        const std::size_t k = widest(motion);
        if (motion.dofs() == 0 || !(cell.upper[k] > cell.lower[k])) { // nothing left to cut
            for (const OpenPart& part : left) result.stuck[part.question] = true;
            return result;
        }
        const auto [lower, upper] = splitCell(rates_, cell, k);
        result.halves = {{lower, left}, {upper, left}};
        return result;
    }

    /// Whether a part comes to stand inside, surfaces apart, where it is led from the centre of a cell by
    /// random steps, shorter where none leads farther in.
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
    /// How far out of the outer body the part's vertices are, at least `enough` where one is; < 0: all
    /// inside.
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

    /// However it moves: its largest ball fits nowhere in the outer body, or it is longer than that.
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

    /// Some witness of the part stays outside the outer solid, or nearer to its surface than its ball is
    /// large, all over the cell.
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
            // To get in it would have to cross the boundary, which is near it then, and is surface where
            // there are no openings.
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

    /// No vertex of the part is outside the outer solid at the centre of the cell.
    bool inside(const CellMotion& motion, const Pose& inverse, const OpenPart& part,
                std::uint64_t& probes) const {
        const Question& question = questions_[part.question];
        const PartWitnesses& witnesses = question.parts[part.part];
        return std::all_of(witnesses.begin(), witnesses.end(), [&](const Witness& witness) {
            if (witness.radius > 0) return true; // its vertices tell
            probes += probesOfInside;
            return question.outer.inside(placeIn(question, motion, inverse, witness.centre));
        });
    }

    /// The surfaces cross all over the cell: a connected part has a point that stays inside the other solid
    /// and one that stays outside.
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

    /// True: the cell is settled, since the surfaces are near each other all over it, or since they are apart
    /// at its centre and a part is inside there.
    bool judgeSurfaces(const CellMotion& motion, const std::array<bool, 2>& deep, CellResult& result) const {
        const double move = moveOfB(motion);
        const auto nearer = [&](double distance) {
            return !surfaceA_.apart(surfaceB_, motion.centrePose(), distance, &result.probes);
        };
        if (move < settled * reach_ && nearer(settled * reach_ - move)) return true;
        // Where the centre lies beyond a plane, a pose of Q is near enough once the cell is small.
        if (!withinLimits(rates_.motion(), motion.centre()) && move > 0.05 * reach_) return false;
        if (nearer(apart * reach_)) return false;
        result.inside = deep;
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

/// Nothing in a closed solid is farther from its surface than half its box is wide where it is narrowest.
double deepestIn(const Solid& solid) {
    if (solid.hollow() || solid.mesh().vertices.empty()) return 0;
    return solid.open() ? std::numeric_limits<double>::infinity()
                        : (0.5 + 1e-9) * bounds(solid.mesh()).sizes().minCoeff();
}

/// What is to be said of a question that cells may be left of; `asked`: to stop.
void judgeLeft(const Examiner& examiner, const std::vector<OpenCell>& cells, std::uint32_t question,
               bool asked, std::array<bool, 2>& found, std::array<bool, 2>& undecided) {
    constexpr std::size_t starts = 64;
    std::vector<std::pair<const OpenCell*, OpenPart>> left;
    for (const OpenCell& cell : cells)
        for (const OpenPart& part : cell.parts)
            if (part.question == question) left.emplace_back(&cell, part);
    if (left.empty()) return;
    undecided[question] = true;
    if (asked) return;
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
    // Breadth first: a pose that shows it comes early.
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
                    undecided[k] = undecided[k] || result.stuck[k];
                }
                for (OpenCell& half : result.halves) halves.push_back(std::move(half));
            }
            const bool asked = !report(progress, "nested bodies", double(probes) / double(mostProbes));
            stopped = asked || probes > mostProbes;
            if (!stopped) continue;
            cells.erase(cells.begin(), cells.begin() + (first + results.size()));
            std::move(halves.begin(), halves.end(), std::back_inserter(cells));
            halves.clear();
            for (std::uint32_t question = 0; question < 2; ++question)
                if (!found[question]) judgeLeft(examiner, cells, question, asked, found, undecided);
        }
    }
    return {{found[0], found[1]},
            {undecided[0] && !found[0], undecided[1] && !found[1]},
            settled * reach,
            std::max(found[0] ? 0 : deepestIn(a), found[1] ? 0 : deepestIn(b))};
}

} // namespace tss
