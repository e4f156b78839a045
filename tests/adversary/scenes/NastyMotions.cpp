// Kinds that are nasty by how the bodies move and by the numbers that say so.
#include "tests/Shapes.h"
#include "tests/adversary/scenes/Draws.h"

#include <cmath>

namespace adversary {

namespace {

/// Two bodies `clearance` apart; returns the way from A to B.
Vec3 stand(Random& random, Draft& draft, double clearance) {
    draft.a = anyBody(random);
    draft.b = anyBody(random);
    const Vec3 way = putBeside(random, draft.a, draft.b, 0.3);
    bringTogether(draft.a, draft.b, way, clearance);
    return way;
}

Dof someDof(Random& random, const Vec3& way, double range) {
    if (random.below(2)) {
        Dof dof = hingePast(random, way, 1);
        dof.lower *= range;
        dof.upper *= range;
        return dof;
    }
    const double scale = random.below(3) == 0 ? logUniform(random, 1e-3, 1e3) : 1;
    const Vec3 axis = (way + 0.6 * random.direction()).normalized();
    return slide(scale * axis, -random.in(0, 1) * range / scale, random.in(0, 0.3) * range / scale);
}

} // namespace

Draft farAxes(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    const Vec3 way = stand(random, draft, random.in(0.02, 0.3));
    const double far = logUniform(random, 1e2, 1e5);
    const Vec3 side = way.unitOrthogonal();
    const double reach = random.in(0.2, 1.5) / far;
    draft.motion.dofs = {turn(far * side, way.cross(side), -reach, reach)};
    if (random.below(2)) draft.motion.dofs.push_back(someDof(random, way, 0.5));
    anySettings(random, draft);
    return draft;
}

Draft farBodies(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    const Vec3 way = stand(random, draft, random.in(0.05, 0.3));
    draft.motion.dofs = {hingePast(random, way, 1)};
    if (random.below(3) == 0) draft.motion.dofs.push_back(someDof(random, way, 0.5));
    const Vec3 off = logUniform(random, 1e2, 1e5) * random.direction();
    draft.a = movedBy(draft.a, off);
    draft.b = movedBy(draft.b, off);
    if (random.below(3)) // else the axis stays at home
        for (Dof& dof : draft.motion.dofs) dof.origin += off;
    else
        for (Dof& dof : draft.motion.dofs)
            if (dof.kind == tss::DofKind::Rotation) {
                dof.lower /= off.norm();
                dof.upper /= off.norm();
            }
    anySettings(random, draft);
    return draft;
}

Draft tinyRanges(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    const double range = logUniform(random, 1e-8, 1e-3);
    const Vec3 way = stand(random, draft, random.below(2) ? range * random.in(0.1, 2) : random.in(0.01, 0.1));
    draft.motion.dofs = {someDof(random, way, range)};
    if (random.below(2)) draft.motion.dofs.push_back(someDof(random, way, logUniform(random, 1e-8, 1)));
    anySettings(random, draft);
    return draft;
}

Draft fullTurns(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.04, 0.12);
    const Vec3 way = stand(random, draft, random.in(0.05, 0.4));
    draft.motion.dofs = {turn(way * random.in(0.5, 2) + random.inBox(0.5), random.direction(), -pi, pi)};
    if (random.below(3) == 0) draft.motion.dofs[0].lower = 0, draft.motion.dofs[0].upper = 2 * pi;
    if (random.below(4) == 0) draft.motion.dofs.push_back(someDof(random, way, 0.3));
    anySettings(random, draft);
    return draft;
}

