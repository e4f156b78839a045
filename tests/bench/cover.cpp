// The proofs of a table: which pairs can meet, the certified cover, the verification, on jaw-like instances
// made by code. Beside the times: pairs in the table, the lower bound that no table beats, cells of Q, peak
// memory.
#include "bake/reduce/CertifiedCover.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/verify/Verify.h"
#include "tests/search/Scenes.h"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

using namespace tss;

namespace {

/// What is asked of the table of one instance (METHOD 3.3, 3.4). Lengths as of an object 100 units long.
struct Instance {
    const char* name;
    int spheresA, spheresB;
    double epsilon, depth;
};

constexpr Instance instances[] = {{"1158x812/lossless", 1158, 812, 0, 0},
                                  {"1158x812/gap-true", 1158, 812, 0.001, 1},
                                  {"10000x10000/lossless", 10000, 10000, 0, 0}};

CoverOptions optionsOf(const Instance& instance) {
    CoverOptions options;
    options.epsilon = instance.epsilon;
    options.gapDepth = instance.depth;
    return options;
}

Table tableOf(const Instance& instance, const scenes::Scene& scene, const CoverResult& cover) {
    Table table = makeTable(scene.a, scene.b, cover.pairs, cover.restGaps, scene.motion);
    table.epsilon = cover.epsilon;
    table.gapDepth = instance.depth;
    return table;
}

double peakMegabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

void search(benchmark::State& state, const Instance& instance) {
    const scenes::Scene scene = scenes::jawLike(instance.spheresA, instance.spheresB);
    CertifiedSearchOptions options;
    for (auto _ : state) {
        const CandidatePairs found = searchCertified(scene.a, scene.b, scene.motion, options);
        state.counters["pairs"] = static_cast<double>(found.pairs.size());
        state.counters["cells"] = static_cast<double>(found.explored);
    }
    state.counters["MB"] = peakMegabytes();
}

void cover(benchmark::State& state, const Instance& instance) {
    const scenes::Scene scene = scenes::jawLike(instance.spheresA, instance.spheresB);
    for (auto _ : state) {
        const CoverResult found =
            certifiedCover(scene.a, scene.b, nullptr, scene.motion, optionsOf(instance));
        if (!found.complete) return state.SkipWithError("no proof was found");
        state.counters["pairs"] = static_cast<double>(found.pairs.size());
        state.counters["atLeast"] = found.lowerBound;
        state.counters["cells"] = static_cast<double>(found.cells);
    }
    state.counters["MB"] = peakMegabytes();
}

void verify(benchmark::State& state, const Instance& instance) {
    const scenes::Scene scene = scenes::jawLike(instance.spheresA, instance.spheresB);
    const Table table = tableOf(instance, scene,
                                certifiedCover(scene.a, scene.b, nullptr, scene.motion, optionsOf(instance)));
    for (auto _ : state) {
        const VerifyResult result = verifyTable(scene.a, scene.b, table, scene.motion);
        if (!result.proven) return state.SkipWithError(result.reason.c_str());
        state.counters["cells"] = static_cast<double>(result.cells);
    }
    state.counters["MB"] = peakMegabytes();
}

} // namespace

int main(int argc, char** argv) {
    const std::pair<const char*, void (*)(benchmark::State&, const Instance&)> steps[] = {
        {"search", search}, {"cover", cover}, {"verify", verify}};
    for (const Instance& instance : instances)
        for (const auto& [step, run] : steps) {
            const std::string name = std::string(instance.name) + "/" + step;
            benchmark::RegisterBenchmark(name.c_str(),
                                         [&instance, run = run](auto& state) { run(state, instance); })
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime()
                ->MeasureProcessCPUTime();
        }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
