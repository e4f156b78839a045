#include "examples/doghead/implicit/Field.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace doghead {

Vec3 normal(const Field& field, const Vec3& p, double h) {
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step = Vec3::Zero();
        step[axis] = h;
        gradient[axis] = field(p + step) - field(p - step);
    }
    const double length = gradient.norm();
    return length > 0 ? Vec3(gradient / length) : Vec3::UnitZ();
}

Field ellipsoid(const Vec3& centre, const Vec3& radii) {
    const auto distance = [centre, radii, inner = radii.minCoeff()](const Vec3& p) {
        const Vec3 scaled = (p - centre).cwiseQuotient(radii);
        const double k0 = scaled.norm();
        const double k1 = scaled.cwiseQuotient(radii).norm();
        return k1 > 1e-9 ? k0 * (k0 - 1) / k1 : -inner;
    };
    return {distance, Box(centre - radii, centre + radii)};
}

Field cone(const Vec3& a, const Vec3& b, double ra, double rb) {
    const Vec3 axis = b - a;
    const double length = axis.norm();
    Box box(a - Vec3::Constant(ra), a + Vec3::Constant(ra));
    box.extend(Box(b - Vec3::Constant(rb), b + Vec3::Constant(rb)));
    if (length <= std::abs(ra - rb)) // one ball holds the other
        return ellipsoid(ra > rb ? a : b, Vec3::Constant(std::max(ra, rb)));

    const Vec3 along = axis / length;
    const double sine = (ra - rb) / length;
    const double cosine = std::sqrt(1 - sine * sine);
    const auto distance = [=](const Vec3& p) {
        const Vec3 offset = p - a;
        const double z = offset.dot(along);
        const double x = (offset - z * along).norm();
        const double foot = z - x * sine / cosine; // where the normal of the mantle meets the axis
        if (foot <= 0) return offset.norm() - ra;
        if (foot >= length) return (p - b).norm() - rb;
        return x * cosine + z * sine - ra;
    };
    return {distance, box};
}

Field placed(const Field& field, const Pose& pose) {
    Box box;
    for (int corner = 0; corner < 8; ++corner)
        box.extend(pose * field.box.corner(static_cast<Box::CornerType>(corner)));
    return {[inner = field.distance, back = pose.inverse()](const Vec3& p) { return inner(back * p); }, box};
}

Field turned(const Field& field, const Vec3& centre, const Vec3& axis, double degrees) {
    Pose pose = Pose::Identity();
    pose.translate(centre);
    pose.rotate(Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()));
    pose.translate(-centre);
    return placed(field, pose);
}

Field stretched(const Field& field, const Vec3& centre, const Vec3& factors) {
    const auto distance = [=, inner = field.distance, least = factors.minCoeff()](const Vec3& p) {
        return least * inner(centre + (p - centre).cwiseQuotient(factors));
    };
    const Vec3 low = centre + (field.box.min() - centre).cwiseProduct(factors);
    const Vec3 high = centre + (field.box.max() - centre).cwiseProduct(factors);
    return {distance, Box(low, high)};
}

Field grown(const Field& field, double amount) {
    Box box = field.box;
    if (amount > 0) {
        box.min().array() -= amount;
        box.max().array() += amount;
    }
    return {[inner = field.distance, amount](const Vec3& p) { return inner(p) - amount; }, box};
}

Field halfSpace(const Vec3& point, const Vec3& outward, const Box& box) {
    return {[point, n = outward.normalized().eval()](const Vec3& p) { return n.dot(p - point); }, box};
}

Field mirrored(const Field& field) {
    Box box = field.box;
    box.extend(Vec3(box.min().x(), -box.max().y(), box.min().z()));
    const auto distance = [inner = field.distance](const Vec3& p) {
        return inner(Vec3(p.x(), std::abs(p.y()), p.z()));
    };
    return {distance, box};
}

double smoothMin(double a, double b, double k) {
    const double overlap = k - std::abs(a - b);
    return std::min(a, b) - (overlap > 0 ? overlap * overlap / (4 * k) : 0);
}

Sculpture& Sculpture::add(const Field& part, double k) {
    steps_.push_back({Kind::Add, part, k});
    return *this;
}

Sculpture& Sculpture::carve(const Field& part, double k) {
    steps_.push_back({Kind::Carve, part, k});
    return *this;
}

Sculpture& Sculpture::keep(const Field& part, double k) {
    steps_.push_back({Kind::Keep, part, k});
    return *this;
}

Field Sculpture::field() const {
    Box box;
    for (const Step& step : steps_)
        if (step.kind == Kind::Add) box.extend(step.part.box);
    const auto distance = [steps = std::make_shared<const std::vector<Step>>(steps_)](const Vec3& p) {
        double d = 1e9;
        for (const Step& step : *steps) {
            // A part whose box is farther than the blend reaches cannot move the surface.
            if (step.kind == Kind::Keep) {
                d = -smoothMin(-d, -step.part(p), step.k);
            } else {
                const double away = std::sqrt(step.part.box.squaredExteriorDistance(p));
                if (step.kind == Kind::Add) {
                    if (away < d + step.k) d = smoothMin(d, step.part(p), step.k);
                } else if (away < step.k - d) {
                    d = -smoothMin(-d, step.part(p), step.k);
                }
            }
        }
        return d;
    };
    return {distance, box};
}

} // namespace doghead
