#pragma once
#include "bake/table/Query.h"

#include <random>

/// Random motions and tables for property tests: every draw comes from the generator given, so that a printed
/// seed repeats a case, and one draw follows the other (operands and arguments are evaluated in an order that
/// differs from machine to machine), so that it is the same case everywhere.
namespace random_table {

using Random = std::mt19937_64;

inline double between(Random& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
inline tss::Vec3 inBall(Random& random, double radius) {
    for (;;) {
        const tss::Vec3 v{between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
        if (v.squaredNorm() <= 1) return radius * v;
    }
}
inline tss::Vec3 direction(Random& random) {
    for (;;) {
        const tss::Vec3 v = inBall(random, 1);
        if (v.norm() > 0.1) return v.normalized();
    }
}

inline Eigen::AngleAxisd turn(Random& random, double most) {
    const double angle = between(random, 0, most);
    return {angle, direction(random)};
}

inline tss::Dof path(Random& random, double size) {
    tss::Dof dof;
    dof.kind = tss::DofKind::Path;
    dof.lower = 0;
    dof.upper = 1;
    dof.frame.translation() = inBall(random, size);
    dof.frame.linear() = turn(random, 3).toRotationMatrix();
    tss::PathRow row;
    for (int i = 0; i <= 4; ++i) {
        row.value = i == 4 ? 1.0 : 0.25 * i + (i > 0 ? between(random, -0.05, 0.05) : 0);
        dof.path.push_back(row);
        row.translation += inBall(random, 0.1 * size);
        row.rotation = row.rotation * Eigen::Quaterniond(turn(random, 0.15));
    }
    return dof;
}

/// One DOF whose range moves points near the origin by some tenths of size.
inline tss::Dof dof(Random& random, tss::DofKind kind, double size) {
    if (kind == tss::DofKind::Path) return path(random, size);
    tss::Dof d;
    d.kind = kind;
    d.axis = direction(random);
    const bool turn = kind == tss::DofKind::Rotation;
    if (turn) d.origin = inBall(random, size);
    const double range = turn ? between(random, 0.1, 0.8) : between(random, 0.1, 0.4) * size;
    d.lower = -between(random, 0.1, 0.9) * range;
    d.upper = d.lower + range;
    return d;
}

inline tss::Motion motion(Random& random, int dofCount, double size, bool paths = true) {
    tss::Motion m;
    for (int k = 0; k < dofCount; ++k) {
        const double draw = between(random, 0, 1);
        const tss::DofKind kind = draw < 0.6             ? tss::DofKind::Rotation
                                  : draw < 0.9 || !paths ? tss::DofKind::Translation
                                                         : tss::DofKind::Path;
        m.dofs.push_back(dof(random, kind, size));
    }
    m.base.translation() = inBall(random, 0.2 * size);
    m.base.linear() = turn(random, 3).toRotationMatrix();
    return m;
}

/// Values in the box of the limits.
inline std::vector<double> values(Random& random, const tss::Motion& m) {
    std::vector<double> q;
    for (const tss::Dof& d : m.dofs) q.push_back(between(random, d.lower, d.upper));
    return q;
}

/// nb spheres of B; na of A, each set beside some sphere of B at a random pose so that they touch in part of
/// the limits; all pairs are tests. size: of the whole.
inline tss::Table table(Random& random, const tss::Motion& m, int na, int nb, double size) {
    tss::SphereSet a, b;
    for (int j = 0; j < nb; ++j)
        b.push_back({inBall(random, 0.5 * size), size * between(random, 0.01, 0.06)});
    for (int i = 0; i < na; ++i) {
        const tss::Sphere& s = b[random() % b.size()];
        const double radius = size * between(random, 0.01, 0.06);
        const tss::Vec3 x = tss::pose(m, values(random, m)) * s.centre;
        const double apart = radius + s.radius + size * between(random, -0.01, 0.03);
        a.push_back({x + apart * direction(random), radius});
    }
    std::vector<tss::SpherePair> pairs;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j) pairs.push_back({i, j});
    return tss::makeTable(a, b, pairs, {}, m);
}

/// A random table of 1 to maxDofs DOFs over sizes from 1e-3 to 1e3.
inline tss::Table anyTable(Random& random, int maxDofs = 3) {
    const double size = std::pow(10.0, between(random, -3, 3));
    const int d = 1 + static_cast<int>(random() % maxDofs);
    const tss::Motion m = motion(random, d, size);
    const int na = 2 + int(random() % 9), nb = 2 + int(random() % 9);
    return table(random, m, na, nb, size);
}

} // namespace random_table
