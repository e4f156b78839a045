#include "examples/doghead/anatomy/Anatomy.h"

#include "examples/doghead/implicit/Loft.h"

namespace doghead {
namespace {

/// From the eye sockets to the nose: a trapezoid, wide at the tooth row.
Field snout() {
    return loft({{46, -26, -2, 27, 0.10, 3.2},
                 {56, -28, 8, 28, 0.10, 3.0},
                 {66, -29, 30, 24, 0.36, 2.6},
                 {74, -29, 25, 23, 0.40, 2.7},
                 {82, -29, 16.5, 22, 0.40, 2.7},
                 {92, -28.5, 10, 18, 0.40, 2.8},
                 {104, -28.5, 5.5, 14.2, 0.40, 2.9},
                 {116, -28.5, 1.5, 12.6, 0.42, 2.9},
                 {123, -28, -1.5, 12, 0.42, 2.8},
                 {128, -28, -6, 11.5, 0.36, 2.7},
                 {132, -27.5, -13, 10, 0.30, 2.6},
                 {137.5, -26.5, -20, 7, 0.2, 2.2}});
}

/// The side of the face below the eye, flaring out towards the arch.
Field cheek() {
    return loft({{48, -23, 3, 31, 0, 3},
                 {54, -25, 4, 34.5, 0, 3},
                 {61, -27, 7, 35.2, 0.02, 2.8},
                 {69, -28, 9, 31.5, 0.12, 2.6},
                 {78, -28, 5, 27, 0.16, 2.6},
                 {90, -27, 0, 20.5, 0.16, 2.6}});
}

/// Between the eyes: a narrow wall below, the frontal shield above.
Field frontal() {
    return Sculpture()
        .add(loft({{16, -12, 47, 19, 0.05, 2.6},
                   {30, -14, 48, 16.5, -0.16, 2.8},
                   {42, -16, 47, 15, -0.28, 3.0},
                   {52, -16, 44.5, 14.5, -0.32, 3.0},
                   {62, -16, 38, 14, -0.18, 2.8},
                   {72, -16, 27, 14, 0, 2.6}}))
        .add(mirrored(ellipsoid({49, 10, 34}, {18, 11, 11})), 6)
        .add(mirrored(cone({52, 17, 37.5}, {46, 26.5, 37}, 5, 2.2)), 5) // postorbital process
        .field();
}

Field brainCase() {
    const Box behind(Vec3(-70, -40, -30), Vec3(-26, 40, 70));
    return Sculpture()
        .add(ellipsoid({1, 0, 22}, {43, 29.5, 28}))
        .add(ellipsoid({-16, 0, 17}, {17, 24, 20}), 8)
        .add(ellipsoid({12, 0, 0}, {34, 17, 8}), 10)
        .carve(halfSpace({-29.5, 0, 20}, {1, 0, 0.05}, behind), 6) // the back of the head is flat
        .field();
}

Field crests() {
    const Field sagittal = ribbon({{{40, 0, 44}, 1.5, 3},
                                   {{22, 0, 47.5}, 1.5, 4},
                                   {{0, 0, 50}, 1.5, 5},
                                   {{-18, 0, 49.5}, 1.5, 5.5},
                                   {{-28, 0, 46}, 1.6, 4}},
                                  Vec3::UnitZ());
    const Field nuchal = ribbon({{{-30.5, 0, 47}, 1.5, 3.5},
                                 {{-30, 9, 42}, 1.5, 3.4},
                                 {{-28.5, 17, 33}, 1.5, 3.2},
                                 {{-25, 23, 24}, 1.6, 3.2},
                                 {{-17, 27.5, 16}, 1.8, 3.2},
                                 {{-8, 31, 10}, 2.4, 3}},
                                Vec3(-1, 0.5, 0.6));
    const Field temporalLine = tube({Vec3(46, 25, 38), Vec3(39, 15, 44), Vec3(30, 4, 46.5)}, {1.8, 1.5, 1.3});
    return Sculpture().add(sagittal).add(mirrored(nuchal), 2).add(mirrored(temporalLine), 2).field();
}

Field zygomaticArch() {
    const Field bow = ribbon({{{70, 24, -11}, 4, 11},
                              {{63, 31, -8}, 3.8, 11},
                              {{56, 35.8, -3.5}, 3, 10},
                              {{47, 40.6, 3}, 2.3, 8},
                              {{37, 44.3, 9}, 1.9, 6.6},
                              {{24, 46.6, 12.3}, 1.8, 6},
                              {{12, 45.4, 12}, 2, 5.6},
                              {{3, 40.5, 9.5}, 3, 4.6},
                              {{-5, 32, 8}, 4, 4}},
                             Vec3::UnitZ());
    return Sculpture().add(bow).add(cone({42, 42.3, 9}, {43.5, 41.8, 17}, 3, 1.4), 5).field();
}

/// Root of the arch with the socket's roof, and the process behind it that keeps the condyle from slipping
/// back.
Field jointRoot() {
    return Sculpture()
        .add(ellipsoid({0, 34, 8.5}, {12, 11, 5}))
        .add(cone({-9.8, 32.5, 5}, {-10.4, 32, -5}, 4.6, 2.8), 3)
        .field();
}

/// The room of the condyle over all turns of the jaw: a roller drawn out fore and aft.
Field socketRoom() {
    const double radius = condyleRadius + socketClearance, shift = 4.2;
    const Field roller = cone({0, condyleInner - 6, 0}, {0, condyleOuter + 6, 0}, radius, radius);
    return stretched(roller, Vec3(0, 35, 0), Vec3((radius + shift) / radius, 1, 1));
}

Field skullBase() {
    const Field bulla = ellipsoid({-7, 18.5, -3}, {10, 7.5, 7});
    const Field paroccipital = cone({-20, 20, 4}, {-19, 20.5, -9}, 4, 1.6);
    const Field condyle = turned(ellipsoid({-31, 8.5, 4}, {5, 4.5, 7.5}), {-31, 8.5, 4}, Vec3::UnitX(), -30);
    const Field pterygoid = ribbon(
        {{{56, 14, -14}, 2, 9}, {{42, 12, -11}, 1.5, 7}, {{28, 9.5, -9}, 1.3, 6.5}, {{20, 8, -9}, 1.2, 4}},
        Vec3::UnitZ());
    return Sculpture()
        .add(mirrored(bulla))
        .add(mirrored(paroccipital), 3)
        .add(mirrored(condyle), 2)
        .add(mirrored(pterygoid), 3)
        .add(ellipsoid({-22, 0, 6}, {12, 13, 7}), 5)
        .field();
}

/// What is hollow: eye sockets, nose, palate, the airway behind it, the hole of the spinal cord, small
/// foramina.
void hollow(Sculpture& bone) {
    bone.carve(mirrored(turned(ellipsoid({57, 31, 21}, {15, 16, 16}), {57, 31, 21}, Vec3::UnitZ(), -25)), 4);
    bone.carve(mirrored(ellipsoid({44, 28, 0}, {14, 12, 18})), 4);
    const Field nostril = turned(ellipsoid({130, 0, -11}, {17, 6.4, 7.5}), {130, 0, -11}, Vec3::UnitY(), 12);
    bone.carve(nostril, 1.5);
    bone.carve(ellipsoid({128, 0, -6}, {8, 4, 7}), 2);
    bone.carve(loft({{44, -40, -21, 17, 0.1, 2.4},
                     {70, -40, -22, 17.5, 0.1, 2.4},
                     {95, -40, -22.5, 12, 0.1, 2.4},
                     {115, -40, -23.5, 9.5, 0.1, 2.4},
                     {129, -40, -25.5, 8, 0.1, 2.4}}),
               3);
    bone.carve(ellipsoid({30, 0, -13}, {30, 7.5, 8}), 3);
    bone.carve(ellipsoid({-36, 0, 10}, {14, 8.5, 7.5}), 2);
    bone.carve(mirrored(turned(ellipsoid({92, 20.5, -9}, {5, 2, 2.6}), {92, 20.5, -9}, Vec3::UnitZ(), -20)),
               1.5);
    bone.carve(mirrored(turned(ellipsoid({-8, 27, 2}, {3, 5, 3}), {-8, 27, 2}, Vec3::UnitZ(), 20)),
               1.5);                                                    // ear canal
    bone.carve(mirrored(ellipsoid({122, 4.2, -24}, {5, 1.8, 5})), 1.5); // palatine fissures
}

} // namespace

Field cranium() {
    return Sculpture().add(brainCase()).add(frontal(), 8).field();
}

Field skull() {
    Sculpture bone;
    bone.add(cranium()).add(snout(), 8).add(cheek(), 8);
    bone.add(mirrored(tube({Vec3(120, 15, -25), Vec3(114, 14, -15), Vec3(107, 12, -6)}, {4.6, 4.6, 3.4})),
             4); // canine root
    const Field alveolar =
        tube({Vec3(47, 26, -21), Vec3(56, 27, -22.5), Vec3(71, 25.6, -23.5), Vec3(87, 21, -23.5),
              Vec3(99, 17.6, -23), Vec3(110, 15.8, -22.5), Vec3(119, 15.3, -22), Vec3(127, 11.5, -22),
              Vec3(132, 6, -22), Vec3(133.5, 0, -22)},
             {4.2, 5.0, 4.8, 4.0, 3.5, 3.5, 4.4, 3.8, 3.3, 3.3});
    hollow(bone);
    bone.add(mirrored(alveolar), 6);
    bone.add(mirrored(zygomaticArch()), 5);
    bone.add(crests(), 3);
    bone.add(skullBase(), 4);
    bone.add(mirrored(jointRoot()), 4);
    bone.add(loft({{86, -22, 5, 0.9, 0, 2}, {126, -22, -8, 0.9, 0, 2}}), 1.5); // nasal septum
    bone.carve(mirrored(socketRoom()), 1);
    bone.add(upperTeeth(), 0.6);
    return bone.field();
}

} // namespace doghead
