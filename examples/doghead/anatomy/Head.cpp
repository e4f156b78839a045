#include "examples/doghead/anatomy/Anatomy.h"

#include "examples/doghead/implicit/Loft.h"

#include <cmath>

namespace doghead {
namespace {

constexpr double lipThickness = 4.5;   ///< and depth of the mouth line, mm
constexpr double lipRim = 1;           ///< how far the lining goes on behind the lips, mm
constexpr double cornerPocket = 4;     ///< and behind the corner of the mouth, mm more
constexpr double frontalisCover = 0.5; ///< least thickness of the skin over the frontalis: they touch

/// z where the lips meet, for x from the corner of the mouth to the nose's foot.
double mouthHeight(double x) {
    static const Profile height({{76, -41}, {90, -45.5}, {112, -48}, {130, -46}, {142, -42.5}, {152, -38}});
    return height(x);
}

Field upperMuzzle() {
    return loft({{30, -52, 44, 40, 0.10, 2.3},
                 {46, -52, 44, 40, 0.15, 2.3},
                 {60, -51, 40, 37.5, 0.20, 2.3},
                 {72, -50, 32, 34, 0.24, 2.3},
                 {84, -49.5, 22.5, 30, 0.24, 2.4},
                 {96, -49, 15.5, 26.5, 0.22, 2.5},
                 {110, -49, 10.5, 24, 0.20, 2.5},
                 {124, -48.5, 7, 22.5, 0.18, 2.5},
                 {136, -47, 4, 20, 0.15, 2.4},
                 {146, -43, 0.5, 16, 0.1, 2.3},
                 {153, -36, -5, 11, 0, 2.2}});
}

Field lowerMuzzle() {
    return loft({{20, -70, -22, 40, 0, 2.3},
                 {44, -69, -22, 37, 0, 2.3},
                 {70, -68, -26, 31.5, 0, 2.5},
                 {96, -66.5, -30, 26, 0, 2.5},
                 {118, -63, -34, 21.5, 0, 2.4},
                 {132, -57.5, -36, 16.5, 0, 2.3},
                 {142, -51, -38, 10, 0, 2.2}});
}

Field muzzle() {
    return Sculpture().add(upperMuzzle()).add(lowerMuzzle(), 2).field();
}

/// What of the muzzle lies behind the lips, deeper than they are thick. (The muzzle as one
/// sculpture has no such depth: a part is skipped where it cannot move the surface.)
Field deepMuzzle() {
    const auto distance = [upper = upperMuzzle(), lower = lowerMuzzle()](const Vec3& p) {
        return smoothMin(upper(p), lower(p), 2) + lipThickness;
    };
    return {distance, muzzle().box};
}

/// A thin sheet where the lips meet, from the nose's foot, or through under it, to the corner of the mouth.
Field mouthLine(bool through) {
    const Box box(Vec3(76, -60, -52), Vec3(170, 60, through ? -30 : -38));
    const auto distance = [flesh = grown(muzzle(), -lipThickness)](const Vec3& p) {
        const double sheet = std::abs(p.z() - mouthHeight(p.x())) - 0.9;
        return -smoothMin(-sheet, std::min(p.x() - 78, flesh(p)), 2);
    };
    return {distance, box};
}

/// The room for teeth behind lips of some millimetres.
Field mouthRoom() {
    const Box box(Vec3(76, -60, -62), Vec3(160, 60, -28));
    const auto distance = [flesh = deepMuzzle()](const Vec3& p) {
        const double slab = std::abs(p.z() - mouthHeight(p.x())) - 9;
        return -smoothMin(-slab, std::min(p.x() - 80, -flesh(p)), 3);
    };
    return {distance, box};
}

Field cheeksAndBrow() {
    return Sculpture()
        .add(grown(cranium(), 5.6))
        .add(mirrored(ellipsoid({-4, 19, 31}, {33, 22, 25})), 10)  // temporalis
        .add(ellipsoid({-12, 0, 30}, {36, 26, 28.5}), 10)          // over the crests
        .add(mirrored(ellipsoid({22, 31, -22}, {30, 17, 32})), 14) // masseter
        .add(mirrored(turned(ellipsoid({30, 37, 8}, {36, 14.5, 14}), {30, 37, 8}, Vec3::UnitZ(), -8)),
             14) // arch
        .add(mirrored(turned(ellipsoid({56, 16, 34}, {16, 13, 8.5}), {56, 16, 34}, Vec3::UnitZ(), 25)),
             10)                                       // brow
        .add(ellipsoid({36, 0, 32}, {36, 30, 23}), 14) // forehead
        .field();
}

Field neck() {
    return sweep(
        {{{20, 0, -8}, 40, 46}, {{-12, 0, -12}, 44, 52}, {{-48, 0, -34}, 48, 58}, {{-84, 0, -64}, 52, 62}},
        Vec3::UnitZ());
}

/// The shell of the left ear, hollow towards the front and the side.
Field ear() {
    const Vec3 facing = Vec3(0.82, 0.57, 0).normalized();
    const Vec3 a(-12, 31, 40), b(-15, 41, 66), c(-12, 50, 92), d(-7, 57, 117);
    const Field shell = sweep({{a, 18, 15}, {b, 21.5, 9.5}, {c, 15.5, 6}, {d, 2.4, 1.9}}, facing);
    const Field bowl = sweep({{a + Vec3(2, 4, 12) + 9 * facing, 9, 8},
                              {b + 6.5 * facing, 17, 7.5},
                              {c + 4.5 * facing, 11.8, 4.8},
                              {d - Vec3(1, 2, 8) + 2.6 * facing, 2, 1.6}},
                             facing);
    return Sculpture().add(shell).carve(bowl, 2.5).field();
}

/// Lids around the eyeball, open in the shape of an almond.
void openEyes(Sculpture& head) {
    const Vec3 side = Vec3::UnitZ().cross(gaze).normalized(), up = gaze.cross(side);
    head.add(mirrored(ellipsoid(eyeCentre, Vec3::Constant(eyeRadius + 1.9))), 5);
    Pose frame = Pose::Identity();
    frame.linear() << side, up.cross(side), up;
    frame.translation() = eyeCentre + 10 * gaze;
    const Field almond = placed(Sculpture()
                                    .add(ellipsoid({0, 0, -4.4}, {11, 14, 9.2}))
                                    .keep(ellipsoid({0, 0, 4.2}, {11, 14, 9.2}), 0.6)
                                    .field(),
                                frame);
    head.carve(mirrored(almond), 1.2);
    head.carve(mirrored(ellipsoid(eyeCentre, Vec3::Constant(eyeRadius + 0.5))), 0.8);
}

Field nostrils() {
    return mirrored(
        tube({Vec3(150, 4.5, -8), Vec3(158.5, 4.8, -8.5), Vec3(157, 8.6, -10.5), Vec3(153, 10.8, -11.5)},
             {2.2, 2.2, 1.4, 0.9}));
}

} // namespace

Field nosePad() {
    return Sculpture()
        .add(ellipsoid({151.5, 0, -9}, {7.5, 10.2, 8}))
        .add(ellipsoid({151, 0, -15}, {6.6, 5, 7}), 4)
        .carve(nostrils(), 1.2)
        .carve(cone({158.5, 0, -12}, {156.5, 0, -24}, 0.6, 0.8), 1.2)
        .field();
}

Field earCartilage() {
    const Box below(Vec3(-60, 0, 0), Vec3(40, 80, 56));
    return Sculpture()
        .add(grown(ear(), -1.1))
        .carve(halfSpace({-12, 36, 56}, Vec3::UnitZ(), below), 2)
        .field();
}

namespace {

Field head(bool mouthCut) {
    Sculpture head;
    head.add(muzzle());
    head.add(cheeksAndBrow(), 10);
    head.add(ellipsoid({8, 0, -36}, {44, 38, 36}), 16); // throat
    head.add(neck(), 20);
    head.add(mirrored(ellipsoid({133, 11, -29}, {17, 11.5, 16})), 6); // whisker pads
    head.add(ellipsoid({146, 0, -10}, {9, 11, 10}), 5);
    head.carve(cone({157, 0, -20}, {151, 0, -42}, 0.7, 0.9), 2); // philtrum
    head.carve(mouthLine(mouthCut), 2);
    if (mouthCut) head.carve(mouthRoom(), 1);
    openEyes(head);
    head.add(mirrored(ear()), 7);
    head.add(grown(frontalis(), frontalisCover), 6);
    return head.field();
}

} // namespace

Field headSkin() {
    return head(false);
}

Field headSkinMouthCut() {
    return head(true);
}

Field behindLips() {
    const Box box(Vec3(70, -60, -70), Vec3(160, 60, -20));
    const auto distance = [deep = deepMuzzle()](const Vec3& p) {
        const double slab = std::abs(p.z() - mouthHeight(p.x())) - 15;
        const double rim = lipRim + cornerPocket * std::clamp((94 - p.x()) / 16, 0., 1.);
        return std::max({slab, 70 - p.x(), deep(p) + rim});
    };
    return {distance, box};
}

} // namespace doghead
