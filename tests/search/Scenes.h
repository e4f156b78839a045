#pragma once
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"
#include "tests/Joints.h"

#include <numbers>
#include <random>

/// Scenes made by code for the tests of search, reduction and verification, and for their benchmarks. One
/// draw follows the other, in braces or in statements of its own: operands and arguments are evaluated in an
/// order that differs from machine to machine, and a seed is to give the same scene on all.
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
            const tss::Vec3 v{in(-1, 1), in(-1, 1), in(-1, 1)};
            if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
        }
    }
    tss::Vec3 inBox(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }

private:
    std::mt19937_64 engine_;
};

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
        const Eigen::AngleAxisd more{random.in(0, turn), random.direction()};
        row.rotation = Eigen::Quaterniond(more) * row.rotation;
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
    scene.motion.base.translation() = 1.05 * away;
    for (int k = 0; k < dofs; ++k) {
        const int kind = random.below(paths ? 3 : 2);
        if (kind == 2) {
            const int rows = 3 + random.below(4);
            scene.motion.dofs.push_back(path(random, rows, 0.2, 0.2));
            continue;
        }
        const double size = kind == 0 ? 1 : random.in(0.5, 2);
        const tss::Vec3 axis = size * random.direction();
        const double lower = kind == 0 ? random.in(-0.8, -0.1) : random.in(-0.5, 0);
        const double upper = kind == 0 ? random.in(0.1, 0.8) : random.in(0, 0.5);
        scene.motion.dofs.push_back(kind == 0 ? joints::turn(random.inBox(1), axis, lower, upper)
                                              : joints::slide(axis, lower, upper));
    }
    return scene;
}

/// Two arches of teeth on their bone, about 100 units across, that a slide, a small turn and a hinge bring
/// together, as a jaw does. Each tooth has one or two cusps, chains of spheres that widen from the tip to the
/// root; the bone is a thick tube along the parabola that the teeth stand on.
inline Scene jawLike(int spheresA, int spheresB, std::uint64_t seed = 1) {
    Random random(seed);
    Scene scene;
    const auto onArch = [](double along) { return tss::Vec3(80 * (1 - along * along) + 20, 45 * along, 0); };
    const auto arch = [&](tss::SphereSet& set, int count, double side, double shift) {
        const int teeth = 14;
        for (int k = 0; k < count; ++k) {
            if (k % 5 < 2) {
                const tss::Vec3 bone = onArch(random.in(-1, 1)) + tss::Vec3(0, 0, side * 18);
                set.push_back({bone + random.inBox(2), random.in(2, 4)});
                continue;
            }
            const int tooth = random.below(teeth);
            const double along = (tooth + 0.5 + shift) / teeth * 2 - 1;
            const bool molar = std::abs(along) > 0.5;
            const double height = molar ? 9 : 10 + 2 * std::cos(5.0 * tooth);
            const double cusp = molar ? (random.below(2) ? 1.8 : -1.8) : 0;
            const double down = random.in(0, 1); // 0 at the tip
            const double radius = 0.7 + 2.0 * down;
            const double z = 15 - height + radius + down * (height - 3);
            set.push_back(
                {onArch(along) + tss::Vec3(0.1 * cusp, cusp * (1 - down), side * z) + random.inBox(0.6),
                 radius});
        }
    };
    arch(scene.a, spheresA, 1, 0);
    arch(scene.b, spheresB, -1, 0.3);
    const double degree = std::numbers::pi / 180;
    scene.motion.dofs = {joints::slide({1, 0, -0.2}, -1.5, 1.5),
                         joints::turn({0, 0, 0}, {0, 0, 1}, -1 * degree, 1 * degree),
                         joints::turn({-20, 0, 10}, {0, 1, 0}, -9 * degree, 12 * degree)};
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
