#include "bake/geometry/Polygon.h"

#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

using Outline = std::vector<Vec3>;

/// The corners of a polygon in the plane z = 0.
Outline outline(std::initializer_list<std::pair<double, double>> corners) {
    Outline result;
    for (const auto& [x, y] : corners) result.emplace_back(x, y, 0);
    return result;
}

/// A comb whose teeth point up: every second corner of its upper side is concave, many lie in a line.
Outline comb(int teeth) {
    Outline corners = outline({{0, 0}, {2.0 * teeth, 0}});
    for (int k = teeth; k > 0; --k)
        for (const auto& [x, y] :
             {std::pair(2 * k, 1.0), {2 * k - 1, 1.0}, {2 * k - 1, 0.1}, {2 * k - 2, 0.1}})
            corners.emplace_back(x, y, 0);
    return corners;
}

Outline star(std::mt19937_64& random, int corners) {
    Outline result;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners, far = uniform(random, 0.1, 1);
        result.emplace_back(far * std::cos(angle), far * std::sin(angle), 0);
    }
    return result;
}

/// In floats, as files have them, so that nothing is quite in one plane or line.
Outline turnedAbout(const Outline& corners, std::mt19937_64& random) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(Eigen::Vector4d(uniform(random, -1, 1), uniform(random, -1, 1),
                                           uniform(random, -1, 1), uniform(random, -1, 1)))
            .normalized();
    Outline result;
    for (const Vec3& corner : corners) result.push_back((turn * corner).cast<float>().cast<double>());
    return result;
}

/// Twice the polygon's area, along its normal.
Vec3 twiceArea(const Outline& corners) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k)
        sum += corners[k].cross(corners[(k + 1) % corners.size()]);
    return sum;
}

/// Two triangles fewer than corners, bordered by the polygon's edges, that cover it without lying on each
/// other.
void checkCover(const Outline& corners) {
    const std::vector<Tri> triangles = triangulated(corners);
    REQUIRE(triangles.size() + 2 == corners.size());
    std::map<std::pair<int, int>, int> edges;
    double area = 0;
    for (const Tri& t : triangles) {
        area += (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).norm();
        for (int k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
            --edges[{t[(k + 1) % 3], t[k]}];
        }
    }
    const int count = static_cast<int>(corners.size());
    for (int k = 0; k < count; ++k) {
        --edges[{k, (k + 1) % count}];
        ++edges[{(k + 1) % count, k}];
    }
    for (const auto& [edge, excess] : edges) CHECK(excess == 0);
    CHECK(area == Approx(twiceArea(corners).norm()).epsilon(1e-5));
}

} // namespace

TEST_CASE("polygons of any form are covered by triangles of their corners, however they lie") {
    std::mt19937_64 random(1);
    std::vector<Outline> forms{
        comb(3), comb(20),
        outline(
            {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}}),
        // Into a hole along an edge and back, and along a bridge.
        outline({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}),
        outline(
            {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 2}, {1, 2}, {1, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}),
        outline({{.5, .5}, {0, 2}, {0, 0}, {2, 0}}), outline({{0, 0}, {2, 0}, {.5, .5}, {0, 2}}),
        outline({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}})};
    for (int k = 0; k < 12; ++k) forms.push_back(star(random, 5 + 3 * k));
    for (const Outline& form : forms) {
        INFO(form.size() << " corners, the first " << form[0].transpose());
        checkCover(form);
        for (int k = 0; k < 5; ++k) checkCover(turnedAbout(form, random));
    }
}

TEST_CASE("a convex polygon is a fan, and what is no polygon has no triangles or harmless ones") {
    CHECK(triangulated(outline({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}})) ==
          std::vector<Tri>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    CHECK(triangulated(outline({{0, 0}, {1, 0}})).empty());
    CHECK(triangulated(outline({{0, 0}, {1, 0}, {2, 0}, {3, 0}})).size() == 2);
    CHECK(triangulated(outline({{0, 0}, {2, 2}, {2, 0}, {0, 2}})).size() == 2); // crosses itself
}
