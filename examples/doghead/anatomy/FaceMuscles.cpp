#include "examples/doghead/anatomy/Anatomy.h"

#include "examples/doghead/implicit/Curve.h"

namespace doghead {
namespace {

constexpr double under = 0.6; ///< of the skin over a muscle, mm

/// A strap along points near the skin: each is drawn to the depth at which the strap lies right under it.
Strap strap(const Field& skin, const std::string& name, const std::vector<Vec3>& along, double halfWidth,
            double halfThickness, double contraction) {
    Strap result{name, {}, {}, contraction};
    std::vector<Station> stations;
    Vec3 up = Vec3::Zero();
    for (std::size_t i = 0; i < along.size(); ++i) {
        Vec3 p = along[i];
        for (int step = 0; step < 60; ++step)
            p -= 0.7 * (skin(p) + under + halfThickness) * normal(skin, p, 0.5);
        up += normal(skin, p, 0.5);
        const bool end = i == 0 || i + 1 == along.size();
        result.fibre.push_back(p);
        stations.push_back(
            {p, end ? 0.45 * halfWidth : halfWidth, end ? 0.6 * halfThickness : halfThickness});
    }
    result.field = Sculpture().add(sweep(stations, up.normalized())).keep(grown(skin, -under), 0.8).field();
    return result;
}

} // namespace

std::vector<Strap> faceStraps() {
    const Field skin = headSkin();
    return {
        strap(skin, "Zygomaticus", {{14, 48, 2}, {34, 46, -12}, {54, 40, -26}, {72, 33, -36}}, 6, 1.5, 0.25),
        strap(skin, "LevatorNasolabialis",
              {{66, 11, 34}, {80, 15, 22}, {96, 19, 6}, {110, 22, -10}, {118, 22, -24}}, 6.5, 1.3, 0.22),
        strap(skin, "OrbicularisOris",
              {{76, 33, -31}, {92, 28, -34}, {110, 24, -36}, {128, 20, -33}, {142, 12, -28}}, 4.5, 1.4, 0.18),
        strap(skin, "RetractorAnguliOculi", {{22, 44, 22}, {36, 41, 22}, {50, 36, 20}}, 4.5, 1.2, 0.2),
        strap(skin, "Masseter", {{40, 44, -2}, {32, 46, -18}, {22, 42, -36}, {12, 38, -48}}, 11, 4, 0.15),
        strap(skin, "Temporalis", {{-24, 22, 40}, {-8, 30, 42}, {8, 36, 36}, {22, 40, 26}}, 12, 3.5, 0.15),
    };
}

Strap mirroredStrap(const Strap& strap) {
    Strap other = strap;
    for (Vec3& p : other.fibre) p.y() = -p.y();
    Box box(strap.field.box);
    box.min().y() = -strap.field.box.max().y();
    box.max().y() = -strap.field.box.min().y();
    other.field = {[field = strap.field](const Vec3& p) { return field(Vec3(p.x(), -p.y(), p.z())); }, box};
    return other;
}

} // namespace doghead
