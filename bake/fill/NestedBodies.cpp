#include "bake/fill/NestedBodies.h"

#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"
#include "bake/geometry/Import.h"
#include "bake/motion/CellTools.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace tss {

namespace {

/// Looks at a vertex before it is given up: a tenth of a microsecond each where most are far from the surface,
/// as over many DOFs, where so many are needed.
constexpr std::uint64_t mostProbes = 6'000'000;

/// Shares of the reach: surfaces nearer than the first are near enough for spheres to touch, as far as their
/// protrusion may fall short of the tolerance (protrusionFor()); farther than the second they are apart. The
/// room between lets small cells be settled.
constexpr double settled = 0.85, apart = 0.75;

/// Some vertices of one connected part of a surface: those farthest out in 26 directions.
using Part = std::vector<Vec3>;

Part extremes(const TriangleMesh& mesh, const std::vector<int>& vertices) {
    std::vector<int> found;
    for (int way = 0; way < 27; ++way) {
        const Vec3 out(way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1);
        if (way == 13) continue; // no direction
        found.push_back(*std::max_element(vertices.begin(), vertices.end(), [&](int x, int y) {
            return mesh.vertices[x].dot(out) < mesh.vertices[y].dot(out);
        }));
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    Part part;
    for (const int v : found) part.push_back(mesh.vertices[v]);
    return part;
}

/// The connected parts of a surface; what stands at the same place is connected.
std::vector<Part> partsOf(const TriangleMesh& loaded) {
    const TriangleMesh mesh = welded(loaded);
    UnionFind together(mesh.vertices.size());
    for (const Tri& t : mesh.triangles)
        for (const int v : {t[1], t[2]}) together.join(t[0], v);
    std::vector<std::vector<int>> members(mesh.vertices.size());
    std::vector<char> listed(mesh.vertices.size(), 0);
    for (const Tri& t : mesh.triangles)
        for (const int v : t)
            if (!std::exchange(listed[v], 1)) members[together.root(v)].push_back(v);
    std::vector<Part> parts;
    for (const std::vector<int>& part : members)
        if (!part.empty()) parts.push_back(extremes(mesh, part));
    return parts;
}

/// Does some part of the inner body's surface stand inside the outer body?
struct Question {
    const Solid& outer;
    const MeshQuery& surface; ///< of the outer body, without what closes its openings
    bool outerMoves;          ///< the outer body is B
    std::vector<Part> parts = {};
};

/// A part that may be inside, and the vertex of it that was outside nearby.
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
        if (!a.hollow()) questions_[0].parts = partsOf(b.mesh());
        if (!b.hollow()) questions_[1].parts = partsOf(a.mesh());
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
        if ((deep[0] || deep[1]) && judgeSurfaces(motion, deep, result)) return result;
        const std::size_t k = widest(motion);
        if (motion.dofs() == 0 || !(cell.upper[k] > cell.lower[k])) { // nothing left to cut
            for (const OpenPart& part : left) result.stuck[part.question] = true;
            return result;
        }
        const auto [lower, upper] = splitCell(rates_, cell, k);
        result.halves = {{lower, left}, {upper, left}};
        return result;
    }

private:
    /// A vertex of a part in the frame of the outer body, at the centre of the cell.
    Vec3 placeIn(const Question& question, const CellMotion& motion, const Pose& inverse,
                 const Vec3& vertex) const {
        return question.outerMoves ? Vec3(inverse * vertex) : motion.centrePose() * vertex;
    }

    /// How far a vertex may move against the outer body in the cell (for those of A as in findNearSurface()).
    double moveOf(const Question& question, const CellMotion& motion, const Vec3& vertex) const {
        if (!question.outerMoves) return motion.pointMotion(motion.centrePose() * vertex).move + rounding_;
        return motion.relativeMove() < 1
                   ? motion.pointMotion(vertex).move / (1 - motion.relativeMove()) + rounding_
                   : std::numeric_limits<double>::infinity();
    }

    /// Some vertex of the part stays outside the outer solid, or near its surface, all over the cell; then it
    /// is the part's witness.
    bool outside(const CellMotion& motion, const Pose& inverse, OpenPart& part, std::uint64_t& probes) const {
        const Question& question = questions_[part.question];
        const Solid& outer = question.outer;
        const Part& vertices = question.parts[part.part];
        for (std::uint32_t i = 0; i < vertices.size(); ++i) {
            const std::uint32_t at = (part.witness + i) % static_cast<std::uint32_t>(vertices.size());
            const double move = moveOf(question, motion, vertices[at]);
            const Vec3 place = placeIn(question, motion, inverse, vertices[at]);
            // To get in it would have to cross the boundary, which is near it then, and is surface where
            // there are no openings.
            const double near = settled * reach_ - move;
            ++probes;
            bool stays =
                near > 0 && (outer.open() ? question.surface : outer.boundary()).comesWithin(place, near);
            if (!stays && ((near > 0 && !outer.open()) || !outer.boundary().comesWithin(place, move)))
                stays = !outer.inside(place);
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
        const Part& vertices = question.parts[part.part];
        return std::all_of(vertices.begin(), vertices.end(), [&](const Vec3& vertex) {
            ++probes;
            return question.outer.inside(placeIn(question, motion, inverse, vertex));
        });
    }

    /// True: the cell is settled, since the surfaces are near each other all over it, or since they are apart
    /// at its centre and a part is inside there.
    bool judgeSurfaces(const CellMotion& motion, const std::array<bool, 2>& deep, CellResult& result) const {
        const double move = motion.pointMotion(motion.centrePose() * centreB_).move +
                            motion.relativeMove() * radiusB_ + rounding_;
        const auto nearer = [&](double distance) {
            return !surfaceA_.apart(surfaceB_, motion.centrePose(), distance);
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
            stopped = probes > mostProbes ||
                      !report(progress, "nested bodies", double(probes) / double(mostProbes));
            if (!stopped) continue;
            cells.erase(cells.begin(), cells.begin() + (first + results.size()));
            for (const std::vector<OpenCell>* left : {&cells, &halves})
                for (const OpenCell& cell : *left)
                    for (const OpenPart& part : cell.parts) undecided[part.question] = true;
        }
    }
    return {{found[0], found[1]},
            {undecided[0] && !found[0], undecided[1] && !found[1]},
            settled * reach,
            std::max(found[0] ? 0 : deepestIn(a), found[1] ? 0 : deepestIn(b))};
}

} // namespace tss
