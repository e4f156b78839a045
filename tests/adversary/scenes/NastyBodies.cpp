// Kinds that are nasty by what the bodies are or how they stand at rest.
#include "tests/Shapes.h"
#include "tests/adversary/scenes/Draws.h"

#include <cmath>

namespace adversary {

namespace {

/// Two bodies beside each other and a hinge between them, the usual stage.
void stage(Random& random, Draft& draft, double clearance) {
    const Vec3 way = putBeside(random, draft.a, draft.b, 0.3);
    bringTogether(draft.a, draft.b, way, clearance);
    draft.motion.dofs = {hingePast(random, way, 1)};
    if (random.below(3) == 0)
        draft.motion.dofs.push_back(
            slide(way + 0.3 * random.direction(), -random.in(0, 0.4), random.in(0, 0.3)));
}

} // namespace

// What bf17 is: free at rest with less than the tolerance between them, and a bump that a turn brings over.
Draft bumps(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    const double clearance = logUniform(random, 0.004, 0.06);
    draft.tolerance = clearance / logUniform(random, 0.25, 4);
    const double height = clearance * random.in(0.5, 6);
    const Vec3 away = (random.direction() + Vec3(0, 0, 1.2)).normalized();
    draft.b = bumpyBall(1, 2 + random.below(2), {away, random.direction()}, height, random.in(0.1, 0.4));
    switch (random.below(4)) {
    case 0:
        draft.a = boxMesh({-2, -2, -3}, {2, 2, -1});
        break;
    case 1:
        draft.a = movedBy(bumpyBall(1, 2, {random.direction(), {0, 0, 1}}, height, 0.3), {0, 0, -2.6});
        break;
    case 2:
        draft.a = bowl(1.35, 0.3, pi / 2 - 0.3, 6, 12);
        break;
    default:
        draft.a = movedBy(needle({0, 0, -2}, {0, 0, 0}, 0.6, 5), {0, 0, -1.3});
    }
    bringTogether(draft.a, draft.b, {0, 0, 1}, clearance);
    Vec3 centre = Vec3::Zero();
    for (const Vec3& v : draft.b.vertices) centre += v / double(draft.b.vertices.size());
    const double wide = random.in(0.5, pi);
    draft.motion.dofs = {
        turn(centre, (random.direction() + Vec3(1, 1, 0)).normalized(), -wide, random.in(0, wide))};
    if (random.below(3) == 0) draft.motion.dofs.push_back(turn(centre, {0, 0, 1}, -random.in(0, 1), 1));
    anySettings(random, draft);
    return draft;
}

Draft needles(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    const double thin = logUniform(random, 1e-3, 0.05);
    draft.tolerance = random.in(0.02, 0.1);
    draft.b = needle(Vec3::Zero(), random.in(1, 2) * random.direction(), thin, 3 + random.below(3));
    if (random.below(2)) draft.b = joined(draft.b, ballMesh(Vec3::Zero(), 0.3, 1));
    switch (random.below(3)) {
    case 0:
        draft.a = needle(-random.direction(), random.direction(), thin, 3);
        break;
    case 1:
        for (int k = 0; k < 4; ++k) {
            const Vec3 foot = random.inBox(0.7);
            draft.a = joined(draft.a, needle(foot, foot + 1.5 * random.direction(), thin, 3));
        }
        break;
    default:
        draft.a = anyBody(random);
    }
    stage(random, draft, random.below(2) ? 0.3 * draft.tolerance : random.in(0.02, 0.3));
    anySettings(random, draft);
    return draft;
}

Draft slivers(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    draft.a = withSlivers(random, anyBody(random), 2 + random.below(12), logUniform(random, 1e-9, 1e-2));
    draft.b = withSlivers(random, anyBody(random), 2 + random.below(12), logUniform(random, 1e-9, 1e-2));
    if (random.below(2)) { // flat as a leaf
        const double flat = logUniform(random, 1e-4, 0.1);
        for (Vec3& v : draft.b.vertices) v.y() *= flat;
    }
    stage(random, draft, random.in(0.01, 0.2));
    anySettings(random, draft);
    return draft;
}

Draft nested(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    const double clearance = logUniform(random, 0.005, 0.3);
    switch (random.below(5)) {
    case 0: // wholly inside a solid
        draft.a = random.below(2) ? ballMesh(Vec3::Zero(), 1.5, 2) : boxMesh({-1.5, -1.2, -1}, {1.5, 1.2, 1});
        draft.b = ballMesh(Vec3::Zero(), random.in(0.1, 0.6), 1);
        break;
    case 1: // shell in shell
        draft.a = shell(1.5, 1.3, 2);
        draft.b = shell(1.2 - clearance, 0.9, 1);
        break;
    case 2: // a bumpy ball in the cavity of a shell
        draft.a = shell(1.6, 1.4, 2);
        draft.b = bumpyBall(1.2 - clearance, 2, {random.direction()}, clearance * random.in(0.2, 3), 0.4);
        break;
    case 3: // ball in bowl
        draft.a = turnedBy(bowl(1.4, random.below(2) ? 0.2 : 0, random.in(0.6, 1.5), 6, 12), anyTurn(random));
        draft.b = ballMesh(Vec3::Zero(), 1.05 - clearance, 2);
        break;
    default: // a box in a box with walls
        draft.a = joined(boxMesh({-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}),
                         turnedBy(boxMesh({-1, -1, -1}, {1, 1, 1}), Eigen::Quaterniond::Identity()));
        for (std::size_t t = 12; t < 24; ++t) std::swap(draft.a.triangles[t][0], draft.a.triangles[t][1]);
        draft.b = boxMesh(-random.in(0.3, 0.7) * Vec3::Ones(), random.in(0.3, 0.7) * Vec3::Ones());
    }
    const Vec3 about = random.inBox(0.15);
    const double wide = random.in(0.3, 1.5);
    draft.motion.dofs = {turn(about, random.direction(), -wide, wide)};
    if (random.below(2))
        draft.motion.dofs.push_back(slide(random.direction(), -random.in(0, 0.5), random.in(0, 1.5)));
    anySettings(random, draft);
    return draft;
}

Draft wires(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    draft.a = anyBody(random);
    draft.b = anyBody(random);
    stage(random, draft, random.in(0.1, 0.4));
    for (TriangleMesh* mesh : {&draft.a, &draft.b}) {
        if (mesh == &draft.b && random.below(2)) continue;
        for (int k = 1 + random.below(3); k > 0; --k) {
            const Vec3 from = mesh->vertices[static_cast<std::size_t>(
                random.below(static_cast<int>(mesh->vertices.size())))];
            addWire(random, *mesh, from, random.below(5) ? Vec3(from + random.inBox(0.5)) : from);
        }
    }
    anySettings(random, draft);
    return draft;
}

Draft openMeshes(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.03, 0.12);
    draft.a = opened(random, ballMesh(Vec3::Zero(), 1, 2), random.in(0.2, 1.2));
    draft.b = anyBody(random);
    if (random.below(2))
        draft.b = opened(random, ballMesh(Vec3::Zero(), random.in(0.3, 1), 2), random.in(0.2, 1));
    if (random.below(3) == 0) { // B stands inside of A
        for (Vec3& v : draft.b.vertices) v *= 0.3;
        draft.motion.dofs = {slide(2 * random.direction(), -1, 1)};
    } else
        stage(random, draft, random.in(0.01, 0.2));
    anySettings(random, draft);
    return draft;
}

