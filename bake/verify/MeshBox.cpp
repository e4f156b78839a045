#include "bake/verify/MeshBox.h"

#include "bake/base/Infinity.h"
#include "bake/geometry/TriangleDistance.h"
#include "bake/verify/SeparatingAxis.h"

#include <cmath>
#include <optional>

namespace tss::verify {

namespace {

/// Pairs that a box keeps open at most before it is halved with the rest as it is.
constexpr std::size_t mostOpen = 3000;
/// Tests that are weighed over a box, the deepest at its middle, and that are tried on a pair, those that
/// answered for others first. In small boxes, where few are left, all of them.
constexpr std::size_t mostWeighed = 32, mostTried = 8;
constexpr double smallBox = 1e-3; ///< of the largest reach

} // namespace

MeshBox::MeshBox(const SurfaceTree& a, const SurfaceTree& b, const Motion& motion, double size,
                 const MeshClaim& claim, const TestTree& tests)
    : a_(a), b_(b), motion_(motion), claim_(claim), tests_(tests), size_(size), shapesA_(a), shapesB_(b),
      moved_(b.nodes.size()) {
    // Smaller boxes than this cannot be told from rounding.
    smallest_ = 1e-3 * claim.band;
    for (const MeshTest& test : claim.tests)
        largestContact_ = std::max(largestContact_, test.contactDistance);
}

const MeshBox::Moved& MeshBox::moved(std::int32_t node) {
    Moved& at = moved_[static_cast<std::size_t>(node)];
    if (at.stamp != stamp_) {
        static_cast<MovingPoint&>(at) =
            box_->carry(b_.nodes[static_cast<std::size_t>(node)].slab.centre, true);
        at.stamp = stamp_;
    }
    return at;
}

/// Over the box: `near` of a test, if it may fire. True: it does, all over it.
bool MeshBox::weighTest(std::uint32_t test) {
    const double limit = claim_.miss + 0.5 * claim_.band;
    const MeshTest& t = claim_.tests[test];
    const MovingPoint b = box_->carry(t.centreB, true);
    const Vec3 arm = b.at - t.centreA;
    const double distance = arm.norm();
    Near near;
    near.test = test;
    near.gap = distance - t.contactDistance;
    near.normal = distance > 0 ? Vec3(arm / distance) : Vec3::UnitX();
    double tilt = 0, across = b.bend;
    for (std::size_t l = 0; l < box_->dofs(); ++l) {
        near.slope[l] = near.normal.dot(b.velocity[l]);
        tilt += std::abs(near.slope[l]) * box_->half(l);
        across += (b.velocity[l] - near.slope[l] * near.normal).norm() * box_->half(l);
    }
    tilt *= 1 + 1e-14;
    across = std::min(across, b.move) + 1e-15 * b.move;
    if (near.gap - std::min(b.move, tilt + b.bend) > limit) return false;
    // |y + m| <= |y| + n . m + |m across n|^2 / 2 (|y| + n . m)
    const double least = distance - std::min(tilt + b.bend, b.move);
    near.rest = least > 0 ? b.bend + across * across / (2 * least) : infinity;
    if (near.gap + std::min(b.move, tilt + near.rest) <= limit) return true;
    if (!(near.rest <= 2 * b.move)) { // no better than the plain bound: without slopes
        near.rest = b.move;
        near.slope.fill(0);
    }
    near_.push_back(near);
    return false;
}

// What of the tests can fire in the box, the deepest at its middle first. True: one of them does, all over
// it.
bool MeshBox::weighTests() {
    near_.clear();
    const Slab& whole = b_.nodes[static_cast<std::size_t>(b_.root())].slab;
    const bool small =
        box_->carry(whole.centre, false).move + box_->turn() * whole.reach < smallBox * largestContact_;
    const std::size_t most = small ? claim_.tests.size() : mostWeighed;
    return std::ranges::any_of(tests_.deepest(*box_, claim_.miss + 0.5 * claim_.band, most, work_),
                               [&](const TestTree::Found& found) { return weighTest(found.test); });
}

bool MeshBox::apart(const Shape& shapeA, const Shape& shapeB, const MovingPoint& at) const {
    const Slab &a = shapeA.slab, &b = shapeB.slab;
    const Vec3 between = at.at - a.centre;
    const double distance = between.norm();
    if (distance * (1 - 1e-15) - at.move > a.reach + b.reach + claim_.near) return true;
    const Eigen::Matrix3d turned = box_->pose().linear();
    const auto separates = [&](Vec3 normal) { // of length 1
        double along = normal.dot(between), tilt = at.bend;
        if (along < 0) {
            along = -along;
            normal = -normal;
        }
        for (std::size_t l = 0; l < box_->dofs(); ++l)
            tilt += std::abs(normal.dot(at.velocity[l])) * box_->half(l);
        tilt = std::min(tilt, at.move);
        const Vec3 inB = turned.transpose() * normal;
        const double wide =
            shapeA.support(normal) + std::min(b.reach, shapeB.support(-inB) + box_->turn() * b.reach);
        const double rounding = 1e-14 * (tilt + a.reach + b.reach + claim_.near) + 0.1 * claim_.band;
        return along * (1 - 1e-14) > tilt + wide + claim_.near + rounding;
    };
    if ((distance > 0 && separates(between / distance)) || separates(a.axis) || separates(turned * b.axis))
        return true;
    if (!shapeA.corners || !shapeB.corners) return false;
    // Two triangles in nearly one plane: past each other's edges.
    const auto pastEdges = [&](const Corners& corners, const Vec3& axis, const auto& seen) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 normal = axis.cross(corners[(k + 1) % 3] - corners[k]);
            const double length = normal.norm();
            if (length > 0 && separates(seen(normal / length))) return true;
        }
        return false;
    };
    if (pastEdges(*shapeA.corners, a.axis, [](const Vec3& n) { return n; }) ||
        pastEdges(*shapeB.corners, b.axis, [&](const Vec3& n) { return Vec3(turned * n); }))
        return true;
    // Where the box is small beside them, what separates them in its middle does so all over it.
    if (!(a.reach + b.reach > 8 * at.move)) return false;
    Corners placed = *shapeB.corners;
    for (Vec3& corner : placed) corner = at.at + turned * (corner - b.centre);
    const Vec3 axis = separatingAxis(*shapeA.corners, placed);
    return !axis.isZero() && separates(axis);
}

