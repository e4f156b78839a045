// Lengths whose squares are near the ends of what floats hold.
#include "bake/base/Error.h"
#include "bake/table/PreparedTable.h"
#include "tests/FloatTraps.h"
#include "tests/table/ExactGap.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// Two balls of radius 1 on a slide along Z; four ways apart at its value 0, its values in units of `value`.
/// All lengths times `unit`.
Table ballsOnSlide(double unit, double value = 1) {
    Table table;
    table.a = {{Vec3::Zero(), unit}};
    table.b = {{{0.1 * unit, 0, 4 * unit}, unit}};
    table.rowOffsets = {0, 1};
    table.columns = {0};
    Dof slide;
    slide.kind = DofKind::Translation;
    slide.axis = {0, 0, unit * value};
    slide.lower = -8 / value;
    slide.upper = 2 / value;
    table.motion.dofs = {slide};
    return table;
}

/// Every kind of kernel has the exact verdict outside of the band that it states, which is small.
void checkVerdicts(const Table& table) {
    const Dof& slide = table.motion.dofs[0];
    const double size = table.a[0].radius;
    for (const KernelTarget target :
         {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2, KernelTarget::Avx512}) {
        if (!available(target)) continue;
        PrepareOptions how;
        how.target = target;
        const PreparedTable prepared(table, how);
        CAPTURE(name(target), name(prepared.precision()), size);
        CHECK(prepared.signBand() < 1e-4 * size);
        int touching = 0;
        for (int k = 0; k <= 1000; ++k) {
            const std::vector<double> q{slide.lower + 0.001 * k * (slide.upper - slide.lower)};
            const long double gap = exact::gap(table.motion, tablePairs(table), q);
            TableFeatures features;
            prepared.features(q.data(), features);
            touching += gap <= 0;
            for (const bool hit : {prepared.hit(q.data()), prepared.hit(features)})
                if (gap <= 0 || gap > prepared.signBand()) REQUIRE(hit == (gap <= 0));
            REQUIRE(std::abs(prepared.gap(features).gap - gap) < 1e-4 * (size + std::abs(gap)));
        }
        CHECK(touching > 300);
    }
}

} // namespace

TEST_CASE("lengths from 1e-30 to 1e14 have right verdicts with every kernel") {
    const FloatTrapsOff traps; // floats that are too small become 0
    for (const double unit : {1e-30, 1e-24, 1e-22, 1e-20, 1e-15, 1., 1e10, 1e14})
        checkVerdicts(ballsOnSlide(unit));
}

TEST_CASE("a slide in units far from a length has right verdicts with every kernel") {
    const FloatTrapsOff traps;
    for (const double value : {1e-30, 1e-21, 1e-10, 1e10, 1e21, 1e30}) checkVerdicts(ballsOnSlide(1, value));
}

TEST_CASE("a table of lengths that kernels cannot square is refused, not asked") {
    for (const double unit : {1e16, 1e19, 1e20, 1e30, 1e37})
        CHECK_THROWS_WITH(PreparedTable(ballsOnSlide(unit)), Catch::Contains("metersPerUnit"));
}

TEST_CASE("a hinge of a thousand turns misses no touch, however its kernel rounds the angle") {
    Table table = ballsOnSlide(1);
    Dof hinge;
    hinge.axis = {0, 0, 1};
    hinge.origin = {4000, 0, 0};
    hinge.lower = -9000;
    hinge.upper = 3000;
    table.a = {{Vec3::Zero(), 1}};
    table.b = {{{0, 10, 0}, 1}};
    table.motion.dofs = {hinge};
    const auto pairs = tablePairs(table);
    const auto gapAt = [&](double q) { return exact::gap(table.motion, pairs, std::vector<double>{q}); };
    for (const KernelForm form : {KernelForm::Fold, KernelForm::Direct}) {
        PrepareOptions how;
        how.form = form;
        how.precision = KernelPrecision::Double;
        const PreparedTable prepared(table, how);
        CAPTURE(name(form), prepared.signBand());
        for (int turn = -1400; turn <= 450; ++turn) {
            // It touches where it comes to A's height, 0.0025 on.
            double apart = turn * 2 * 3.14159265358979, touching = apart;
            for (const double way : {0.0025, -0.0025})
                if (gapAt(apart + way) < 0) touching = apart + way;
            REQUIRE(gapAt(apart) > 0);
            REQUIRE(gapAt(touching) < 0);
            for (double middle; middle = 0.5 * (apart + touching), middle != apart && middle != touching;)
                (gapAt(middle) > 0 ? apart : touching) = middle;
            TableFeatures features;
            prepared.features(&touching, features);
            REQUIRE(prepared.hit(features));
            REQUIRE(prepared.hit(&touching));
        }
        CHECK(prepared.signBand() < 1e-6);
    }
}
