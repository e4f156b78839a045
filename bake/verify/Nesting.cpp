#include "bake/verify/Nesting.h"

#include "bake/base/Batches.h"
#include "bake/base/Infinity.h"
#include "bake/geometry/ConnectedParts.h"
#include "bake/verify/TestTree.h"

#include <algorithm>
#include <array>
#include <map>
#include <tbb/enumerable_thread_specific.h>

namespace tss::verify {

namespace {

/// Points of a connected piece of a surface that lie farthest out, in some directions.
using Extremes = std::vector<Vec3>;

std::array<double, 3> placeOf(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

/// The connected pieces of a surface: joined where triangles share the place of a corner.
class Components {
public:
    explicit Components(const TriangleMesh& mesh) {
        std::map<std::array<double, 3>, std::uint32_t> pieceAt;
        for (const TriangleMesh& piece : connectedParts(mesh)) {
            for (const Vec3& v : piece.vertices) pieceAt[placeOf(v)] = std::uint32_t(extremes_.size());
            Extremes& extremes = extremes_.emplace_back();
            for (const std::size_t v : farthestOut(piece)) extremes.push_back(piece.vertices[v]);
        }
        for (const Vec3& v : mesh.vertices) of_.push_back(pieceAt[placeOf(v)]);
    }

    std::uint32_t of(int vertex) const { return of_[std::size_t(vertex)]; }
    const std::vector<Extremes>& extremes() const { return extremes_; }

private:
    std::vector<std::uint32_t> of_;  ///< each vertex
    std::vector<Extremes> extremes_; ///< of each piece
};

/// Where a point is to a body: `outside` changes by no more than the point moves, through what closes the
/// openings of the surface too.
struct Place {
    double outside; ///< the distance from the boundary, fans over openings included; < 0: inside
    double surface; ///< the distance from the surface alone
};

Place placeIn(const VerifiedBody& body, const Vec3& p) {
    const double surface = body.surface.distance(p);
    if (!body.solid || body.solid->hollow()) return {surface, surface};
    const double boundary = std::min(surface, body.solid->boundary().distance(p));
    return {body.solid->inside(p) ? -boundary : boundary, surface};
}

class NestingBox {
public:
    NestingBox(const VerifiedBody& a, const VerifiedBody& b, const Components& ofA, const Components& ofB,
               const Motion& motion, const std::vector<MeshTest>& tests, const TestTree& tree, double early)
        : a_(a), b_(b), ofA_(ofA), ofB_(ofB), motion_(motion), tests_(tests), tree_(tree), early_(early),
          lastA_(ofA.extremes().size()), lastB_(ofB.extremes().size()) {}

    /// No test fires in the box, or nothing is nested.
    bool shown(const PoseBox& box) {
        if (allOutside(box)) return true;
        const std::vector<TestTree::Found> deepest = tree_.deepest(box, 0, 1, work_);
        return deepest.empty() || cross(box, tests_[deepest.front().test]) || near(box);
    }

    /// Tests, and groups of them, that were looked at.
    std::uint64_t work() const { return work_; }

    /// At the pose a test fires, the surfaces are farther apart than they may be, and a component of one body
    /// is in the other as far as its extreme points tell.
    bool brokenAt(const std::vector<double>& q) const {
        if (!withinLimits(motion_, q)) return false;
        const Pose at = tss::pose(motion_, q);
        const Pose back = at.inverse(Eigen::Isometry);
        const auto nested = [&](const Components& inner, const VerifiedBody& outer, const Pose& toOuter) {
            return std::any_of(inner.extremes().begin(), inner.extremes().end(), [&](const Extremes& piece) {
                return std::all_of(piece.begin(), piece.end(), [&](const Vec3& p) {
                    return placeIn(outer, toOuter * p).outside < -early_;
                });
            });
        };
        const auto fires = [&](const MeshTest& t) {
            return (at * t.centreB - t.centreA).norm() <= t.contactDistance;
        };
        return (nested(ofB_, a_, at) || nested(ofA_, b_, back)) &&
               a_.surface.apart(b_.surface, at, early_ * (1 + 1e-6)) &&
               std::any_of(tests_.begin(), tests_.end(), fires);
    }

private:
    /// Where a point is to the other body in the middle of the box, and how far it may move over it.
    struct Side : Place {
        double move;
    };
    Side ofB(const PoseBox& box, const Vec3& p) const {
        const MovingPoint at = box.carry(p, false);
        return {placeIn(a_, at.at), at.move};
    }
    // A point of A moves against B's surface as far as the point of B that is where it is.
    Side ofA(const PoseBox& box, const Vec3& p) const {
        const Vec3 inB = box.pose().inverse(Eigen::Isometry) * p;
        return {placeIn(b_, inB), box.carry(inB, false).move};
    }

    template <typename Probe>
    bool someOutside(const Extremes& extremes, std::size_t& last, Probe&& probe) const {
        for (std::size_t k = 0; k < extremes.size(); ++k) {
            const std::size_t n = (last + k) % extremes.size();
            const Side side = probe(extremes[n]);
            if (side.outside - side.move < -early_) continue;
            last = n;
            return true;
        }
        return false;
    }

    bool allOutside(const PoseBox& box) {
        const auto pointOfA = [&](const Vec3& p) { return ofA(box, p); };
        const auto pointOfB = [&](const Vec3& p) { return ofB(box, p); };
        for (std::size_t c = 0; c < lastB_.size(); ++c)
            if (!someOutside(ofB_.extremes()[c], lastB_[c], pointOfB)) return false;
        for (std::size_t c = 0; c < lastA_.size(); ++c)
            if (!someOutside(ofA_.extremes()[c], lastA_[c], pointOfA)) return false;
        return true;
    }

    /// About the test that is deepest: a component with a point on each side of the other surface all over
    /// the box, or a point that stays as near to it as `early`.
    bool cross(const PoseBox& box, const MeshTest& deepest) const {
        const auto crosses = [&](const VerifiedBody& body, const Components& components, const Vec3& place,
                                 auto&& probe) {
            const int triangle = body.surface.closest(place).triangle;
            for (int k = 0; k < 3 && triangle >= 0; ++k) {
                const int vertex = body.mesh.triangles[std::size_t(triangle)][k];
                const Side in = probe(body.mesh.vertices[std::size_t(vertex)]);
                if (in.surface + in.move <= early_) return true;
                if (in.outside + in.move >= 0) continue;
                for (const Vec3& p : components.extremes()[components.of(vertex)])
                    if (const Side out = probe(p); out.outside - out.move > 0) return true;
            }
            return false;
        };
        return crosses(b_, ofB_, box.pose().inverse(Eigen::Isometry) * deepest.centreA,
                       [&](const Vec3& p) { return ofB(box, p); }) ||
               crosses(a_, ofA_, box.carry(deepest.centreB, false).at,
                       [&](const Vec3& p) { return ofA(box, p); });
    }

    /// The surfaces are so near in the middle that they stay as near as `early`.
    bool near(const PoseBox& box) const {
        double move = 0;
        Eigen::AlignedBox3d bounds = tss::bounds(b_.mesh);
        const double reach = 0.5 * bounds.diagonal().norm();
        move = box.carry(bounds.center(), false).move + box.turn() * reach;
        return move < early_ && a_.surface.distanceTo(b_.surface, box.pose(), early_) + move <= early_;
    }

    const VerifiedBody &a_, &b_;
    const Components &ofA_, &ofB_;
    const Motion& motion_;
    const std::vector<MeshTest>& tests_;
    const TestTree& tree_;
    double early_;
    std::uint64_t work_ = 0;
    std::vector<std::size_t> lastA_, lastB_; ///< which extreme point answered last
};

/// The DOF that may move B the most.
std::size_t widest(const PoseBox& box, const Extremes& points) {
    std::array<double, maxDofs> moves{};
    for (const Vec3& p : points) {
        const MovingPoint at = box.carry(p, false);
        for (std::size_t k = 0; k < box.dofs(); ++k) moves[k] += at.sweep[k];
    }
    return std::size_t(std::max_element(moves.begin(), moves.begin() + box.dofs()) - moves.begin());
}

/// What looking at a box gave.
struct Looked {
    Outcome outcome = Outcome::Shown;
    std::vector<Box> left; ///< Split: its halves
    std::vector<double> pose;
};

Looked lookAt(NestingBox& prover, const Motion& motion, const Box& here, double size, const Extremes& ofB) {
    Looked looked;
    if (!meetsPlanes(motion, here)) return looked;
    const PoseBox box(motion, here, size);
    if (prover.shown(box)) return looked;
    looked.pose = box.middle();
    const double move = box.carry(ofB.front(), false).move;
    looked.outcome = prover.brokenAt(box.middle())                ? Outcome::Broken
                     : move <= 2 * box.error() || box.dofs() == 0 ? Outcome::Undecided
                                                                  : Outcome::Split;
    if (looked.outcome != Outcome::Split) return looked;
    const std::size_t cut = widest(box, ofB);
    for (Box& half : here.halves(cut, box.cut(cut))) looked.left.push_back(std::move(half));
    return looked;
}

/// Whatever is in a solid without openings is no farther from its surface than half of its narrowest extent.
double deepestIn(const VerifiedBody& body) {
    if (!body.solid) return 0;
    return body.solid->open() ? infinity : 0.5 * bounds(body.solid->mesh()).sizes().minCoeff() * (1 + 1e-12);
}

} // namespace

NestingResult proveNoNesting(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion, double size,
                             const std::vector<MeshTest>& tests, double early, const Progress& progress) {
    constexpr std::size_t width = 64;
    constexpr std::uint64_t mostCells = 1'000'000;
    NestingResult result;
    if (std::max(deepestIn(a), deepestIn(b)) <= early) return result;
    const Components ofA(a.mesh), ofB(b.mesh);
    const TestTree tree(tests);
    tbb::enumerable_thread_specific<NestingBox> provers(
        [&] { return NestingBox(a, b, ofA, ofB, motion, tests, tree, early); });
    std::vector<Box> boxes{limitsOf(motion)};
    while (!boxes.empty()) {
        if (!report(progress, "verify", 1) || result.cells > mostCells) {
            result.reason = result.cells > mostCells ? "not proven within the effort granted: nothing nested"
                                                     : "stopped before everything was shown";
            return result;
        }
        const auto parts = runLast(boxes, width, [&](const Box& box, std::size_t) {
            return lookAt(provers.local(), motion, box, size, ofB.extremes().front());
        });
        result.work = 0;
        for (const NestingBox& prover : provers) result.work += prover.work();
        result.cells += parts.size();
        for (const Looked& part : parts) {
            if (part.outcome == Outcome::Shown || part.outcome == Outcome::Split) continue;
            result.pose = part.pose;
            result.reason = part.outcome == Outcome::Broken
                                ? "at a pose it reports contact though one body is inside the other and "
                                  "the surfaces are farther apart than the stored bound"
                                : "near a pose it cannot be told whether one body is inside the other";
            return result;
        }
    }
    return result;
}

} // namespace tss::verify
