#include "tests/adversary/scenes/Bodies.h"

#include "tests/Shapes.h"

#include <cmath>
#include <numbers>

namespace adversary {

namespace {

std::size_t anyTriangle(Random& random, const TriangleMesh& mesh) {
    return static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())));
}

Vec3 middle(const TriangleMesh& mesh, std::size_t t) {
    return (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
}

/// Part of a circle about the origin, by the angle from -Z.
Profile arc(double radius, double from, double to, int steps) {
    Profile profile;
    for (int k = 0; k <= steps; ++k) {
        const double angle = from + (to - from) * k / steps;
        profile.emplace_back(angle == 0 ? 0 : radius * std::sin(angle), -radius * std::cos(angle));
    }
    return profile;
}

} // namespace

double logUniform(Random& random, double lower, double upper) {
    return lower * std::pow(upper / lower, random.in(0, 1));
}

TriangleMesh revolved(const Profile& profile, int segments) {
    TriangleMesh mesh;
    std::vector<int> first;
    for (const auto& [radius, height] : profile) {
        first.push_back(static_cast<int>(mesh.vertices.size()));
        for (int s = 0; s < (radius == 0 ? 1 : segments); ++s) {
            const double angle = 2 * std::numbers::pi * s / segments;
            mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
        }
    }
    for (std::size_t k = 0; k + 1 < profile.size(); ++k)
        for (int s = 0; s < segments; ++s) {
            const auto at = [&](std::size_t ring, int around) {
                return first[ring] + (profile[ring].first == 0 ? 0 : around % segments);
            };
            const int a = at(k, s), b = at(k, s + 1), c = at(k + 1, s + 1), d = at(k + 1, s);
            if (a != b) mesh.triangles.emplace_back(a, b, c);
            if (c != d) mesh.triangles.emplace_back(a, c, d);
        }
    return mesh;
}

TriangleMesh bumpyBall(double radius, int level, const std::vector<Vec3>& bumps, double height,
                       double width) {
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, level);
    for (Vec3& v : mesh.vertices) {
        double rise = 0;
        for (const Vec3& bump : bumps)
            rise = std::max(rise, std::exp(-(v - bump.normalized()).squaredNorm() / (width * width)));
        v *= radius + height * rise;
    }
    return mesh;
}

TriangleMesh needle(const Vec3& base, const Vec3& tip, double radius, int corners) {
    const Vec3 way = (tip - base).normalized(), side = way.unitOrthogonal(), other = way.cross(side);
    TriangleMesh mesh;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners;
        mesh.vertices.push_back(base + radius * (std::cos(angle) * side + std::sin(angle) * other));
    }
    mesh.vertices.push_back(tip);
    for (int k = 0; k < corners; ++k) mesh.triangles.emplace_back(k, (k + 1) % corners, corners);
    for (int k = 1; k + 1 < corners; ++k) mesh.triangles.emplace_back(0, k + 1, k);
    return mesh;
}

TriangleMesh shell(double outer, double inner, int level) {
    TriangleMesh mesh = ballMesh(Vec3::Zero(), outer, level);
    const TriangleMesh cavity = ballMesh(Vec3::Zero(), inner, level);
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
    for (const Tri& t : cavity.triangles)
        mesh.triangles.emplace_back(first + t[0], first + t[2], first + t[1]);
    return mesh;
}

TriangleMesh bowl(double radius, double wall, double opening, int rings, int segments) {
    Profile profile = arc(radius, 0, std::numbers::pi - opening, rings);
    if (wall > 0) {
        Profile inner = arc(radius - wall, 0, std::numbers::pi - opening, rings);
        profile.insert(profile.end(), inner.rbegin(), inner.rend());
    }
    return revolved(profile, segments);
}

TriangleMesh turnedBy(TriangleMesh mesh, const Eigen::Quaterniond& turn) {
    for (Vec3& v : mesh.vertices) v = turn * v;
    return mesh;
}

TriangleMesh movedBy(TriangleMesh mesh, const Vec3& way) {
    for (Vec3& v : mesh.vertices) v += way;
    return mesh;
}

Eigen::Quaterniond anyTurn(Random& random) {
    const Vec3 axis = random.direction();
    return Eigen::Quaterniond(Eigen::AngleAxisd(random.in(-std::numbers::pi, std::numbers::pi), axis));
}

TriangleMesh withSlivers(Random& random, TriangleMesh mesh, int count, double share) {
    for (int k = 0; k < count; ++k) {
        const std::size_t t = anyTriangle(random, mesh);
        const Tri old = mesh.triangles[t];
        const double along = random.below(2) ? random.in(0, 1) : share;
        const Vec3 at = (1 - share) * ((1 - along) * mesh.corner(t, 0) + along * mesh.corner(t, 1)) +
                        share * mesh.corner(t, 2);
        const int added = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(at);
        mesh.triangles[t] = {old[0], old[1], added};
        mesh.triangles.emplace_back(old[1], old[2], added);
        mesh.triangles.emplace_back(old[2], old[0], added);
    }
    return mesh;
}

TriangleMesh unwelded(Random& random, const TriangleMesh& mesh, double jitter) {
    TriangleMesh apart;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) apart.vertices.push_back(mesh.corner(t, k) + random.inBox(jitter));
        const int first = 3 * static_cast<int>(t);
        apart.triangles.emplace_back(first, first + 1, first + 2);
    }
    return apart;
}

TriangleMesh withTJunctions(Random& random, TriangleMesh mesh, int count) {
    for (int k = 0; k < count; ++k) {
        const std::size_t t = anyTriangle(random, mesh);
        const Tri old = mesh.triangles[t];
        const int added = static_cast<int>(mesh.vertices.size());
        const double along = random.in(0.2, 0.8);
        mesh.vertices.push_back((1 - along) * mesh.corner(t, 0) + along * mesh.corner(t, 1));
        mesh.triangles[t] = {old[0], added, old[2]};
        mesh.triangles.emplace_back(added, old[1], old[2]);
    }
    return mesh;
}

TriangleMesh opened(Random& random, const TriangleMesh& mesh, double reach) {
    const Vec3 place = middle(mesh, anyTriangle(random, mesh));
    TriangleMesh left{mesh.vertices, {}};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if ((middle(mesh, t) - place).norm() > reach) left.triangles.push_back(mesh.triangles[t]);
    return left.triangles.empty() ? mesh : left;
}

void addWire(Random& random, TriangleMesh& mesh, const Vec3& from, const Vec3& to) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(from);
    mesh.vertices.push_back(to);
    if (random.below(2)) {
        mesh.triangles.emplace_back(first, first + 1, first + 1);
        return;
    }
    mesh.vertices.push_back(0.5 * (from + to)); // in a line, up to the file's rounding
    mesh.triangles.emplace_back(first, first + 2, first + 1);
}

} // namespace adversary
