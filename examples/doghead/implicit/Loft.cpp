#include "examples/doghead/implicit/Loft.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace doghead {
namespace {

struct LoftData {
    Profile floor, roof, halfWidth, taper, exponent;
    double from, to;

    /// 1 on the surface, rising outwards, in the section plane of p.
    double level(const Vec3& p) const {
        const double low = floor(p.x()), high = roof(p.x());
        const double v = (2 * p.z() - low - high) / (high - low);
        const double narrowed = std::max(0.15, 1 - taper(p.x()) * std::clamp(v, -1.1, 1.1));
        const double u = std::abs(p.y()) / (halfWidth(p.x()) * narrowed);
        const double n = exponent(p.x());
        return std::pow(std::pow(u, n) + std::pow(std::abs(v), n), 1 / n);
    }

    double operator()(const Vec3& p) const {
        const double here = level(p), h = 0.05;
        Vec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 q = p;
            q[axis] += h;
            gradient[axis] = (level(q) - here) / h;
        }
        const double steepness = gradient.norm();
        const double radius = std::min(halfWidth(p.x()), (roof(p.x()) - floor(p.x())) / 2);
        // Near the middle line the level has a kink: there the smaller radius is the scale.
        const double d = (here - 1) / std::max(steepness, 0.5 / radius);
        const double ends = std::max(from - p.x(), p.x() - to);
        return -smoothMin(-d, -ends, 5); // the ends are rounded where they meet the mantle
    }
};

Profile column(const std::vector<Section>& sections, double Section::*member) {
    std::vector<Profile::Knot> knots;
    for (const Section& s : sections) knots.push_back({s.x, s.*member});
    return Profile(knots);
}

} // namespace

Field loft(const std::vector<Section>& sections) {
    const auto data = std::make_shared<const LoftData>(
        LoftData{column(sections, &Section::floor), column(sections, &Section::roof),
                 column(sections, &Section::halfWidth), column(sections, &Section::taper),
                 column(sections, &Section::exponent), sections.front().x, sections.back().x});
    Box box;
    for (const Section& s : sections) {
        const double reach = s.halfWidth * (1 + std::abs(s.taper));
        box.extend(Box(Vec3(s.x, -reach, s.floor), Vec3(s.x, reach, s.roof)));
    }
    return {[data](const Vec3& p) { return (*data)(p); }, box};
}

} // namespace doghead
