// The response, by what it has to do: nothing on the way, a small step that slides, a jump.
#include "bake/respond/JointResponder.h"
#include "tests/bench/JawLike.h"

#include <benchmark/benchmark.h>

using namespace tss;

namespace {

struct Step {
    DofValues last{}, asked{};
};

enum class Kind { Free, Slides, Jump };

/// Steps of one kind, found by walking: a joint pulled towards one pose after another.
std::vector<Step> steps(const Table& table, const JointResponder& responder, Kind kind) {
    random_table::Random random(11);
    JointWorkspace ws = responder.workspace();
    std::vector<Step> found;
    const std::vector<double> rest = restValues(table.motion);
    std::vector<double> q = rest, hand = rest;
    for (int i = 0; i < 20000 && found.size() < 256; ++i) {
        if (i % 40 == 0) hand = random_table::values(random, table.motion);
        const double share = kind == Kind::Jump ? 1 : 0.02;
        Step step;
        for (std::size_t k = 0; k < q.size(); ++k) {
            step.last[k] = q[k];
            step.asked[k] = q[k] + share * (hand[k] - q[k]);
        }
        const JointAnswer answer = responder.respond(step.last.data(), step.asked.data(), ws);
        const bool wanted = kind == Kind::Free     ? answer.table < 0
                            : kind == Kind::Slides ? answer.status == JointStatus::Slid
                                                   : answer.status != JointStatus::Free;
        if (wanted) found.push_back(step);
        std::copy_n(answer.q.begin(), q.size(), q.begin());
    }
    return found;
}

void respond(benchmark::State& state, int dofs, std::size_t tests, Kind kind) {
    const Table table = jaw_like::table(dofs, tests, 0.01);
    const JointResponder responder(table);
    JointWorkspace ws = responder.workspace();
    const std::vector<Step> walk = steps(table, responder, kind);
    if (walk.empty()) return state.SkipWithError("no step of this kind was found");
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(responder.respond(walk[i].last.data(), walk[i].asked.data(), ws));
        if (++i == walk.size()) i = 0;
    }
}

} // namespace

int main(int argc, char** argv) {
    const std::pair<const char*, Kind> kinds[] = {
        {"nothing on the way", Kind::Free}, {"small step that slides", Kind::Slides}, {"jump", Kind::Jump}};
    for (int dofs = 1; dofs <= 3; ++dofs)
        for (std::size_t tests : {73, 500})
            for (const auto& [what, kind] : kinds) {
                if (dofs == 1 && kind == Kind::Slides) continue; // a single DOF has nowhere to slide
                const std::string name =
                    std::to_string(dofs) + " DOF/" + std::to_string(tests) + " pairs/" + what;
                benchmark::RegisterBenchmark(
                    name.c_str(), [=, kind = kind](auto& state) { respond(state, dofs, tests, kind); });
            }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
