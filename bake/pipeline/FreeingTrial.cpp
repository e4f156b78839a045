#include "bake/pipeline/FreeingTrial.h"

#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/geometry/PartSet.h"
#include "bake/geometry/Solid.h"
#include "bake/search/RestContact.h"
#include "bake/search/SampledSearch.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr double marginShare = 1e-3; ///< of the smaller body's diagonal: what counts as apart
constexpr int steps = 16;            ///< of each DOF through its limits

/// The triangles of a mesh of which no part is in the region.
TriangleMesh without(const TriangleMesh& mesh, const std::vector<SurfacePart>& region) {
    PartSet parts;
    for (const SurfacePart& part : region) parts.insert(part);
    TriangleMesh rest;
    rest.vertices = mesh.vertices;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (!parts.reaches({t, 1})) rest.triangles.push_back(mesh.triangles[t]);
    return rest;
}

} // namespace

FreeingTrial::FreeingTrial(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double seconds)
    : seconds_(seconds), a_(a), b_(b), motion_(motion), size_(std::min(diagonal(a), diagonal(b))),
      margin_(marginShare * size_) {
    values_.push_back(restValues(motion));
    addSweeps(steps, values_);
    if (motion.dofCount() > 1)
        for (std::vector<double>& q : exploredPoses(motion, 20, 1)) values_.push_back(std::move(q));
    for (const std::vector<double>& q : values_) unmoved_.push_back(pose(motion, q));
    firstPoses_ = values_.size();
    order_ = indicesOf<std::size_t>(values_.size());
    if (overlapsAtRest()) findStops(a, b);
}

void FreeingTrial::addSweeps(int count, std::vector<std::vector<double>>& into) const {
    const std::vector<double> rest = restValues(motion_);
    for (std::size_t k = 0; k < rest.size(); ++k)
        for (int step = 0; step <= count; ++step) {
            std::vector<double> q = rest;
            const Dof& dof = motion_.dofs[k];
            q[k] = dof.lower + (dof.upper - dof.lower) * step / count;
            if (withinLimits(motion_, q, 0)) into.push_back(std::move(q));
        }
}

bool FreeingTrial::touches(std::size_t pose) const {
    return a_.distanceTo(b_, unmoved_[pose], 1e-6 * size_) < 1e-6 * size_;
}

bool FreeingTrial::overlapsAtRest() const {
    return touches(0);
}

std::optional<TouchingElsewhere> FreeingTrial::touchingElsewhere() const {
    std::vector<char> touching(firstPoses_);
    parallelFor(firstPoses_, [&](std::size_t k) { touching[k] = touches(k); });
    const auto count = static_cast<std::size_t>(std::ranges::count(touching, char{1}));
    if (2 * count <= firstPoses_) return std::nullopt;
    std::vector<double> middle;
    for (std::size_t d = 0; d < motion_.dofCount(); ++d) {
        std::vector<double> values;
        for (std::size_t k = 0; k < firstPoses_; ++k)
            if (touching[k]) values.push_back(values_[k][d]);
        middle.push_back(median(values));
    }
    std::size_t best = 0;
    for (std::size_t k = 1; k < firstPoses_; ++k)
        if (touching[k] &&
            (best == 0 || poseDistance(values_[k], middle) < poseDistance(values_[best], middle)))
            best = k;
    return TouchingElsewhere{count, firstPoses_, values_[best]};
}

std::optional<ApartElsewhere> FreeingTrial::apartElsewhere() const {
    std::vector<double> distances(firstPoses_, 0.0);
    parallelFor(firstPoses_, [&](std::size_t k) {
        if (!late()) distances[k] = a_.distanceTo(b_, unmoved_[k]);
    });
    const auto farthest = std::ranges::max_element(distances);
    if (!(*farthest > margin_)) return std::nullopt;
    const auto apart = std::ranges::count_if(distances, [&](double d) { return d > margin_; });
    return ApartElsewhere{static_cast<std::size_t>(apart), firstPoses_, *farthest,
                          values_[std::size_t(farthest - distances.begin())]};
}

double FreeingTrial::poseDistance(const std::vector<double>& p, const std::vector<double>& q) const {
    double away = 0;
    for (std::size_t d = 0; d < q.size(); ++d)
        away += std::abs(p[d] - q[d]) / std::max(motion_.dofs[d].upper - motion_.dofs[d].lower, 1e-300);
    return away;
}

void FreeingTrial::findStops(const TriangleMesh& a, const TriangleMesh& b) {
    const Solid solidA(a), solidB(b);
    const ContactSurface surfaceA(solidA, a_), surfaceB(solidB, b_);
    RestContactOptions options;
    options.reach = margin_;
    options.close = options.near = margin_ / 2;
    options.step = margin_;
    options.size = size_ / 200;
    options.poses = 200;
    const RestRegion region = findRestContact(surfaceA, surfaceB, motion_, touchingDistance(a, b, motion_),
                                              options, [&](std::string_view, double) { return !late(); })
                                  .region;
    const MeshQuery elsewhereA(without(a, region.a)), elsewhereB(without(b, region.b));
    stops_.assign(values_.size(), 0);
    parallelFor(values_.size(), [&](std::size_t k) {
        const double touching = 1e-6 * size_;
        stops_[k] = k > 0 && !late() &&
                    (elsewhereA.distanceTo(b_, unmoved_[k], touching) < touching ||
                     a_.distanceTo(elsewhereB, unmoved_[k], touching) < touching);
    });
}