Draft corneredPaths(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.04, 0.12);
    const Vec3 way = stand(random, draft, random.in(0.02, 0.3));
    Dof path = scenes::path(random, 3 + random.below(5), random.in(0.05, 0.5), random.in(0, 1));
    const double scale = random.below(3) == 0 ? logUniform(random, 1e-3, 1e3) : 1;
    for (tss::PathRow& row : path.path) row.value *= scale;
    if (random.below(2)) // a row that is hardly a step, and one that goes straight back
        path.path[1].value = path.path[0].value + 1e-6 * scale;
    if (random.below(2)) path.path[2].translation = path.path[0].translation;
    path.lower = path.path.front().value;
    path.upper = path.path.back().value;
    path.rest = path.path[static_cast<std::size_t>(random.below(2))].value;
    path.frame.linear() = anyTurn(random).toRotationMatrix();
    draft.motion.dofs = {path};
    if (random.below(3) == 0) draft.motion.dofs.push_back(someDof(random, way, 0.3));
    anySettings(random, draft);
    return draft;
}

Draft planes(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.04, 0.1);
    draft.a = movedBy(anyBody(random), {0, 0, -1.2});
    draft.b = movedBy(anyBody(random), {0, 0, 1.2});
    bringTogether(draft.a, draft.b, {0, 0, 1}, random.in(0.02, 0.3));
    // DOFs of one joint: a plane couples those of one.
    draft.motion.dofs = {slide({0, 0, 1}, -random.in(0.2, 0.8), random.in(0.1, 0.5)),
                         slide({1, 0, 0}, -random.in(0.1, 0.5), random.in(0.1, 0.5))};
    if (random.below(2))
        draft.motion.dofs[1] = turn({0, 0, 0}, {0, 1, 0}, -random.in(0.1, 1), random.in(0.1, 1));
    const int count = 1 + random.below(3);
    for (int k = 0; k < count; ++k)
        draft.motion.planes.push_back({{random.in(-1, 1), random.in(-1, 1)}, random.in(0.02, 0.3)});
    switch (random.below(5)) {
    case 0: // nothing is left: a plane beyond the box
        draft.motion.planes.push_back({{1, 0}, draft.motion.dofs[0].lower - random.in(0.01, 1)});
        draft.refused = true;
        break;
    case 1: // nothing is left: two that contradict each other
        draft.motion.planes.push_back({{1, 1}, -0.05});
        draft.motion.planes.push_back({{-1, -1}, random.in(0, 0.04)});
        draft.refused = true;
        break;
    case 2: // a wedge
        draft.motion.planes.push_back({{1, -1}, 1e-3});
        draft.motion.planes.push_back({{-1, 1}, 1e-3});
        break;
    default:
        break;
    }
    anySettings(random, draft);
    return draft;
}

Draft chains(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.06, 0.15);
    const Vec3 way = stand(random, draft, random.in(0.05, 0.3));
    const int count = 2 + random.below(3);
    for (int k = 0; k < count; ++k)
        draft.motion.dofs.push_back(someDof(random, way, count == 4 ? 0.25 : 0.5));
    anySettings(random, draft);
    return draft;
}

Draft units(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    draft.unit = logUniform(random, 1e-6, 1e6);
    draft.metersPerUnit = random.below(2) ? 1 / draft.unit : logUniform(random, 1e-6, 1e3);
    const Vec3 way = stand(random, draft, random.in(0.02, 0.3));
    draft.motion.dofs = {hingePast(random, way, 1)};
    if (random.below(2)) draft.motion.dofs.push_back(someDof(random, way, 0.5));
    anySettings(random, draft);
    return draft;
}

// Q is one pose, or nearly: the bodies there apart, touching or in each other.
Draft fixed(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    const double depth = random.below(2) ? random.in(0.01, 0.2) : random.below(2) ? 0 : -random.in(0.01, 0.5);
    const Vec3 way = stand(random, draft, depth);
    Dof dof = random.below(2) ? hingePast(random, way, 1) : slide(way, -0.1, 0.1);
    dof.lower = dof.upper = dof.rest = random.below(2) ? 0 : random.in(-0.05, 0.05);
    draft.motion.dofs = {dof};
    if (random.below(4) == 0) draft.motion.dofs.push_back(someDof(random, way, 0.3));
    anySettings(random, draft);
    return draft;
}

} // namespace adversary