Draft overlaps(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    draft.a = anyBody(random);
    draft.b = anyBody(random);
    stage(random, draft, -logUniform(random, 1e-4, 0.5));
    anySettings(random, draft);
    return draft;
}

Draft touching(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.1);
    const double size = 0.25 * (1 + random.below(4)); // face on face, to the bit
    draft.a = boxMesh({-1, -1, -1}, {1, 1, 0});
    switch (random.below(4)) {
    case 0:
        draft.b = boxMesh({-size, -size, 0}, {size, size, 1});
        break;
    case 1: // an edge on a face
        draft.b = boxMesh({0, -size, 0}, {1, size, 1});
        for (Vec3& v : draft.b.vertices) v = Vec3(v.x() - v.z(), v.y(), v.x() + v.z());
        break;
    case 2: // a vertex on a face
        draft.b = movedBy(ballMesh(Vec3::Zero(), 0.5, 2), {0, 0, 0.5});
        break;
    default: // a pin through a hole of its size
        draft.a = revolved({{0.5, -0.5}, {1, -0.5}, {1, 0.5}, {0.5, 0.5}, {0.5, -0.5}}, 12);
        draft.b = revolved({{0, -1}, {0.5, -1}, {0.5, 1}, {0, 1}}, 12);
    }
    const double wide = random.in(0.2, 1);
    switch (random.below(3)) {
    case 0:
        draft.motion.dofs = {slide({1, 0, 0}, -wide, wide)};
        break;
    case 1:
        draft.motion.dofs = {turn({0, 0, 0}, {0, 0, 1}, -wide, wide)};
        break;
    default:
        draft.motion.dofs = {turn({0, 0, 0.5}, random.direction(), -wide, wide), slide({0, 0, 1}, 0, wide)};
    }
    anySettings(random, draft);
    return draft;
}

