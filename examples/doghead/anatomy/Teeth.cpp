#include "examples/doghead/anatomy/Anatomy.h"

#include "examples/doghead/implicit/Curve.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace doghead {
namespace {

/// A place on a dental arch: at the gum, the row's direction towards the nose, outwards (buccal), and towards
/// the biting edge.
struct Place {
    Vec3 gum, forward, outward, bite;

    Vec3 operator()(double mesial, double buccal, double height) const {
        return gum + mesial * forward + buccal * outward + height * bite;
    }
    double heading() const { return std::atan2(forward.y(), forward.x()) * 180 / M_PI; }
};

struct Arch {
    Profile y;   ///< of the middle of the row over x
    Profile gum; ///< z of the gum line
    double bite; ///< -1 upper row, +1 lower row

    Place at(double x) const {
        const Vec3 forward = Vec3(1, y.slope(x), 0).normalized();
        return {Vec3(x, y(x), gum(x)), forward, Vec3(-forward.y(), forward.x(), 0), Vec3(0, 0, bite)};
    }
};

/// A crown that is an outline in the row's plane (mesial, height), thickest near the gum and thinning towards
/// the biting edge and the two ends.
Field blade(const Place& p, const Outline& corners, double halfWidth) {
    const auto outline = std::make_shared<const Outline>(smoothOutline(corners, 4));
    double height = 0, length = 0;
    Box box;
    for (const Eigen::Vector2d& c : *outline) {
        height = std::max(height, c.y());
        length = std::max(length, std::abs(c.x()));
        for (const double side : {-halfWidth, halfWidth}) box.extend(p(c.x(), side, c.y()));
    }
    const auto distance = [=](const Vec3& x) {
        const Vec3 offset = x - p.gum;
        const double mesial = offset.dot(p.forward), rise = offset.dot(p.bite);
        const double end = std::min(1., mesial * mesial / (length * length));
        const double lower = std::clamp(rise / height, 0., 1.2);
        const double thickness = halfWidth * (1 - 0.45 * end) * (1 - 0.78 * lower * std::sqrt(lower));
        const double face = std::abs(offset.dot(p.outward)) - thickness;
        return -smoothMin(-outlineDistance(*outline, {mesial, rise}), -face, 1);
    };
    return {distance, box};
}

/// One main cusp with a shoulder before and a larger one behind it.
Field premolar(const Place& p, double length, double width, double height) {
    const double l = length, h = height;
    const Outline outline{{-0.40 * l, -4},       {-0.46 * l, 0},        {-0.51 * l, 0.2 * h},
                          {-0.42 * l, 0.40 * h}, {-0.24 * l, 0.46 * h}, {-0.1 * l, 0.78 * h},
                          {0.02 * l, h},         {0.12 * l, 0.84 * h},  {0.30 * l, 0.44 * h},
                          {0.44 * l, 0.32 * h},  {0.5 * l, 0.14 * h},   {0.44 * l, 0},
                          {0.38 * l, -4}};
    return blade(p, outline, width / 2);
}

/// A cusp of a molar: a cone from the crown's body to a tip.
Field cusp(const Place& p, double mesial, double buccal, double height, double radius) {
    return cone(p(mesial, 0.8 * buccal, 0), p(mesial, buccal, height), radius, 0.7);
}

/// A small chisel: `turn` is the angle by which the arch has bent away from straight across at its place.
Field incisor(const Vec3& root, const Vec3& edge, double width, double turn) {
    const Vec3 bite = (edge - root).normalized();
    const Vec3 across = Vec3(-std::sin(turn), std::cos(turn), 0);
    const Place place{root, (across - across.dot(bite) * bite).normalized(), bite.cross(across).normalized(),
                      bite};
    const double h = (edge - root).norm(), w = width / 2;
    const Outline outline{{-0.62 * w, -1}, {-0.72 * w, 0.4 * h}, {-w, 0.72 * h}, {-0.8 * w, 0.93 * h},
                          {0, h},          {0.8 * w, 0.93 * h},  {w, 0.72 * h},  {0.72 * w, 0.4 * h},
                          {0.62 * w, -1}};
    return blade(place, outline, 2.5);
}

} // namespace

