#include "bake/motion/LimitConflict.h"

#include "bake/base/Error.h"
#include "bake/motion/MotionBound.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::between;
using random_table::Random;

namespace {

Motion slides(std::size_t count, double lower = -1, double upper = 2) {
    Motion m;
    for (std::size_t k = 0; k < count; ++k) {
        Dof d;
        d.name = "slide" + std::to_string(k);
        d.kind = DofKind::Translation;
        d.axis = Vec3::Unit(static_cast<Eigen::Index>(k % 3));
        d.lower = lower;
        d.upper = upper;
        d.rest = std::clamp(0.0, lower, upper);
        m.dofs.push_back(d);
    }
    return m;
}

std::string complaint(const Motion& m) {
    try {
        checkMotion(m);
    } catch (const InputError& error) {
        return error.message;
    }
    return "";
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("planes that leave no pose are refused, and those at fault are named") {
    Motion m = slides(2);
    m.planes = {{{1, 0}, 5}, {{1, 1}, -2.5}};
    CHECK(conflictingPlanes(m) == std::vector<std::size_t>{1}); // the sum is at least -2
    CHECK(has(complaint(m), "limit plane 2 of the DOFs 'slide0', 'slide1'"));
    CHECK(has(complaint(m), "some pose"));
    m.planes = {{{1, 0}, 0.4}, {{0, 1}, 7}, {{-1, 0}, -0.5}};
    CHECK(conflictingPlanes(m) == std::vector<std::size_t>{0, 2});
    CHECK(has(complaint(m), "limit planes 1, 3"));
}

TEST_CASE("a rest that limits or planes leave out is refused") {
    Motion m = slides(2);
    m.planes = {{{1, 1}, 3}, {{-1, 0}, -0.5}};
    CHECK(conflictingPlanes(m).empty());
    CHECK(has(complaint(m), "limit plane 2"));
    CHECK(has(complaint(m), "the rest values meet"));
    m.dofs[0].rest = 0.5;
    CHECK(complaint(m).empty());
    m.dofs[0].rest = 2.001;
    CHECK(has(complaint(m), "DOF 'slide0': expected a rest value within its limits"));
}

TEST_CASE("a coupling by two planes that face each other leaves poses, whatever its coefficients") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const std::size_t count = 2 + random() % (maxDofs - 1);
        // Ranges of 1e-8 at 1e3 and of 1e6 about 0.
        const double size = std::pow(10.0, between(random, -8, 6)), at = random() % 2 ? 1e3 : 0;
        Motion m = slides(count, at - size, at + size);
        std::vector<double> some;
        for (Dof& dof : m.dofs) some.push_back(dof.rest = at + size * between(random, -1, 1));
        for (std::size_t i = 0; i < std::min<std::size_t>(3, count - 1); ++i) {
            LimitPlane plane;
            for (const double q : some) {
                plane.coefficients.push_back(between(random, -1, 1) * (random() % 3 ? 1 : 57.3));
                plane.bound += plane.coefficients.back() * q;
            }
            m.planes.push_back(plane);
            for (double& c : plane.coefficients) c = -c;
            plane.bound = -plane.bound;
            m.planes.push_back(plane);
        }
        CHECK(conflictingPlanes(m).empty());
        CHECK(complaint(m).empty());
    }
}

TEST_CASE("a gap between facing planes is a conflict, an overlap none, and no plane is named in vain") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const std::size_t count = 1 + random() % maxDofs;
        Motion m = slides(count);
        LimitPlane plane;
        for (std::size_t k = 0; k < count; ++k) {
            plane.coefficients.push_back(between(random, 0.1, 1) * (random() % 2 ? 1 : -1));
            plane.bound += plane.coefficients[k] * between(random, -0.5, 1);
        }
        LimitPlane facing = plane;
        for (double& c : facing.coefficients) c = -c;
        facing.bound = -plane.bound - 1e-6;
        LimitPlane idle{std::vector<double>(count, 0.0), 5};
        idle.coefficients[0] = 1;
        m.planes = {plane, idle, facing};
        CHECK(conflictingPlanes(m) == std::vector<std::size_t>{0, 2});
        m.planes[2].bound = -plane.bound + 1e-6;
        CHECK(conflictingPlanes(m).empty());
    }
}

TEST_CASE("a plane about DOFs that cannot move holds or leaves nothing") {
    Motion m = slides(2, 0.25, 0.25);
    m.planes = {{{1, 1}, 0.5}};
    CHECK(conflictingPlanes(m).empty());
    CHECK(complaint(m).empty());
    m.planes[0].bound = 0.4;
    CHECK(conflictingPlanes(m) == std::vector<std::size_t>{0});
}