Draft plates(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.03, 0.1);
    const auto plate = [&] {
        const Vec3 half(random.in(0.3, 1), random.in(0.3, 1), logUniform(random, 1e-5, 0.05));
        return turnedBy(boxMesh(-half, half), anyTurn(random));
    };
    draft.a = plate();
    draft.b = random.below(3) ? plate() : anyBody(random);
    stage(random, draft, logUniform(random, 0.005, 0.2));
    anySettings(random, draft);
    return draft;
}

Draft components(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.03, 0.1);
    for (TriangleMesh* mesh : {&draft.a, &draft.b})
        for (int k = 2 + random.below(3); k > 0; --k) {
            TriangleMesh part = random.below(2)
                                    ? ballMesh(Vec3::Zero(), logUniform(random, 0.02, 0.5), 1)
                                    : boxMesh(-random.in(0.05, 0.4) * Vec3::Ones(), 0.3 * Vec3::Ones());
            *mesh = joined(*mesh, movedBy(turnedBy(part, anyTurn(random)), random.inBox(0.6)));
        }
    stage(random, draft, random.in(0.01, 0.2));
    anySettings(random, draft);
    return draft;
}

Draft cracks(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.03, 0.1);
    draft.a = anyBody(random);
    draft.b = anyBody(random);
    for (TriangleMesh* mesh : {&draft.a, &draft.b}) {
        if (random.below(2)) *mesh = withTJunctions(random, *mesh, 1 + random.below(6));
        if (random.below(2))
            *mesh = unwelded(random, *mesh, random.below(2) ? 0 : logUniform(random, 1e-7, 1e-3));
        for (int k = random.below(3); k > 0; --k) mesh->triangles.push_back(mesh->triangles.front());
    }
    stage(random, draft, random.in(0.01, 0.2));
    anySettings(random, draft);
    return draft;
}

// A joint as bodies have them: the head overlaps the socket that holds it, a little or all around.
Draft sockets(std::uint64_t seed) {
    Random random(seed);
    Draft draft;
    draft.tolerance = random.in(0.02, 0.08);
    const double clearance = random.in(-0.08, 0.06);
    draft.a = bowl(1.4, 0.35, random.in(0.8, 1.6), 6, 12);
    draft.b = joined(bumpyBall(1.05 - clearance, 2, {random.direction()}, random.in(0, 0.1), 0.3),
                     movedBy(boxMesh({-0.2, -0.2, 0}, {0.2, 0.2, 1.6}), {0, 0, 0.8}));
    const double wide = random.in(0.3, 1.3);
    draft.motion.dofs = {
        turn(Vec3::Zero(), (Vec3(1, 0, 0) + 0.3 * random.direction()).normalized(), -wide, wide)};
    if (random.below(3) == 0)
        draft.motion.dofs.push_back(turn(Vec3::Zero(), {0, 0, 1}, -0.5, random.in(0, 0.5)));
    anySettings(random, draft);
    return draft;
}

} // namespace adversary
