#include "bake/motion/MuscleSpan.h"

#include "bake/motion/MuscleVolume.h"

#include <algorithm>
#include <cmath>

namespace tss {

MuscleSpan::MuscleSpan(const MuscleDeformer& muscle, double unit)
    : closed_(muscle.closedTriangles()), sides_(muscle.muscle().sides), shares_(muscle.chainShares()),
      gradients_(shares_.size(), Vec3::Zero()) {
    const std::vector<MusclePoint>& points = muscle.surfacePoints();
    const TriangleMesh& surface = muscle.muscle().surface;
    swelling_ = medialOffsets(surface, ClosestPointQuery(surface), vertexNormals(surface));
    for (std::size_t v = 0; v < points.size(); ++v) {
        const double along = muscle.alongShare(points[v]);
        swelling_[v] *= 2 * std::sqrt(std::max(along * (1 - along), 0.0)) / unit;
    }
    // The mean of the gradients in the triangles around, by area.
    std::vector<double> area(shares_.size(), 0);
    for (const Tri& t : surface.triangles) {
        const Vec3& a = points[t[0]].rest;
        const Vec3 u = points[t[1]].rest - a, v = points[t[2]].rest - a, n = u.cross(v);
        const double twice = n.norm();
        if (!(twice > 0)) continue;
        const Vec3 slope =
            ((shares_[t[1]] - shares_[t[0]]) * v.cross(n) - (shares_[t[2]] - shares_[t[0]]) * u.cross(n)) /
            twice; // by twice the area
        for (const int corner : t) {
            gradients_[corner] += unit * slope;
            area[corner] += twice;
        }
    }
    for (std::size_t v = 0; v < gradients_.size(); ++v)
        if (area[v] > 0) gradients_[v] /= area[v];
    std::vector<Vec3> rest;
    for (const MusclePoint& p : points) rest.push_back((p.rest - points.front().rest) / unit);
    slope_ = swollenVolume(0, rest, swelling_, closed_)[1];
}

std::vector<Pose> MuscleSpan::posesBy(const ChainBlend& blend) const {
    std::vector<Pose> poses;
    poses.reserve(shares_.size());
    for (const double share : shares_) poses.push_back(blend.at(share));
    return poses;
}

double MuscleSpan::swellBy(const std::vector<Pose>& poses, std::span<const Vec3> places) const {
    // Bounds of the factor. A sheet compressed to half its length becomes twice as thick on average and three
    // times where it swells most, which is a factor of 2.
    constexpr double least = -0.9, most = 2;
    // Lower bound of d volume / d factor, as a share of that at rest: it nearly vanishes where a muscle
    // folds.
    constexpr double leastSlope = 0.1;
    if (places.empty()) return 0;
    const Vec3 middle = places.front();
    std::vector<Vec3> now(places.size()), out(places.size());
    const std::vector<Vec3> none(places.size(), Vec3::Zero());
    for (std::size_t v = 0; v < places.size(); ++v) now[v] = places[v] - middle;
    const double wanted = swollenVolume(0, now, none, closed_)[0] / 6;
    for (std::size_t v = 0; v < places.size(); ++v) {
        now[v] = poses[v] * places[v] - middle;
        out[v] = poses[v].linear() * swelling_[v];
    }
    return boundedSwelling(swollenVolume(wanted, now, out, closed_), leastSlope * slope_, least, most);
}

double MuscleSpan::swell(const ChainMotion& bones, std::span<const Vec3> places) const {
    return isAtRest(bones) ? 0 : swellBy(posesBy({bones, sides_}), places);
}

double MuscleSpan::carry(const ChainMotion& bones, std::span<Vec3> places, std::span<Vec3> normals) const {
    constexpr double side = 1e-3;         // step of the share for the central difference below
    constexpr double leastStretch = 0.05; // lower bound of the local stretch that turns normals
    if (isAtRest(bones)) return 0;
    const ChainBlend blend(bones, sides_);
    const std::vector<Pose> poses = posesBy(blend);
    const double factor = swellBy(poses, places);
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (!normals.empty()) {
            // The place depends on the share too, so the deformation gradient is R (I + u g^T), where g is
            // the gradient of the share and u the derivative of the place by it. Normals turn by its inverse
            // transpose (Sherman-Morrison).
            Vec3& normal = normals[v];
            if (!gradients_[v].isZero()) {
                const Vec3 along =
                    blend.at(shares_[v] + side) * places[v] - blend.at(shares_[v] - side) * places[v];
                const Vec3 u = poses[v].linear().transpose() * along / (2 * side);
                normal -= gradients_[v] * (u.dot(normal) / std::max(1 + u.dot(gradients_[v]), leastStretch));
                if (normal.squaredNorm() > 0) normal.normalize();
            }
            normal = poses[v].linear() * normal;
        }
        places[v] = poses[v] * (places[v] + factor * swelling_[v]);
    }
    return factor;
}

MuscleShape::MuscleShape(const MuscleDeformer& muscle) : muscle_(&muscle) {
    if (muscle.muscle().spans && !muscle.surfacePoints().empty())
        span_ = std::make_shared<const MuscleSpan>(muscle);
}

std::vector<Vec3> MuscleShape::vertices(double activation, const ChainMotion& bones) const {
    std::vector<Vec3> places = muscle_->vertices(activation);
    if (span_) span_->carry(bones, places);
    return places;
}

} // namespace tss
