#include "bake/base/Parallel.h"
#include "tests/adversary/judge/Trial.h"

#include <catch2/catch.hpp>

using namespace adversary;

namespace {

/// Scenes of these seeds: whatever was claimed of them must be so. `tss-adversary one SEED` shows one.
void checkSeeds(std::uint64_t first, std::uint64_t count, const TrialOptions& options) {
    const tss::ThreadLimit one(1); // budgets are of processor time
    Tallies tallies;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Trial trial = tryScene(seed, options);
        for (const std::string& trouble : trial.troubles) FAIL_CHECK(trial.name << ": " << trouble);
        if (!trial.verifyRefusal.empty()) FAIL_CHECK(trial.name << ": verify: " << trial.verifyRefusal);
        tallies.add(trial.name.substr(0, trial.name.rfind('-')), trial);
    }
    WARN(tallies.text());
    const Tally& all = tallies.all();
    CHECK(all.contacts > all.poses / 20);
    // Claims, and not refusals of what could be served, or claims about nothing.
    CHECK(all.proofs + all.tables >= all.scenes / 2);
    CHECK(all.missUnknown <= all.scenes / 20);
    CHECK(all.vacuous <= all.scenes / 20);
    CHECK(all.doubts * 1000 <= all.poses);
}

} // namespace

TEST_CASE("a hundred nasty scenes: what is claimed of them holds at every pose that an adversary finds") {
    TrialOptions options;
    options.poses = 400;
    options.bakeSeconds = 1;
    options.verifySeconds = 3;
    checkSeeds(0, 100, options);
}

TEST_CASE("five thousand nasty scenes, ten million poses: what is claimed of them holds", "[.long]") {
    TrialOptions options;
    options.poses = 2500;
    options.bakeSeconds = 10;
    options.verifySeconds = 40;
    checkSeeds(100, 5000, options);
}
