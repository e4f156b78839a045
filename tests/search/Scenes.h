#pragma once
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"

#include <numbers>
#include <random>

/// Scenes made by code for the tests of search, reduction and verification, and for their benchmarks.
namespace scenes {

struct Scene {
    tss::SphereSet a, b;
    tss::Motion motion;
};

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double in(double lower, double upper) {
        return lower + (upper - lower) * (double(engine_() >> 11) * 0x1p-53);
    }
    int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    tss::Vec3 direction() {
        for (;;) {
            const tss::Vec3 v(in(-1, 1), in(-1, 1), in(-1, 1));
            if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
        }
    }
    tss::Vec3 inBox(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }

private:
    std::mt19937_64 engine_;
};

inline tss::Dof rotation(const tss::Vec3& origin, const tss::Vec3& axis, double lower, double upper) {
    tss::Dof dof;
    dof.name = "turn";
    dof.origin = origin;
    dof.axis = axis.normalized();
    dof.lower = lower;
    dof.upper = upper;
    return dof;
}

inline tss::Dof translation(const tss::Vec3& axis, double lower, double upper) {
    tss::Dof dof;
    dof.name = "slide";
    dof.kind = tss::DofKind::Translation;
    dof.axis = axis;
    dof.lower = lower;
    dof.upper = upper;
    return dof;
}

/// A path of `rows` poses that bends and turns at random; every row moves about `step` and turns about
/// `turn`.
inline tss::Dof path(Random& random, int rows, double step, double turn) {
    tss::Dof dof;
    dof.name = "path";
    dof.kind = tss::DofKind::Path;
    tss::PathRow row;
    for (int k = 0; k < rows; ++k) {
        row.value = k;
        dof.path.push_back(row);
        row.translation += step * random.direction();
        row.rotation =
            Eigen::Quaterniond(Eigen::AngleAxisd(random.in(0, turn), random.direction())) * row.rotation;
    }
    dof.frame.translation() = random.inBox(1);
    dof.lower = 0;
    dof.upper = rows - 1;
    return dof;
}

/// Two clouds of spheres, about a unit across, that a chain of `dofs` random DOFs brings together in part of
/// its range. With paths when asked for.
inline Scene randomScene(std::uint64_t seed, int dofs, int spheres, bool paths = false) {
    Random random(seed);
    Scene scene;
    for (auto* set : {&scene.a, &scene.b})
        for (int k = 0; k < spheres; ++k) set->push_back({random.inBox(0.5), random.in(0.02, 0.12)});
    const tss::Vec3 away = random.direction();
    scene.motion.base.translation() = 1.3 * away;
    for (int k = 0; k < dofs; ++k) {
        const int kind = random.below(paths ? 3 : 2);
        if (kind == 0)
            scene.motion.dofs.push_back(
                rotation(random.inBox(1), random.direction(), random.in(-0.8, -0.1), random.in(0.1, 0.8)));
        else if (kind == 1)
            scene.motion.dofs.push_back(
                translation(random.in(0.5, 2) * random.direction(), random.in(-0.5, 0), random.in(0, 0.5)));
        else
            scene.motion.dofs.push_back(path(random, 3 + random.below(4), 0.2, 0.2));
    }
    return scene;
}

/// Two arches of teeth, about 100 units across, that a hinge with a large turn, a second with a small one and
/// a slide bring together, as a jaw does. The spheres lie on bumpy tooth-like surfaces along a parabola.
inline Scene jawLike(int spheresA, int spheresB, std::uint64_t seed = 1) {
    Random random(seed);
    Scene scene;
    const auto arch = [&](tss::SphereSet& set, int count, double side) {
        const int teeth = 14;
        for (int k = 0; k < count; ++k) {
            const int tooth = random.below(teeth);
            const double along = (tooth + 0.5) / teeth * 2 - 1; // -1 .. 1 from right to left
            const double x = 80 * (1 - along * along) + 20, y = 45 * along;
            const double width = 3.2, height = 9 + 2 * std::cos(3.0 * tooth);
            const double u = random.in(-1, 1), v = random.in(-1, 1), w = random.in(0, 1);
            // Cusps: the crown is a bumpy cap on a block that ends in the bone.
            const double crown =
                height * (0.75 + 0.25 * std::cos(4 * u) * std::cos(4 * v)) * (1 - 0.3 * (u * u + v * v) / 2);
            const double z = w < 0.7 ? crown : random.in(0, crown);
            set.push_back({{x + width * u, y + width * v, side * (12 - z)}, random.in(0.5, 1.1)});
        }
    };
    arch(scene.a, spheresA, 1);
    arch(scene.b, spheresB, -1);
    const double degree = std::numbers::pi / 180;
    scene.motion.dofs = {translation({1, 0, -0.2}, -4, 4),
                         rotation({0, 0, 0}, {0, 0, 1}, -3 * degree, 3 * degree),
                         rotation({-20, 0, 10}, {0, 1, 0}, -4 * degree, 25 * degree)};
    return scene;
}

/// A pose drawn uniformly from the box of the limits, planes respected.
inline std::vector<double> randomPose(Random& random, const tss::Motion& motion) {
    for (;;) {
        std::vector<double> q;
        for (const tss::Dof& dof : motion.dofs) q.push_back(random.in(dof.lower, dof.upper));
        if (tss::withinLimits(motion, q)) return q;
    }
}

} // namespace scenes
