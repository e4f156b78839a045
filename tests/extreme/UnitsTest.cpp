#include "bake/table/Query.h"
#include "bake/table/TablePairs.h"
#include "tests/extreme/Served.h"

#include <cmath>

using namespace extreme;
using tss::Table;

namespace {

void checkScaled(const Table& table, const Table& base, double factor) {
    CHECK(table.rowOffsets == base.rowOffsets);
    CHECK(table.columns == base.columns);
    REQUIRE(table.a.size() == base.a.size());
    REQUIRE(table.b.size() == base.b.size());
    const auto same = [&](const tss::SphereSet& x, const tss::SphereSet& y) {
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double size = y[k].centre.norm() + y[k].radius;
            CHECK((x[k].centre / factor - y[k].centre).norm() < 1e-5 * size);
            CHECK(std::abs(x[k].radius / factor - y[k].radius) < 1e-5 * size);
        }
    };
    same(table.a, base.a);
    same(table.b, base.b);
    CHECK(table.boundMiss == base.boundMiss);
    CHECK(table.boundEarly.value() == Approx(factor * base.boundEarly.value()).epsilon(1e-4));
}

} // namespace

TEST_CASE("a jaw in units of a micrometre or a megametre gets the same table as in metres") {
    checkScaled(tableOf("unit_micrometre"), tableOf("unit_metre"), 1e6);
    checkScaled(tableOf("unit_megametre"), tableOf("unit_metre"), 1e-6);
}

TEST_CASE("a pair placed 1e7 units from the origin gets the very table of the pair at the origin") {
    const Table &far = tableOf("far_placed"), &near = tableOf("to_and_fro");
    CHECK(far.columns == near.columns);
    REQUIRE(far.a.size() == near.a.size());
    for (std::size_t k = 0; k < far.a.size(); ++k) {
        CHECK(far.a[k].centre == near.a[k].centre);
        CHECK(far.a[k].radius == near.a[k].radius);
    }
    CHECK(far.boundEarly == near.boundEarly);
}

TEST_CASE("spheres 1e7 units from their frame's origin carry the unit between floats in their bound") {
    const Table& table = tableOf("far_modelled");
    CHECK(table.boundMiss == 0);
    // Twice the tolerance of 4, and what the rounding of a centre to whole units adds to either body.
    CHECK(table.boundEarly > 8);
    CHECK(table.boundEarly < 8 + 2 * 2 * std::sqrt(3.0));
    for (const tss::Sphere& sphere : table.a)
        for (int k = 0; k < 3; ++k) CHECK(sphere.centre[k] == std::round(sphere.centre[k]));
}

TEST_CASE("a grain of a thousandth stops at the grain in front of a ball of a thousand") {
    const Table& table = tableOf("radii");
    // The grains' poles: one at -0.003, the other at -34.999 and rough by up to 3 %.
    const auto gap = [&](double q) { return tss::query(table, std::vector<double>{q}).gap; };
    CHECK(gap(34.9930) > 0);
    CHECK(gap(34.9965) <= 0);
    CHECK(served("radii").pairs[0].statuses.at("blocked") > 0);
}

TEST_CASE("a scene that needs double gets double by itself, and one that does not gets float") {
    const extreme::KernelFigures needs = *served("long_slide").pairs[0].kernel;
    CHECK(needs.precision == tss::KernelPrecision::Double);
    double smallest = HUGE_VAL;
    for (const tss::TablePair& pair : tss::tablePairs(tableOf("long_slide")))
        smallest = std::min(smallest, pair.radiusA + pair.radiusB);
    CHECK(needs.floatBand > 1e-4 * smallest);
    CHECK(needs.band < 1e-5 * smallest); // what rounds on the long way of T(q) is in it
    CHECK(served("to_and_fro").pairs[0].kernel->precision == tss::KernelPrecision::Float);
}
