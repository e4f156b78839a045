#include "bake/verify/Kernel.h"
#include "bake/base/Error.h"
#include "tests/table/RandomTable.h"
#include "tests/verify/Baked.h"

#include <catch2/catch.hpp>
#include <optional>

using namespace tss;

namespace {

/// The table as it is prepared in every form and precision that its motion allows.
std::vector<PreparedTable> allForms(const Table& table) {
    std::vector<PreparedTable> forms;
    for (KernelForm form : {KernelForm::Fold, KernelForm::Direct})
        for (KernelPrecision precision : {KernelPrecision::Float, KernelPrecision::Double}) {
            try {
                forms.emplace_back(table, PrepareOptions{KernelTarget::Best, form, precision});
            } catch (const InputError&) { // no fold for this motion
            }
        }
    return forms;
}

} // namespace

TEST_CASE("the kernels of random tables keep what they promise about rounding, in every form and precision") {
    int folds = 0, directs = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        random_table::Random random(seed);
        const Table table = random_table::anyTable(random);
        for (const PreparedTable& prepared : allForms(table)) {
            const KernelVerdict verdict = verifyKernel(table, prepared);
            INFO(name(prepared.form()) << " " << name(prepared.precision()) << ": " << verdict.reason);
            CHECK(verdict.proven);
            CHECK(verdict.seen <= verdict.gapOff);
            ++(prepared.form() == KernelForm::Fold ? folds : directs);
        }
    }
    CHECK(folds > 20);
    CHECK(directs > 100);
}

TEST_CASE("a kernel made from other spheres or another axis is refused") {
    int tried = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        const scenes::Scene scene = scenes::randomScene(seed, 1 + int(seed % 3), 30, false);
        const Table table = baked(scene);
        if (table.testCount() < 2) continue;
        for (const PreparedTable& prepared : allForms(table)) {
            INFO(name(prepared.form()) << " " << name(prepared.precision()));
            REQUIRE(verifyKernel(table, prepared).proven);
            Table larger = table, smaller = table, moved = table, turned = table;
            const double little = 20 * prepared.signBand() + 1e-9;
            for (Sphere& s : larger.a) s.radius += little;
            for (Sphere& s : smaller.a) s.radius -= little;
            for (Sphere& s : moved.b) s.centre.x() += 10 * little;
            turned.motion.base.translation().z() += 10 * little;
            for (const Table* other : {&larger, &smaller, &moved, &turned}) {
                CHECK_FALSE(verifyKernel(*other, prepared).proven);
                ++tried;
            }
        }
    }
    CHECK(tried >= 4 * 20);
}
