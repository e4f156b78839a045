#include "examples/doghead/anatomy/Anatomy.h"

#include "examples/doghead/implicit/Curve.h"

#include <cmath>

namespace doghead {
namespace {

constexpr double originX = 8, insertionX = 69;
constexpr double above = 3.5; ///< of the sheet's middle surface over the cranium, mm

} // namespace

Field frontalis() {
    const Profile halfThickness({{originX, 1}, {24, 2.2}, {42, 2.8}, {58, 2.5}, {insertionX, 1}});
    const Profile halfWidth({{originX, 11}, {20, 18}, {36, 21}, {50, 22.5}, {60, 20}, {insertionX, 11}});
    const Box box(Vec3(originX - 2, -30, 14), Vec3(insertionX + 2, 30, 58));
    const auto distance = [=, bone = cranium()](const Vec3& p) {
        const double sheet = std::abs(bone(p) - above) - halfThickness(p.x());
        const double rim =
            std::max(std::abs(p.y()) - halfWidth(p.x()), std::max(originX - p.x(), p.x() - insertionX));
        const double low = 33 - p.z(); // the sheet ends on the upper side of the cranium
        return -smoothMin(-sheet, -std::max(rim, low), 2.4);
    };
    return {distance, box};
}

std::vector<Vec3> frontalisFibre() {
    const Field bone = cranium();
    std::vector<Vec3> fibre;
    for (int i = 0; i <= 12; ++i) {
        Vec3 p(originX + (insertionX - originX) * i / 12., 0, 60);
        for (int step = 0; step < 40; ++step) p.z() -= bone(p) - above; // down onto the middle surface
        fibre.push_back(p);
    }
    return fibre;
}

} // namespace doghead