// The test's gap at every pose of the box where the two pieces come as near as the claim says, T(q) y = x +
// e: gap + lambda . (T(q) y - x - e), for any lambda.
double MeshBox::bound(const Near& test, const Vec3& lambda, const Shape& a, const Shape& b,
                      const MovingPoint& at, double& patches) const {
    const double length = lambda.norm(), reachB = b.slab.reach;
    const Vec3 inB = box_->pose().linear().transpose() * lambda;
    patches = a.support(-lambda) +
              std::min(length * reachB, b.support(inB) + length * box_->turn() * reachB) +
              length * claim_.near;
    double motion = test.rest + length * at.bend;
    for (std::size_t l = 0; l < box_->dofs(); ++l)
        motion += std::abs(test.slope[l] + lambda.dot(at.velocity[l])) * box_->half(l);
    const double rounding = 1e-13 * (motion + length * (a.slab.reach + reachB + claim_.near));
    return test.gap + lambda.dot(at.at - a.slab.centre) + patches + motion + rounding;
}

// The matrix whose inverse times the negative slopes of a test is the lambda for which bound() is about
// least: by how much the joint, the pieces and the bend move T(q) y - x along each direction, squared and
// summed.
Eigen::Matrix3d MeshBox::spread(const Shape& a, const Shape& b, const MovingPoint& at) const {
    Eigen::Matrix3d sum =
        Eigen::Matrix3d::Identity() * (at.bend * at.bend + 1e-4 * scale_ * scale_ + 1e-300); // never singular
    for (std::size_t l = 0; l < box_->dofs(); ++l) {
        const Vec3 v = at.velocity[l] * box_->half(l);
        sum += v * v.transpose();
    }
    const auto add = [&](const Slab& s, const Vec3& axis) {
        sum += s.radius * s.radius * Eigen::Matrix3d::Identity() +
               (s.half * s.half - s.radius * s.radius) * axis * axis.transpose();
    };
    add(a.slab, a.slab.axis);
    add(b.slab, box_->pose().linear() * b.slab.axis);
    return sum;
}