Motion FreeingTrial::movedMotion(const JointMove& move) const {
    Motion motion = motion_;
    motion.base = Pose(motion.base * Eigen::Translation3d(move.head<3>()));
    for (Dof& dof : motion.dofs)
        if (dof.kind == DofKind::Rotation) dof.origin += move.tail<3>();
    return motion;
}

double FreeingTrial::displacement(const JointMove& move) const {
    // Axes are moved without being turned, so that all of B lies elsewhere by the same.
    const Motion motion = movedMotion(move);
    double sum = 0;
    for (std::size_t k = 0; k < firstPoses_; ++k)
        sum += (pose(motion, values_[k]) * Vec3::Zero() - unmoved_[k] * Vec3::Zero()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(firstPoses_));
}

bool FreeingTrial::frees(const JointMove& move, const std::vector<char>& wanted) {
    const Motion motion = movedMotion(move);
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::size_t k = order_[i];
        if (!wanted[k] || (!late() && a_.apart(b_, pose(motion, values_[k]), margin_))) continue;
        std::rotate(order_.begin(), order_.begin() + i, order_.begin() + i + 1);
        return false;
    }
    return true;
}

std::size_t FreeingTrial::countFree(const JointMove& move, const std::vector<char>& wanted) const {
    const Motion motion = movedMotion(move);
    std::vector<char> free(values_.size(), 0);
    parallelFor(values_.size(), [&](std::size_t k) {
        free[k] = wanted[k] && !late() && a_.apart(b_, pose(motion, values_[k]), margin_);
    });
    return static_cast<std::size_t>(std::ranges::count(free, char{1}));
}

std::size_t FreeingTrial::addBlocked(const JointMove& move, std::vector<char>& wanted) {
    const Motion motion = movedMotion(move);
    std::vector<std::vector<double>> more;
    addSweeps(4 * steps, more);
    std::vector<char> blocked(more.size(), 0);
    parallelFor(more.size(),
                [&](std::size_t i) { blocked[i] = !a_.apart(b_, pose(motion, more[i]), margin_); });
    const auto nearest = [&](const std::vector<double>& q) {
        std::size_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < firstPoses_; ++k) {
            const double away = poseDistance(q, values_[k]);
            if (away < least) least = away, best = k;
        }
        return best;
    };
    std::size_t added = 0;
    for (std::size_t i = 0; i < more.size(); ++i) {
        if (!blocked[i] || !wanted[nearest(more[i])]) continue;
        // Next to a stop contact begins somewhere between.
        const std::size_t near = nearest(more[i]);
        const bool besideStop =
            (near > 1 && stops_[near - 1]) || (near + 1 < firstPoses_ && stops_[near + 1]);
        if (besideStop) continue;
        order_.push_back(values_.size());
        unmoved_.push_back(pose(motion_, more[i]));
        values_.push_back(std::move(more[i]));
        stops_.push_back(0);
        wanted.push_back(1);
        ++added;
    }
    return added;
}

std::vector<StopBeyond> FreeingTrial::stopsBeyond(const Motion& motion) const {
    constexpr double farthest = 0.5; // of the range
    std::vector<StopBeyond> found;
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        const Dof& dof = motion.dofs[k];
        const double range = dof.upper - dof.lower;
        if (dof.kind == DofKind::Path || range <= 0) continue;
        for (const int side : {-1, 1})
            for (int step = 1; step <= 2 * steps; ++step) {
                const double beyond = farthest * step / (2 * steps) * range;
                if (dof.kind == DofKind::Rotation && range + beyond > 2 * M_PI) break;
                std::vector<double> q = restValues(motion);
                q[k] = side < 0 ? dof.lower - beyond : dof.upper + beyond;
                if (a_.apart(b_, pose(motion, q), 1e-6 * size_)) continue;
                found.push_back({k, q[k]});
                break;
            }
    }
    return found;
}

FreeingMove FreeingTrial::measured(const JointMove& move) const {
    FreeingMove found;
    found.shift = move.head<3>();
    found.axes = move.tail<3>();
    found.motion = movedMotion(move);
    found.moved = displacement(move);
    found.poses = firstPoses_;
    std::vector<double> distances(firstPoses_);
    parallelFor(firstPoses_, [&](std::size_t k) {
        distances[k] = a_.distanceTo(b_, pose(found.motion, values_[k]), size_);
    });
    found.atRest = std::min(distances.front(), size_);
    found.freeAtRest = distances.front() > margin_;
    found.least = size_;
    found.margin = margin_;
    for (std::size_t k = 0; k < firstPoses_; ++k) {
        found.meets += distances[k] <= 0;
        found.stops += stops_[k] && distances[k] <= 0;
        if (distances[k] <= margin_) continue;
        ++found.free;
        found.least = std::min(found.least, distances[k]);
    }
    if (found.meets == 0) found.beyond = stopsBeyond(found.motion);
    return found;
}

} // namespace tss
