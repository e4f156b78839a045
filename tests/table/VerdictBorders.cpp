#include "bake/table/PreparedTable.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

using namespace tss;
using random_table::Random;

namespace {

std::uint32_t below(Random& random, std::uint32_t count) {
    return std::min(static_cast<std::uint32_t>(random_table::between(random, 0, count)), count - 1);
}

/// The double itself, the next one below or the next one above.
double orNext(Random& random, double value) {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::uint32_t which = below(random, 3);
    return which == 0 ? value : std::nextafter(value, which == 1 ? -infinity : infinity);
}

/// Half of them anywhere; the others where one look-up ends and the next begins, to the last bit: at the
/// borders of cells and of their parts, and at the values at which contact begins and ends.
std::vector<double> somePose(Random& random, const Motion& motion, const VerdictGrid& verdicts) {
    std::vector<double> q = random_table::values(random, motion);
    if (below(random, 2) == 0) return q;
    const auto& pieces = verdicts.pieces();
    if (!pieces.empty() && below(random, 2) == 0) {
        q[0] = orNext(random, pieces[below(random, std::uint32_t(pieces.size()))].from);
        return q;
    }
    VerdictGrid::Place first{};
    for (std::size_t k = 0; k < q.size(); ++k)
        first[k] = below(random, verdicts.cellCount(k) * verdicts.partsPerCell(k));
    const VerdictGrid::Box box = verdicts.box(first, {1, 1, 1});
    for (std::size_t k = 0; k < q.size(); ++k)
        if (below(random, 2) == 0) q[k] = orNext(random, box.lower[k]);
    return q;
}

struct BorderCounts {
    long poses = 0, touching = 0, known = 0, inParts = 0, inBand = 0;
};

void judge(const PreparedTable& prepared, const std::vector<double>& q, long double gap,
           BorderCounts& counts) {
    const VerdictGrid& verdicts = prepared.verdicts();
    const Verdict atOnce = verdicts.atOnce(q.data()), verdict = verdicts.verdict(q.data());
    const bool hit = prepared.hit(q.data());
    ++counts.poses;
    counts.touching += hit;
    counts.known += verdict != Verdict::Ask;
    counts.inParts += verdict != Verdict::Ask && atOnce == Verdict::Ask;
    counts.inBand += gap > 0 && gap <= prepared.signBand();
    if (gap <= 0 && !hit) FAIL("a touch of depth " << -gap << " is missed at " << q[0]);
    if (gap > prepared.signBand() && hit) FAIL("contact is reported at " << q[0] << " from " << gap);
    if (atOnce != Verdict::Ask && atOnce != verdict) FAIL("two verdicts at " << q[0]);
    if (verdicts.clearance(q.data()) > gap && gap > 0) FAIL("more clearance than there is at " << q[0]);
    if (verdicts.clearance(q.data()) > 0 && gap <= 0) FAIL("clearance in contact at " << q[0]);
}

BorderCounts judgeAll(std::uint64_t firstSeed, int tables, int posesEach) {
    BorderCounts counts;
    for (std::uint64_t seed = firstSeed; seed < firstSeed + std::uint64_t(tables); ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Motion motion = random_table::motion(random, 1 + int(seed % 3), 1, false);
        const Table table = random_table::table(random, motion, 3, 3, 1);
        const std::vector<TablePair> pairs = tablePairs(table);
        const PreparedTable prepared(table);
        for (int i = 0; i < posesEach; ++i) {
            const std::vector<double> q = somePose(random, motion, prepared.verdicts());
            judge(prepared, q, exact::gap(motion, pairs, q), counts);
        }
    }
    return counts;
}

} // namespace

TEST_CASE("verdicts hold to the last bit where cells, parts and intervals end, at a million poses") {
    const BorderCounts counts = judgeAll(1, 50, 20000);
    CAPTURE(counts.touching, counts.known, counts.inParts, counts.inBand);
    CHECK(counts.poses == 1000000);
    CHECK(counts.touching > 50000);
    CHECK(counts.known > 950000);
    CHECK(counts.inParts > 50000);
}

TEST_CASE("verdicts hold to the last bit where cells, parts and intervals end, at 10 million poses",
          "[.long]") {
    const BorderCounts counts = judgeAll(1000, 200, 50000);
    WARN(counts.touching << " of " << counts.poses << " poses touch, " << counts.known
                         << " known by the values, " << counts.inParts << " by parts or intervals, "
                         << counts.inBand << " free within the band");
    CHECK(counts.poses == 10000000);
    CHECK(counts.touching > 500000);
}