bool MeshBox::answered(const Shape& a, const Shape& b, const MovingPoint& at, Verdict& blur) {
    const double limit = claim_.miss + 0.5 * claim_.band;
    double best = infinity;
    const auto within = [&](const Near& test, const Vec3& lambda) {
        double patches = 0;
        const double gap = bound(test, lambda, a, b, at, patches);
        if (gap < best) {
            best = gap;
            blur = patches > 0.5 * (gap - test.gap - lambda.dot(at.at - a.slab.centre)) ? Verdict::SplitPair
                                                                                        : Verdict::SplitBox;
        }
        return gap <= limit;
    };
    std::optional<Eigen::Matrix3d> inverse; // of spread(), once it is needed
    const auto answers = [&](const Near& test) {
        const MeshTest& t = claim_.tests[test.test];
        if (a.slab.farthest(t.centreA) + b.slab.farthest(t.centreB) + claim_.near <=
            t.contactDistance + limit)
            return true;
        if (!std::isfinite(at.bend)) return false;
        if (within(test, -test.normal)) return true;
        if (!inverse) inverse = spread(a, b, at).inverse();
        Vec3 slopes = Vec3::Zero();
        for (std::size_t l = 0; l < box_->dofs(); ++l)
            slopes -= at.velocity[l] * (test.slope[l] * box_->half(l) * box_->half(l));
        return within(test, *inverse * slopes);
    };
    const auto tried =
        near_.begin() +
        (at.move < smallBox * largestContact_ ? near_.size() : std::min(mostTried, near_.size()));
    const auto found = std::find_if(near_.begin(), tried, answers);
    if (found == tried) return false;
    // Neighbours are answered by the same test more often than not.
    std::rotate(near_.begin(), found, found + 1);
    return true;
}

MeshBox::Verdict MeshBox::weigh(const PiecePair& pair) {
    ++work_;
    const SurfaceTree::Node &nodeA = a_.nodes[static_cast<std::size_t>(pair.a.node)],
                            &nodeB = b_.nodes[static_cast<std::size_t>(pair.b.node)];
    if (nodeA.exempt && nodeB.exempt) return Verdict::Done;
    const Shape a = shapesA_.of(pair.a), b = shapesB_.of(pair.b);
    MovingPoint at = moved(pair.b.node);
    if (pair.b.cuts != 1) {
        const Vec3 arm = box_->pose().linear() * (b.slab.centre - nodeB.slab.centre);
        const double length = arm.norm() * (1 + 1e-14);
        at.at += arm;
        at.move += box_->turn() * length;
        if (length > 0) at.bend += box_->turnBend() * length; // may be infinite
        for (std::size_t l = 0; l < box_->dofs(); ++l) at.velocity[l] += box_->spin(l).cross(arm);
    }
    if (apart(a, b, at)) return Verdict::Done;
    scale_ = a.slab.reach + b.slab.reach;
    const bool divides = divisible(a_, pair.a) || divisible(b_, pair.b);
    // Far larger than what the box moves: smaller pieces first. Whole triangles may be answered as they are.
    const bool triangles = a.corners && b.corners && pair.a.cuts == 1 && pair.b.cuts == 1;
    if (divides && !triangles && scale_ > 8 * at.move && scale_ > smallest_) return Verdict::SplitPair;
    Verdict blur = scale_ > 2 * at.move ? Verdict::SplitPair : Verdict::SplitBox;
    if (scale_ < 2 * largestContact_ && answered(a, b, at, blur)) return Verdict::Done;
    if (scale_ > 2 * at.move) blur = Verdict::SplitPair;
    if (!divides || scale_ < smallest_) blur = Verdict::SplitBox;
    return blur;
}

void MeshBox::halve(const PiecePair& pair, std::vector<PiecePair>& stack) {
    const double sizeA = shapesA_.of(pair.a).slab.reach, sizeB = shapesB_.of(pair.b).slab.reach;
    const bool cutA = divisible(a_, pair.a) && (sizeA >= sizeB || !divisible(b_, pair.b));
    for (std::uint32_t side = 0; side < 2; ++side)
        stack.push_back(cutA ? PiecePair{half(a_, pair.a, side), pair.b}
                             : PiecePair{pair.a, half(b_, pair.b, side)});
}

// The DOF that may move the pieces left the most: by its bound, for across a knot of a path the rate at the
// middle says little about the steepest part.
void MeshBox::chooseCut(const std::vector<PiecePair>& left, std::size_t& cut) {
    std::array<double, maxDofs> moves{};
    const std::size_t step = 1 + left.size() / 16;
    for (std::size_t k = 0; k < left.size(); k += step) {
        const MovingPoint at = box_->carry(shapesB_.of(left[k].b).slab.centre, false);
        for (std::size_t l = 0; l < box_->dofs(); ++l) moves[l] += at.sweep[l];
    }
    cut = 0;
    for (std::size_t l = 1; l < box_->dofs(); ++l)
        if (moves[l] > moves[cut]) cut = l;
    if (moves[cut] > 0) return;
    for (std::size_t l = 1; l < box_->dofs(); ++l)
        if (box_->half(l) > box_->half(cut)) cut = l;
}

