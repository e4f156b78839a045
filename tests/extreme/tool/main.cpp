#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "tests/extreme/scenes/ExtremeScene.h"
#include "tests/extreme/tool/Page.h"
#include "tests/extreme/tool/RandomScene.h"
#include "tests/extreme/tool/Serve.h"

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <string>
#include <sys/time.h>
#include <unistd.h>

namespace {

using namespace extreme;

constexpr const char* usage =
    "usage: tss-extreme scenes DIR          writes the stiff and extreme scenes into DIR\n"
    "       tss-extreme check [NAME...]     takes them through bake, verify and play\n"
    "       tss-extreme random N [FIRST [SECONDS [meet]]]\n"
    "                                       the same with N random scenes, seeds from FIRST on (1), each "
    "asked\n"
    "                                       to stop after SECONDS of processor time (5); meet: their bodies "
    "do\n"
    "       tss-extreme page FILE STEPS FRAMES SCENES   measures all of it anew and writes the page about "
    "it\n";

/// Seconds of processor time after which a random scene is asked to stop, and after which it has hung.
constexpr double usualBudget = 5;
constexpr long hang = 60;

std::atomic<unsigned long long> seedNow{0};

void writeScenes(const std::filesystem::path& folder) {
    for (const ExtremeScene& scene : extremeScenes()) {
        const std::string file = (folder / (scene.name + ".tss")).string();
        tss::writeFileAtomically(file, scene.text);
        std::fprintf(stderr, "%s\n", file.c_str());
    }
}

int check(int count, char** names) {
    int bad = 0;
    for (const ExtremeScene& scene : extremeScenes()) {
        bool wanted = count == 0;
        for (int k = 0; k < count; ++k) wanted = wanted || scene.name == names[k];
        if (!wanted) continue;
        const auto start = std::chrono::steady_clock::now();
        const Outcome outcome = serve(scene.text, scene.name);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        fmt::print("{} ({:.2f} s)\n", scene.name, seconds.count());
        if (!outcome.refusal.empty()) fmt::print("  refused: {}\n", outcome.refusal);
        for (const std::string& trouble : outcome.troubles) fmt::print("  TROUBLE {}\n", trouble);
        for (const PairFigures& pair : outcome.pairs) {
            fmt::print("  {} spheres {}+{} cells {} band {:.3g} early {:.4g} deepest {:.3g}\n", pair.path,
                       pair.verdict.spheresA, pair.verdict.spheresB, pair.verdict.cells, pair.verdict.band,
                       pair.verdict.meshes.earlyBound.value_or(-1), pair.deepest);
            if (pair.kernel)
                fmt::print("    {} {} condition {:.3g} float band {:.3g} band {:.3g} tests {}\n",
                           name(pair.kernel->form), name(pair.kernel->precision), pair.kernel->condition,
                           pair.kernel->floatBand, pair.kernel->band,
                           outcome.scene.pairs[0].table->testCount());
            for (const auto& [status, steps] : pair.statuses) fmt::print("    {} {}\n", status, steps);
        }
        for (const SkinFigures& skin : outcome.skins)
            fmt::print("  {} farthest {:.4g} residual {:.4g}\n", skin.path, skin.farthest, skin.residual);
        for (const tss::PairReport& report : outcome.reports)
            for (const std::string& note : report.notes) fmt::print("  note: {}\n", note);
        bad += !outcome.troubles.empty();
    }
    return bad ? 1 : 0;
}

/// Names the seed: the process cannot go on.
[[noreturn]] void failed(int signal) {
    char text[64];
    const int length = std::snprintf(text, sizeof text, "seed %llu %s\n", seedNow.load(),
                                     signal == SIGPROF ? "hangs" : "crashes");
    if (length > 0 && write(2, text, static_cast<std::size_t>(length)) < 0) _exit(4);
    _exit(3);
}

/// Processor time until SIGPROF; 0: none.
void allow(long seconds) {
    itimerval timer{};
    timer.it_value.tv_sec = seconds;
    setitimer(ITIMER_PROF, &timer, nullptr);
}

int searchForTrouble(std::uint64_t count, std::uint64_t first, double budget, Bodies bodies) {
    std::uint64_t refused = 0, stopped = 0, bad = 0, tables = 0;
    double longest = 0;
    std::map<std::string, int> refusals;
    for (const int signal : {SIGPROF, SIGFPE, SIGSEGV, SIGABRT}) std::signal(signal, failed);
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        seedNow = seed;
        allow(hang);
        const RandomRun run = runRandom(seed, budget, bodies);
        allow(0);
        stopped += run.stopped;
        refused += !run.stopped && !run.refusal.empty();
        longest = std::max(longest, run.seconds);
        if (!run.refusal.empty()) ++refusals[run.refusal.substr(run.refusal.find('>') + 1, 60)];
        if (run.seconds > 2 * budget) fmt::print("seed {}: slow, {:.1f} s\n", seed, run.seconds);
        for (const std::string& trouble : run.troubles) fmt::print("seed {}: {}\n", seed, trouble);
        bad += !run.troubles.empty();
        tables += run.table;
        if ((seed - first) % 100 == 99) fmt::print("{} scenes\n", seed - first + 1);
    }
    fmt::print("{} scenes from seed {}: {} served whole ({} with a table), {} stopped by their budget of {} "
               "s, {} refused, {} in "
               "trouble; the longest took {:.1f} s\n",
               count, first, count - refused - stopped, tables, stopped, budget, refused, bad, longest);
    for (const auto& [what, times] : refusals) fmt::print("  refused {} times{}\n", times, what);
    return bad ? 1 : 0;
}

} // namespace

/// The stiff and extreme scenes of METHOD 9, their check, and the page about it.
int main(int count, char** arguments) {
    const std::string command = count > 1 ? arguments[1] : "";
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    try {
        if (command == "scenes" && count == 3) {
            std::filesystem::create_directories(arguments[2]);
            writeScenes(arguments[2]);
            return 0;
        }
        if (command == "check") return check(count - 2, arguments + 2);
        const bool meet = count == 6 && std::string(arguments[5]) == "meet";
        if (command == "random" && count >= 3 && (count <= 5 || meet))
            return searchForTrouble(std::stoull(arguments[2]), count > 3 ? std::stoull(arguments[3]) : 1,
                                    count > 4 ? std::stod(arguments[4]) : usualBudget,
                                    meet ? Bodies::Meet : Bodies::Anywhere);
        if (command == "page" && count == 6) {
            const PageOptions options{std::stol(arguments[3]), std::stol(arguments[4]),
                                      std::stoull(arguments[5])};
            tss::writeFileAtomically(arguments[2], stabilityPage(options));
            return 0;
        }
        std::fputs(usage, stderr);
        return command == "--help" ? 0 : 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tss-extreme: %s\n", error.what());
        return 1;
    }
}
