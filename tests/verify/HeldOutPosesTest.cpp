#include "bake/base/Parallel.h"
#include "bake/table/PreparedTable.h"
#include "bake/table/Query.h"
#include "tests/verify/Baked.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <functional>

using namespace tss;

namespace {

/// What poses that no proof has looked at say about a table and about its run-time kernel.
struct HeldOut {
    long poses = 0;    ///< looked at
    long contacts = 0; ///< models touch
    long missed = 0;   ///< models touch, and the table in double does not answer within epsilon and rounding
    long kernel = 0;   ///< the same for the run-time kernel, outside its stated band
    double lag = 0;    ///< largest gap of the table less what is promised
    double float_ = 0; ///< largest difference of the kernel's gap from the table's in double

    void add(const HeldOut& other) {
        poses += other.poses, contacts += other.contacts, missed += other.missed, kernel += other.kernel;
        lag = std::max(lag, other.lag), float_ = std::max(float_, other.float_);
    }
};

/// One instance with its table, ready for millions of poses.
struct Judge {
    const scenes::Scene& scene;
    const Table& table;
    SphereTree a, b;
    PreparedTable prepared;
    double rounding = 1e-10; ///< of gaps worked out in two ways, on an object 100 units long

    Judge(const scenes::Scene& scene, const Table& table)
        : scene(scene), table(table), a(scene.a), b(scene.b), prepared(table) {}

    /// A table of some of the models' pairs answers no earlier than they do, so only a pose where its gap is
    /// larger than 0, or than the models' in a gap-true band, asks for the models.
    void look(const std::vector<double>& q, HeldOut& seen) const {
        const Pose at = pose(scene.motion, q);
        const double answer = query(table, at).gap;
        TableFeatures f;
        prepared.features(q.data(), f);
        const double kernel = prepared.gap(f).gap;
        ++seen.poses;
        if (answer <= 0 && answer >= -table.gapDepth)
            seen.float_ = std::max(seen.float_, std::abs(kernel - answer));
        const bool yesNo = table.gapDepth == 0;
        double models = answer;
        if (!yesNo || answer > 0) models = smallestGap(a, b, at, answer);
        if (models > 0) return;
        ++seen.contacts;
        const double promised = std::max(models, -table.gapDepth) + table.epsilon;
        if (yesNo && answer <= 0) return kernelMust(f, answer, seen);
        seen.lag = std::max(seen.lag, answer - promised);
        seen.missed += answer > promised + rounding;
        kernelMust(f, answer, seen);
    }

    /// Where the table touches by more than the band, so does the kernel.
    void kernelMust(const TableFeatures& f, double answer, HeldOut& seen) const {
        seen.kernel += answer < -prepared.signBand() && !prepared.hit(f);
    }

    std::vector<double> random(scenes::Random& random) const {
        return scenes::randomPose(random, scene.motion);
    }
};

/// Batches of poses on all threads, each with a seed of its own.
HeldOut spread(std::size_t batches, const std::function<HeldOut(std::uint64_t seed)>& batch) {
    std::vector<HeldOut> parts(batches);
    parallelFor(batches, [&](std::size_t k) { parts[k] = batch(k + 1); });
    HeldOut all;
    for (const HeldOut& part : parts) all.add(part);
    return all;
}

HeldOut randomPoses(const Judge& judge, std::size_t count) {
    constexpr std::size_t each = 1000;
    return spread(count / each, [&](std::uint64_t seed) {
        scenes::Random random(seed);
        HeldOut seen;
        for (std::size_t k = 0; k < each; ++k) judge.look(judge.random(random), seen);
        return seen;
    });
}

/// Both ends of bisected segments from a free pose to one where the models touch.
HeldOut nearContact(const Judge& judge, std::size_t count) {
    constexpr std::size_t each = 500; // segments
    return spread(count / (2 * each), [&](std::uint64_t seed) {
        scenes::Random random(~seed);
        HeldOut seen;
        std::vector<double> free, hit;
        for (std::size_t k = 0; k < each;) {
            const auto q = judge.random(random);
            (query(judge.table, pose(judge.scene.motion, q)).gap <= 0 ? hit : free) = q;
            if (free.empty() || hit.empty()) continue;
            if (smallestGap(judge.a, judge.b, pose(judge.scene.motion, free), 1e-300) <= 0) {
                judge.look(free, seen); // a miss, or inside epsilon
                free.clear();
                continue;
            }
            const auto [before, after] = bisected(judge.a, judge.b, judge.scene.motion, free, hit, 26);
            judge.look(before, seen);
            judge.look(after, seen);
            ++k;
        }
        return seen;
    });
}

void checkHeldOut(std::size_t random, std::size_t near) {
    const scenes::Scene scene = scenes::jawLike(1158, 812);
    for (const auto& [epsilon, depth] : {std::pair(0.0, 0.0), {0.001, 1.0}}) {
        const Table table = baked(scene, epsilon, depth);
        REQUIRE(table.epsilon == epsilon);
        const Judge judge(scene, table);
        const HeldOut far = randomPoses(judge, random), close = nearContact(judge, near);
        for (const auto& [kind, seen] : {std::pair("random", &far), {"near-contact", &close}})
            WARN("epsilon " << epsilon << ", depth " << depth << ", " << table.testCount() << " pairs, "
                            << seen->poses << " " << kind << " poses: " << seen->contacts << " contacts, "
                            << seen->missed << " missed, largest lag " << seen->lag << "; "
                            << name(judge.prepared.form()) << " " << name(judge.prepared.precision())
                            << " kernel: " << seen->kernel << " missed outside its band of "
                            << judge.prepared.signBand() << ", gap off by at most " << seen->float_
                            << " (band " << judge.prepared.gapBand() << ")");
        CHECK(far.missed + close.missed == 0);
        CHECK(far.kernel + close.kernel == 0);
        CHECK(far.contacts > long(random) / 50);
        CHECK(close.contacts >= long(near) / 2);
    }
}

} // namespace

TEST_CASE("at held-out poses the table touches wherever the models do: 20,000 random, 2,000 near contact") {
    checkHeldOut(20000, 2000);
}

TEST_CASE("at held-out poses the table touches wherever the models do: 10^7 random, 10^6 near contact",
          "[.long]") {
    checkHeldOut(10000000, 1000000);
}