Field upperTeeth() {
    const Arch arch{
        Profile(
            {{40, 27.0}, {47, 26.6}, {56, 27.3}, {71, 25.6}, {87, 21}, {99, 17.6}, {109, 16}, {116, 15.5}}),
        Profile({{44, -24.5}, {56, -26.5}, {75, -27.5}, {110, -27}, {135, -26}}), -1};
    Sculpture teeth;
    teeth.add(incisor({133.5, 2.6, -24}, {137.0, 2.7, -34.2}, 4.6, 0.1));
    teeth.add(incisor({131.8, 7.6, -24}, {135.2, 8.1, -34.7}, 4.8, 0.45));
    teeth.add(
        tube({Vec3(128, 10.6, -23), Vec3(130.8, 11.8, -29), Vec3(131.8, 12.7, -33), Vec3(131.4, 13, -37)},
             {2.4, 2.3, 1.8, 0.7}));
    teeth.add(
        tube({Vec3(113, 14.5, -17), Vec3(118, 15.6, -26), Vec3(120.4, 16.8, -36), Vec3(119.6, 17.6, -44)},
             {4.2, 4.1, 2.9, 0.8}));
    teeth.add(premolar(arch.at(109.3), 6.4, 4.2, 8.2));
    teeth.add(premolar(arch.at(99.2), 10.6, 4.9, 9.2));
    teeth.add(premolar(arch.at(86.6), 11.6, 5.3, 9.6));

    const Place carnassial = arch.at(71);
    const Outline shear{{-8.4, -4},  {-9, 1},    {-8.6, 5.8}, {-5.6, 7.8}, {-2.6, 6.2}, {-0.8, 8.4},
                        {0.9, 11.4}, {2.6, 9.6}, {5, 5.4},    {8, 4.2},    {9, 1.4},    {8.2, -4}};
    teeth.add(Sculpture()
                  .add(blade(carnassial, shear, 3.4))
                  .add(cone(carnassial(6.2, -1, -1), carnassial(6.2, -4.2, 3.4), 2.6, 1.2), 2)
                  .field());
    const Place first = arch.at(56);
    const Place outer{first(0, 2, 0), first.forward, first.outward, first.bite};
    const Outline cusps{{-5.6, -4}, {-6, 1},  {-5, 4.2}, {-2.8, 5.8}, {-0.2, 4.2},
                        {2.8, 6.6}, {5.2, 4}, {6.2, 1},  {5.6, -4}};
    teeth.add(Sculpture()
                  .add(blade(outer, cusps, 3.2))
                  .add(turned(ellipsoid(first(-0.4, -2.6, 0.2), {5, 4.4, 2.9}), first.gum, Vec3::UnitZ(),
                              first.heading()),
                       2)
                  .add(cusp(first, 0.2, -3.8, 3.4, 1.8), 1.5)
                  .field());
    const Place second = arch.at(46.6);
    const Outline small{{-3, -3},   {-3.5, 0.6}, {-2.6, 3.2}, {-0.2, 2.6},
                        {1.8, 3.9}, {3.2, 2},    {3.6, 0.2},  {3, -3}};
    teeth.add(Sculpture()
                  .add(blade(second, small, 2.8))
                  .add(turned(ellipsoid(second(0, -2.2, 0), {3, 2.9, 2.5}), second.gum, Vec3::UnitZ(),
                              second.heading()),
                       1.5)
                  .field());
    return mirrored(teeth.field());
}

Field lowerTeeth() {
    const Arch arch{Profile({{38, 21.5}, {46, 20.6}, {62, 19.4}, {80, 17.6}, {92, 16}, {104, 14}, {112, 13}}),
                    Profile({{38, -34}, {46, -37.2}, {62, -40.3}, {85, -42}, {112, -43.4}, {130, -42}}), 1};
    Sculpture teeth;
    teeth.add(incisor({129.0, 2.05, -46}, {134.2, 2.1, -35.8}, 3.4, 0.05));
    teeth.add(incisor({128.0, 5.9, -46}, {132.8, 6.4, -35.5}, 3.6, 0.35));
    teeth.add(incisor({126.0, 9.2, -46}, {129.6, 10.3, -34.9}, 3.8, 0.75));
    teeth.add(
        tube({Vec3(116, 11.2, -51), Vec3(121.8, 12.3, -43.5), Vec3(125.8, 14.2, -36), Vec3(126.8, 16, -29.2)},
             {3.9, 3.7, 2.5, 0.8}));
    teeth.add(premolar(arch.at(112), 5, 3.6, 5.2));
    teeth.add(premolar(arch.at(103.4), 9.4, 4.5, 7.0));
    teeth.add(premolar(arch.at(91.8), 10.6, 4.8, 7.4));
    teeth.add(premolar(arch.at(79.4), 11.8, 5.2, 8.0));

    const Place carnassial = arch.at(62.3);
    const Outline shear{{-9, -4},    {-9.8, 1}, {-9.2, 4.6}, {-7, 5.6},  {-4, 4.8}, {-2.2, 7.4}, {0, 12.2},
                        {1.8, 10.4}, {3, 7.8},  {4.8, 8.2},  {6.4, 9.2}, {8.4, 6},  {9.8, 1.6},  {9, -4}};
    teeth.add(Sculpture()
                  .add(blade(carnassial, shear, 3.3))
                  .add(cone(carnassial(-6.4, -1.4, 0), carnassial(-6.4, -2.2, 4.2), 2.4, 1.1), 1.5)
                  .add(cone(carnassial(-2.4, -1, 2), carnassial(-2.6, -2.2, 6.4), 2, 0.9), 1.2)
                  .field());
    const Place second = arch.at(46.4);
    const Outline cusps{{-4.6, -4}, {-5, 1},    {-4.2, 3}, {-2.4, 3.8}, {-0.4, 3},
                        {1.8, 4.6}, {4.2, 3.4}, {5, 1},    {4.4, -4}};
    teeth.add(Sculpture().add(blade(second, cusps, 3.1)).add(cusp(second, 1.8, -1.6, 3.8, 1.6), 1).field());
    const Place third = arch.at(39.4);
    teeth.add(blade(
        third, {{-2.4, -3}, {-2.6, 0.6}, {-1.6, 2.6}, {0.2, 3.2}, {1.8, 2.4}, {2.7, 0.6}, {2.4, -3}}, 2.5));
    return mirrored(teeth.field());
}

} // namespace doghead
