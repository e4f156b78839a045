#include "bake/verify/Models.h"

#include "bake/base/Order.h"
#include "bake/verify/MeshProof.h"

#include <algorithm>
#include <limits>

namespace tss::verify {

namespace {

/// The sphere of the set that is this one to the bit, or the one that it sticks out of least, and by how
/// much.
struct Match {
    std::uint32_t index = 0;
    bool same = false;
    double out = std::numeric_limits<double>::infinity();
};

Match matchSphere(const Sphere& sphere, const SphereSet& set) {
    Match best;
    for (std::uint32_t i = 0; i < set.size(); ++i) {
        if (set[i].centre == sphere.centre && set[i].radius == sphere.radius) return {i, true, 0};
        const double out = (set[i].centre - sphere.centre).norm() + sphere.radius - set[i].radius;
        if (out < best.out) best = {i, false, out};
    }
    return best;
}

bool sameDof(const Dof& x, const Dof& y) {
    if (x.kind != y.kind) return false;
    if (x.kind == DofKind::Rotation) return x.axis == y.axis && x.origin == y.origin;
    if (x.kind == DofKind::Translation) return x.axis == y.axis;
    return x.frame.matrix() == y.frame.matrix() &&
           std::equal(x.path.begin(), x.path.end(), y.path.begin(), y.path.end(),
                      [](const auto& p, const auto& q) {
                          return p.value == q.value && p.translation == q.translation &&
                                 p.rotation.coeffs() == q.rotation.coeffs();
                      });
}

} // namespace

BallTree::BallTree(const SphereSet& spheres) {
    std::vector<std::uint32_t> order = indicesOf(spheres.size());
    if (!spheres.empty()) join(spheres, order, 0, order.size());
}

std::int32_t BallTree::join(const SphereSet& spheres, std::vector<std::uint32_t>& order, std::size_t from,
                            std::size_t to) {
    Ball ball;
    if (to - from == 1) {
        ball.sphere = order[from];
        ball.centre = spheres[order[from]].centre;
        ball.radius = spheres[order[from]].radius;
        balls.push_back(ball);
        return root();
    }
    Vec3 mean = Vec3::Zero(), spread = Vec3::Zero();
    for (std::size_t k = from; k < to; ++k) mean += spheres[order[k]].centre;
    mean /= double(to - from);
    for (std::size_t k = from; k < to; ++k) spread += (spheres[order[k]].centre - mean).cwiseAbs2();
    Eigen::Index axis = 0;
    spread.maxCoeff(&axis);
    std::sort(order.begin() + from, order.begin() + to, [&](std::uint32_t x, std::uint32_t y) {
        const double cx = spheres[x].centre[axis], cy = spheres[y].centre[axis];
        return cx != cy ? cx < cy : x < y;
    });
    const std::size_t middle = from + (to - from) / 2;
    for (std::size_t k = from; k < to; ++k)
        ball.radius =
            std::max(ball.radius, (spheres[order[k]].centre - mean).norm() + spheres[order[k]].radius);
    ball.centre = mean;
    ball.radius *= 1 + 1e-13;
    ball.radius += 1e-15 * mean.norm();
    ball.first = join(spheres, order, from, middle);
    ball.second = join(spheres, order, middle, to);
    balls.push_back(ball);
    return root();
}

Models::Models(const SphereSet& a, const SphereSet& b, const Motion& motion, const VerifyOptions& options)
    : a(a), b(b), motion(motion), treeA(a), treeB(b), regionA(options.regionA), regionB(options.regionB),
      depth(options.depth) {
    double reachA = 0, reachB = 0;
    for (const Sphere& s : a) reachA = std::max(reachA, s.centre.norm() + s.radius);
    for (const Sphere& s : b) reachB = std::max(reachB, s.centre.norm() + s.radius);
    size = reachA + coordinateBound(motion, reachB);
    if (!a.empty() && !b.empty()) extent = treeA.balls.back().radius + treeB.balls.back().radius;
}

double Models::contactDistance(SpherePair pair) const {
    const double sum = a[pair.a].radius + b[pair.b].radius;
    if (regionA.empty() || regionB.empty() || !regionA[pair.a] || !regionB[pair.b]) return sum;
    return depth < 0 ? -1 : sum - depth;
}

std::vector<Test> matchTests(const Models& models, const Table& table, double band, std::string& reason) {
    std::vector<Test> tests;
    std::vector<Match> matchA, matchB;
    for (const Sphere& s : table.a) matchA.push_back(matchSphere(s, models.a));
    for (const Sphere& s : table.b) matchB.push_back(matchSphere(s, models.b));
    const auto alien = [&](const Match& m) {
        return !m.same && (table.epsilon == 0 || m.out > table.epsilon + band);
    };
    for (std::size_t i = 0; i < matchA.size() && reason.empty(); ++i)
        if (alien(matchA[i]))
            reason = "sphere " + std::to_string(i) + " of the table's A is none of the model's";
    for (std::size_t j = 0; j < matchB.size() && reason.empty(); ++j)
        if (alien(matchB[j]))
            reason = "sphere " + std::to_string(j) + " of the table's B is none of the model's";
    for (const MeshTest& t : meshTests(table)) {
        const Match &a = matchA[t.sphereA], &b = matchB[t.sphereB];
        const SpherePair pair{a.index, b.index};
        if (reason.empty() && t.contactDistance > models.contactDistance(pair) + 2 * table.epsilon + band)
            reason =
                "test " + std::to_string(tests.size()) + " of the table reports contact before its pair does";
        tests.push_back({t.centreA, t.centreB, t.contactDistance, {}});
        if (a.same && b.same) tests.back().same = pair;
    }
    return tests;
}

std::string motionMismatch(const Motion& made, const Motion& asked) {
    if (made.dofCount() != asked.dofCount()) return "the table was made for another number of DOFs";
    if (made.base.matrix() != asked.base.matrix()) return "the table was made for another placement of B";
    for (std::size_t k = 0; k < asked.dofCount(); ++k) {
        const Dof &x = made.dofs[k], &y = asked.dofs[k];
        if (!sameDof(x, y)) return "DOF " + std::to_string(k) + " is not the one the table was made for";
        if (y.lower < x.lower || y.upper > x.upper)
            return "the limits of DOF " + std::to_string(k) + " are wider than those the table was made for";
    }
    for (const LimitPlane& plane : made.planes)
        if (std::none_of(asked.planes.begin(), asked.planes.end(), [&](const LimitPlane& other) {
                return other.coefficients == plane.coefficients && other.bound <= plane.bound;
            }))
            return "a limit plane that the table was made for is gone";
    return {};
}

} // namespace tss::verify
