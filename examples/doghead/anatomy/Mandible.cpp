#include "examples/doghead/anatomy/Anatomy.h"

#include "examples/doghead/implicit/Curve.h"

namespace doghead {
namespace {

/// The left half of the body, from the chin to below the joint.
Field horizontalBody() {
    return sweep({{{130.5, 4.5, -45}, 4.4, 4},
                  {{123, 8.2, -48}, 5, 6},
                  {{112, 12, -50}, 4.7, 7.4},
                  {{98, 15, -50.6}, 4.5, 8.3},
                  {{80, 18.2, -50.4}, 4.7, 8.9},
                  {{62, 20.8, -48.6}, 5.2, 9.4},
                  {{46, 23.6, -45.2}, 5.3, 9.8},
                  {{32, 27, -40.5}, 4.8, 9.5},
                  {{18, 30.5, -34.5}, 4, 7.5},
                  {{8, 33, -30}, 3.2, 5}},
                 Vec3::UnitZ());
}

/// Ramus with the coronoid process: a plate that leans outwards.
Field ramus() {
    return plate({{{43, -34},
                   {37, -18},
                   {34.5, 0},
                   {34, 14},
                   {30, 21.5},
                   {23, 21},
                   {18, 12},
                   {13.5, 1},
                   {8, -4.5},
                   {3, -6},
                   {3, -14},
                   {5, -24},
                   {6, -34},
                   {20, -43},
                   {34, -47}},
                  37.7,
                  -0.27,
                  0.16,
                  2.4});
}

} // namespace

Field mandible() {
    Sculpture half;
    half.add(horizontalBody());
    half.add(ramus(), 5);
    half.carve(turned(ellipsoid({22, 36.4, -12}, {9, 3, 17}), {22, 36.4, -12}, Vec3::UnitX(), -9),
               5); // masseteric fossa
    half.add(cone({0, condyleInner, 0}, {0, condyleOuter, 0}, condyleRadius, condyleRadius));
    half.add(cone({1.2, 35.5, -2}, {9, 34.2, -16}, 3.4, 3.6), 6); // its neck
    half.add(tube({Vec3(14, 31.5, -34), Vec3(3, 34, -33), Vec3(-5.5, 35, -30.5)}, {4.6, 3.2, 1.5}),
             4);                                                 // angle
    half.carve(ellipsoid({108, 18.4, -51}, {2.6, 2, 1.8}), 1.2); // mental foramina
    half.carve(ellipsoid({99, 20.2, -50}, {1.8, 1.6, 1.4}), 1);

    Sculpture bone;
    bone.add(mirrored(half.field()));
    bone.add(ellipsoid({120, 0, -49.5}, {13, 9, 5.2}), 6); // symphysis
    bone.add(lowerTeeth(), 0.6);
    return bone.field();
}

} // namespace doghead
