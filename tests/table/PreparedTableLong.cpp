#include "bake/table/PreparedTable.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

namespace {

struct Counts {
    long poses = 0, inside = 0, different = 0;
};

/// Verdicts of every target at random poses of random tables, against the plain kernel in double: where the
/// gap is outside the band all must agree; inside they are counted.
Counts compareVerdicts(std::uint64_t firstSeed, int tables, int posesEach) {
    Counts counts;
    for (std::uint64_t seed = firstSeed; seed < firstSeed + std::uint64_t(tables); ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table table = random_table::anyTable(random);
        const PreparedTable judge(table, {KernelTarget::Scalar, {}, KernelPrecision::Double});
        std::vector<PreparedTable> others;
        for (KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                    KernelTarget::Avx512, KernelTarget::Neon})
            if (available(target))
                others.emplace_back(table, PrepareOptions{target, {}, KernelPrecision::Float});
        const double band = others[0].signBand() + judge.gapBand();
        for (int i = 0; i < posesEach; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            TableFeatures f;
            judge.features(q.data(), f);
            const double gap = judge.gap(f).gap;
            others[0].features(q.data(), f);
            ++counts.poses;
            const bool inside = std::abs(gap) <= band;
            counts.inside += inside;
            bool different = false;
            // Features do not depend on the target.
            for (const PreparedTable& t : others) different = different || t.hit(f) != (gap <= 0);
            if (!inside && different) FAIL("verdicts differ at a gap of " << gap << ", band " << band);
            counts.different += different;
        }
    }
    return counts;
}

} // namespace

TEST_CASE("scalar and vector verdicts are the same outside the band at 100,000 poses") {
    const Counts counts = compareVerdicts(1000, 50, 2000);
    INFO(counts.inside << " poses inside the band, " << counts.different << " of them with other verdicts");
    CHECK(counts.poses == 100000);
    CHECK(counts.different <= counts.inside);
    CHECK(counts.inside < counts.poses / 1000);
}

TEST_CASE("scalar and vector verdicts are the same outside the band at 10 million poses", "[.long]") {
    const Counts counts = compareVerdicts(5000, 500, 20000);
    WARN(counts.inside << " of " << counts.poses << " poses inside the band, " << counts.different
                       << " of them with other verdicts");
    CHECK(counts.poses == 10000000);
    CHECK(counts.different <= counts.inside);
}