bool MeshBox::unanswered(const std::vector<double>& q, const std::vector<PiecePair>& pairs, double near,
                         MeshProofResult& broken) {
    if (!withinLimits(motion_, q)) return false;
    const Pose at = tss::pose(motion_, q);
    const double least = tests_.leastGap(at, claim_.miss + claim_.band, work_);
    if (least <= claim_.miss + claim_.band || !anyWithin(near, at, pairs)) return false;
    broken.pose = q;
    return true;
}

bool MeshBox::anyWithin(double near, const Pose& at, std::vector<PiecePair> stack) {
    const auto beyond = [&](const Piece& a, const Piece& b) { // whole triangles or parts of them
        Corners moved = *shapesB_.of(b).corners;
        for (Vec3& corner : moved) corner = at * corner;
        const Corners fixed = *shapesA_.of(a).corners;
        return surelyBeyond(fixed, moved, near * near) ||
               squaredDistanceOfTriangles(fixed, moved) > near * near;
    };
    // Pieces of the same two triangles mostly follow each other: the whole ones tell of them all.
    Piece wholeA{-1, 1}, wholeB{-1, 1};
    bool wholeBeyond = false;
    while (!stack.empty()) {
        const PiecePair pair = stack.back();
        stack.pop_back();
        ++work_;
        const SurfaceTree::Node &nodeA = a_.nodes[static_cast<std::size_t>(pair.a.node)],
                                &nodeB = b_.nodes[static_cast<std::size_t>(pair.b.node)];
        if (nodeA.exempt && nodeB.exempt) continue;
        const bool leafA = nodeA.first < 0, leafB = nodeB.first < 0;
        if (leafA && leafB) {
            if (pair.a.node != wholeA.node || pair.b.node != wholeB.node) {
                wholeA.node = pair.a.node;
                wholeB.node = pair.b.node;
                wholeBeyond = beyond(wholeA, wholeB);
            }
            const bool whole = pair.a.cuts + pair.b.cuts == 2;
            if (!wholeBeyond && (whole || !beyond(pair.a, pair.b))) return true;
            continue;
        }
        const Slab a = shapesA_.of(pair.a).slab, b = shapesB_.of(pair.b).slab;
        const Vec3 between = at * b.centre - a.centre;
        if (between.norm() > a.reach + b.reach + near) continue;
        const auto separates = [&](const Vec3& normal) {
            const Vec3 inB = at.linear().transpose() * normal;
            return std::abs(normal.dot(between)) > a.support(normal) + b.support(inB) + near;
        };
        if (separates(a.axis) || separates(at.linear() * b.axis)) continue;
        const bool cutA = !leafA && (leafB || a.reach >= b.reach);
        for (std::uint32_t side = 0; side < 2; ++side)
            stack.push_back(cutA ? PiecePair{half(a_, pair.a, side), pair.b}
                                 : PiecePair{pair.a, half(b_, pair.b, side)});
    }
    return false;
}

Outcome MeshBox::judge(const Box& dofs, const std::vector<PiecePair>& open, std::vector<PiecePair>& left,
                       std::size_t& cut, double& at, MeshProofResult& broken) {
    if (!meetsPlanes(motion_, dofs)) return Outcome::Shown;
    const PoseBox box(motion_, dofs, size_);
    box_ = &box;
    ++stamp_;
    ++work_;
    if (weighTests()) return Outcome::Shown;
    left.clear();
    stack_ = open;
    while (!stack_.empty()) {
        if (left.size() >= mostOpen) {
            left.insert(left.end(), stack_.begin(), stack_.end());
            break;
        }
        const PiecePair pair = stack_.back();
        stack_.pop_back();
        const Verdict verdict = weigh(pair);
        if (verdict == Verdict::SplitBox) left.push_back(pair);
        if (verdict == Verdict::SplitPair) halve(pair, stack_);
    }
    if (left.empty()) return Outcome::Shown;
    // What rounding hides at the middle no smaller box would show.
    if (unanswered(box.middle(), left, claim_.near + claim_.band, broken))
        return breaksAt(box.middle(), left, broken) ? Outcome::Broken : Outcome::Undecided;
    double widest = 0;
    for (const PiecePair& pair : left) widest = std::max(widest, moved(pair.b.node).move);
    if (widest <= box.error() + smallest_) {
        broken.pose = box.middle();
        return Outcome::Undecided;
    }
    chooseCut(left, cut);
    at = box.cut(cut);
    return Outcome::Split;
}

} // namespace tss::verify
