#include "bake/verify/BoxProver.h"

#include "bake/base/Infinity.h"

#include <algorithm>
#include <cmath>

namespace tss::verify {

namespace {

/// A bend is infinite across the knots of a path: of nothing it is nothing all the same.
double bent(double of, double bend) {
    return of > 0 ? of * bend : 0;
}

} // namespace

double Apart::tilt(const PoseBox& box) const {
    double sum = 0;
    for (std::size_t k = 0; k < slope.size(); ++k) sum += std::abs(slope[k]) * box.half(k);
    return sum;
}

double Apart::leastSquare(const PoseBox& box) const {
    const double near = std::max(0.0, distance - b->move);
    const double flat = distance * distance - 2 * (tilt(box) + bent(distance, b->bend)) * (1 + 1e-12);
    return std::max(near * near, flat) * (1 - 1e-12);
}

double Apart::largestSquare(const PoseBox& box) const {
    const double far = distance + b->move;
    const double flat = distance * distance + 2 * (tilt(box) + bent(distance, b->bend)) + b->move * b->move;
    return std::min(far * far, flat) * (1 + 1e-12);
}

BoxProver::BoxProver(const Models& models, const Claim& claim)
    : m_(models), claim_(claim), moved_(models.treeB.balls.size()) {
    for (const Test& t : claim.tests)
        if (t.same && t.contactDistance + claim.epsilon >= models.contactDistance(*t.same))
            exact_.insert(*t.same);
    leafOf_.resize(models.b.size());
    for (std::size_t n = 0; n < models.treeB.balls.size(); ++n)
        if (models.treeB.balls[n].first < 0) leafOf_[models.treeB.balls[n].sphere] = n;
    // Smaller boxes than this cannot be told from rounding.
    smallest_ = std::max(1e-10 * models.extent, 1e-13 * models.size);
}

Outcome BoxProver::judge(const Job& job, std::vector<Job>& halves, VerifyResult& broken) {
    if (!meetsPlanes(m_.motion, job.box)) return Outcome::Shown;
    const PoseBox box(m_.motion, job.box, m_.size);
    ++stamp_;
    if (weighTests(box, *job.open)) return Outcome::Shown;
    owed_.clear();
    for (const Owed& o : job.open->pairs) weigh(box, o);
    openBalls(box, job.open->balls);
    std::erase_if(owed_, [&](const Apart& p) { return answered(box, p); });
    if (owed_.empty() && balls_.empty()) return Outcome::Shown;
    if (!owed_.empty() && breaks(box, broken)) return Outcome::Broken;
    double widest = 0;
    for (const Apart& p : owed_) widest = std::max(widest, p.b->move);
    if (balls_.empty() && widest < smallest_) {
        broken.pose = box.middle();
        return Outcome::Undecided;
    }
    split(job, box, halves);
    return Outcome::Split;
}

const BoxProver::Moved& BoxProver::moved(const PoseBox& box, std::size_t ball, bool full) {
    Moved& at = moved_[ball];
    if (at.stamp != stamp_ || (full && !at.full)) {
        static_cast<MovingPoint&>(at) = box.carry(m_.treeB.balls[ball].centre, full);
        at.stamp = stamp_;
        at.full = full;
    }
    return at;
}

Apart BoxProver::apart(const PoseBox& box, const MovingPoint& b, const Vec3& centreA, double contactDistance,
                       SpherePair pair) {
    Apart p{b.at - centreA, 0, contactDistance, &b, pair, {}};
    p.distance = p.y.norm();
    p.slope.resize(box.dofs());
    for (std::size_t k = 0; k < box.dofs(); ++k) p.slope[k] = p.y.dot(b.velocity[k]);
    return p;
}

bool BoxProver::weighTests(const PoseBox& box, const Open& open) {
    near_.clear();
    points_.clear();
    points_.reserve(open.tests.size());
    numbers_.clear();
    for (std::uint32_t k : open.tests) {
        const Test& t = claim_.tests[k];
        points_.push_back(box.carry(t.centreB, true));
        const Apart here = apart(box, points_.back(), t.centreA, t.contactDistance, {});
        const double all = t.contactDistance - claim_.depth + claim_.epsilon;
        if (all >= 0 && here.largestSquare(box) <= all * all) return true;
        const double most = t.contactDistance + claim_.margin + claim_.epsilon;
        if (most < 0 || here.leastSquare(box) > most * most) continue;
        near_.push_back(here);
        numbers_.push_back(k);
    }
    return false;
}

void BoxProver::weigh(const PoseBox& box, const Owed& o) {
    const Moved& b = moved(box, leafOf_[o.pair.b], true);
    const Apart here = apart(box, b, m_.a[o.pair.a].centre, o.contactDistance, o.pair);
    const double limit = o.contactDistance + claim_.margin;
    if (here.leastSquare(box) <= limit * limit) owed_.push_back(here);
}

void BoxProver::openBalls(const PoseBox& box, const std::vector<BallPair>& from) {
    balls_.clear();
    std::vector<BallPair> stack(from);
    while (!stack.empty()) {
        const BallPair pair = stack.back();
        stack.pop_back();
        const auto &x = m_.treeA.balls[static_cast<std::size_t>(pair.a)],
                   &y = m_.treeB.balls[static_cast<std::size_t>(pair.b)];
        if (x.first < 0 && y.first < 0) {
            const SpherePair spheres{x.sphere, y.sphere};
            const double contactDistance = m_.contactDistance(spheres);
            if (contactDistance >= 0 && !exact_.count(spheres)) weigh(box, {spheres, contactDistance});
            continue;
        }
        const Moved& b = moved(box, static_cast<std::size_t>(pair.b), false);
        const double sum = x.radius + y.radius;
        if ((b.at - x.centre).norm() * (1 - 1e-14) - b.move > sum + claim_.margin) continue;
        if (sum < 2 * b.move && b.move > smallest_) {
            balls_.push_back(pair);
        } else if (y.first < 0 || (x.first >= 0 && x.radius > y.radius)) {
            stack.push_back({x.first, pair.b});
            stack.push_back({x.second, pair.b});
        } else {
            stack.push_back({pair.a, y.first});
            stack.push_back({pair.a, y.second});
        }
    }
}

bool BoxProver::answered(const PoseBox& box, const Apart& p) {
    for (std::size_t n = 0; n < near_.size(); ++n) {
        if (!answers(box, near_[n], p)) continue;
        std::swap(near_[0], near_[n]); // neighbours are answered by the same test more often than not
        std::swap(numbers_[0], numbers_[n]);
        return true;
    }
    return false;
}

bool BoxProver::answers(const PoseBox& box, const Apart& k, const Apart& p) const {
    if (claim_.depth == 0 && claim_.margin == 0) {
        const double limit = k.contactDistance + claim_.epsilon;
        double across = 0, along = 0;
        for (std::size_t l = 0; l < box.dofs(); ++l) {
            across += k.slope[l] * p.slope[l] * box.half(l) * box.half(l);
            along += p.slope[l] * p.slope[l] * box.half(l) * box.half(l);
        }
        const double weight = along > 0 ? across / along : 1;
        if (!(limit >= 0) || !(weight > 0) || weight > 10) return false;
        return largest(box, k, p, weight, weight) <=
               limit * limit - weight * p.contactDistance * p.contactDistance;
    }
    const double more = k.contactDistance - p.contactDistance + claim_.epsilon;
    if (p.distance <= 0 || p.distance + more <= 0) return false;
    if (more < 0 && p.distance - p.b->move + more < 0) return false;
    // (|y_p| + more)^2 = |y_p|^2 + 2 more |y_p| + more^2, with |y_p| replaced by its tangent plane from
    // below or its tangent parabola from above, whichever the sign of `more` asks for.
    const double slope = 1 + more / p.distance;
    const double room = (p.distance + more) * (p.distance + more) - k.distance * k.distance;
    return largest(box, k, p, slope, std::min(1.0, slope)) -
               (k.distance * k.distance - slope * p.distance * p.distance) <=
           room;
}

double BoxProver::largest(const PoseBox& box, const Apart& k, const Apart& p, double slope,
                          double curve) const {
    double bound = 0;
    for (std::size_t l = 0; l < box.dofs(); ++l)
        bound += 2 * std::abs(k.slope[l] - slope * p.slope[l]) * box.half(l);
    const double between = (k.b->at - p.b->at).norm();
    const double drift = std::min(between * box.turn(), k.b->move + p.b->move);
    const double quadratic =
        drift * (k.b->move + p.b->move) + std::max(0.0, 1 - curve) * p.b->move * p.b->move;
    bound += std::min(quadratic, k.b->move * k.b->move);
    bound += 2 * bent((k.y - slope * p.y).norm(), p.b->bend) + 2 * bent(k.distance * between, box.turnBend());
    const double centre = k.distance * k.distance - slope * p.distance * p.distance;
    // Rounding of what stands here: a few units of the squares, far below the band that the claim was
    // given.
    const double hair = 0x1p-48 * (k.distance * k.distance + slope * p.distance * p.distance +
                                   m_.size * (k.distance + p.distance) * 0x1p-2);
    return centre + bound * (1 + 1e-12) + hair;
}

bool BoxProver::breaks(const PoseBox& box, VerifyResult& broken) const {
    const auto deepest = std::min_element(owed_.begin(), owed_.end(),
                                          [](const Apart& x, const Apart& y) { return x.gap() < y.gap(); });
    std::vector<double> corner = box.middle(), far = corner;
    const auto nearest = std::min_element(near_.begin(), near_.end(),
                                          [](const Apart& x, const Apart& y) { return x.gap() < y.gap(); });
    for (std::size_t k = 0; k < box.dofs(); ++k) {
        const Dof& dof = m_.motion.dofs[k];
        const auto move = [&](double slope) {
            return std::clamp(box.middle()[k] + (slope > 0 ? -box.half(k) : box.half(k)), dof.lower,
                              dof.upper);
        };
        corner[k] = move(deepest->slope[k]);
        if (nearest != near_.end()) far[k] = move(-nearest->slope[k]);
    }
    return breaksAt(box.middle(), broken) || breaksAt(corner, broken) || breaksAt(far, broken);
}

bool BoxProver::breaksAt(const std::vector<double>& q, VerifyResult& broken) const {
    if (!withinLimits(m_.motion, q)) return false;
    const Pose at = tss::pose(m_.motion, q);
    double models = infinity, table = infinity;
    for (const Apart& p : owed_)
        models =
            std::min(models, (at * m_.b[p.pair.b].centre - m_.a[p.pair.a].centre).norm() - p.contactDistance);
    if (models > claim_.margin) return false;
    for (const Test& t : claim_.tests)
        table = std::min(table, (at * t.centreB - t.centreA).norm() - t.contactDistance);
    if (table <= std::max(models, -claim_.depth) + claim_.epsilon) return false;
    broken.pose = q;
    return true;
}

void BoxProver::split(const Job& job, const PoseBox& box, std::vector<Job>& halves) const {
    auto open = std::make_shared<Open>();
    open->balls = balls_;
    for (const Apart& p : owed_) open->pairs.push_back({p.pair, p.contactDistance});
    open->tests = numbers_;
    std::size_t widest = 0;
    double most = -1;
    // The DOF that may move farthest what moves farthest of what is left.
    Vec3 y =
        balls_.empty() ? Vec3::Zero() : m_.treeB.balls[static_cast<std::size_t>(balls_.front().b)].centre;
    if (balls_.empty()) {
        const auto fastest = std::max_element(
            owed_.begin(), owed_.end(), [](const Apart& p, const Apart& q) { return p.b->move < q.b->move; });
        y = m_.b[fastest->pair.b].centre;
    }
    const MovingPoint point = box.carry(y, false);
    for (std::size_t k = 0; k < box.dofs(); ++k)
        if (point.sweep[k] > most) {
            most = point.sweep[k];
            widest = k;
        }
    if (most <= 0)
        for (std::size_t k = 0; k < box.dofs(); ++k)
            if (box.half(k) > box.half(widest)) widest = k;
    for (Box& half : job.box.halves(widest, box.cut(widest))) halves.push_back({std::move(half), open});
}

} // namespace tss::verify
