#pragma once
#include "tests/table/RandomTable.h"

#include <algorithm>

/// Two rows of balls that face each other across a joint at x = -80, 1 to 3 DOFs: the shape of a jaw, for
/// timings only. Lengths as of a skull in millimetres.
namespace jaw_like {

inline tss::Motion motion(int dofs) {
    tss::Motion m;
    for (int k = 0; k < dofs; ++k) {
        tss::Dof d;
        d.kind = k < 2 ? tss::DofKind::Rotation : tss::DofKind::Translation;
        d.axis = k == 0 ? tss::Vec3::UnitZ() : k == 1 ? tss::Vec3::UnitY() : tss::Vec3::UnitX();
        if (k < 2) d.origin = tss::Vec3(-80, 0, 0);
        d.lower = k == 0 ? -0.4 : k == 1 ? -0.1 : -3;
        d.upper = k == 0 ? 0.1 : k == 1 ? 0.1 : 3;
        if (k == 0) d.rest = -0.3;
        m.dofs.push_back(d);
    }
    return m;
}

/// The `tests` pairs that are nearest when closed.
inline tss::Table table(int dofs, std::size_t tests, double epsilon) {
    random_table::Random random(5);
    tss::SphereSet a, b;
    for (int i = 0; i < 200; ++i) {
        const double x = random_table::between(random, -30, 30), z = random_table::between(random, -15, 15);
        const double up = random_table::between(random, 3, 5), down = random_table::between(random, 3, 5);
        a.push_back({tss::Vec3(x, up, z), random_table::between(random, 1, 3)});
        b.push_back({tss::Vec3(x + random_table::between(random, -2, 2), -down, z),
                     random_table::between(random, 1, 3)});
    }
    std::vector<std::pair<double, tss::SpherePair>> order;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j)
            order.push_back(
                {(a[i].centre - b[j].centre).norm() - a[i].radius - b[j].radius, tss::SpherePair{i, j}});
    std::sort(order.begin(), order.end());
    std::vector<tss::SpherePair> pairs;
    for (std::size_t k = 0; k < tests; ++k) pairs.push_back(order[k].second);
    tss::Table t = tss::makeTable(a, b, pairs, {}, motion(dofs));
    t.epsilon = epsilon;
    return t;
}

} // namespace jaw_like
