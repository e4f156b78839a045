#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/scene/SceneFile.h"
#include "tests/adversary/judge/Trial.h"
#include "tests/extreme/scenes/Builders.h"

#include <cstdio>
#include <fmt/format.h>

namespace {

using namespace adversary;

constexpr const char* usage =
    "usage: tss-adversary run FIRST COUNT [POSES [BAKE_SECONDS [VERIFY_SECONDS [ATTACK_SECONDS]]]]\n"
    "                                  scenes of these seeds, baked, proven again and attacked; the table of "
    "them\n"
    "       tss-adversary one SEED [POSES]\n"
    "                                  a single one, in words\n"
    "       tss-adversary file SCENE [POSES]\n"
    "                                  the first pair of a scene file, baked first where it is not\n"
    "       tss-adversary write SEED FILE\n"
    "                                  the scene of a seed, for `tss bake`\n";

void tell(const Trial& trial) {
    if (!trial.refusal.empty()) fmt::print("{}: refused: {}\n", trial.name, trial.refusal);
    for (const std::string& trouble : trial.troubles) fmt::print("{}: TROUBLE {}\n", trial.name, trouble);
    if (!trial.verifyRefusal.empty()) fmt::print("{}: VERIFY {}\n", trial.name, trial.verifyRefusal);
}

void describe(const Trial& trial) {
    tell(trial);
    fmt::print(
        "{}: {}{}{}{} tests, {:.1f} % exempt{}, bake {:.2f} s, verify {:.2f} s, attack {:.2f} s\n  {} poses, "
        "{} "
        "contacts, {} fired, {} missed (latest {:.3g}), {} early (earliest {:.3g}), {} kernel, {} doubts\n",
        trial.name, trial.stopped ? "stopped, " : "", trial.proof ? "proof, " : "",
        trial.certified ? "certified, " : "", trial.tests, 100 * trial.exemptShare,
        trial.firesAtRest ? ", contact at rest" : "", trial.bakeTook, trial.verifyTook, trial.attackTook,
        trial.found.poses, trial.found.contacts, trial.found.fired, trial.found.missed, trial.found.latest,
        trial.found.early, trial.found.earliest, trial.found.kernel, trial.found.doubts);
}

int run(std::uint64_t first, std::uint64_t count, const TrialOptions& options) {
    Tallies tallies;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Trial trial = tryScene(seed, options);
        if (trial.refusal.empty()) tell(trial);
        if (trial.bakeTook + trial.verifyTook > 10)
            fmt::print("{}: slow, {:.1f} + {:.1f} s\n", trial.name, trial.bakeTook, trial.verifyTook);
        tallies.add(trial.name.substr(0, trial.name.rfind('-')), trial);
    }
    fmt::print("{}", tallies.text());
    return tallies.all().troubles || tallies.all().verifyRefused ? 1 : 0;
}

int file(const std::string& name, std::uint64_t poses) {
    tss::SceneModel scene = tss::loadScene(name);
    const tss::Pair& pair = scene.pairs.at(0);
    if (!pair.table && !pair.proof) {
        TrialOptions options;
        options.poses = poses;
        options.bakeSeconds = options.verifySeconds = 1e9;
        describe(tryScene(std::move(scene), name, 1, options));
        return 0;
    }
    Trial trial;
    trial.name = name;
    trial.proof = pair.proof != nullptr;
    try {
        trial.verifyRefusal = tss::verifyPair(scene, pair).reason;
    } catch (const tss::InputError& error) {
        trial.verifyRefusal = error.what();
    }
    trial.found = attackPair(scene, pair, {poses, 1});
    if (trial.found.failed()) trial.troubles.push_back(trial.found.what);
    describe(trial);
    return 0;
}

} // namespace

/// The adversary's scenes by seed: their fates, one in words, as a file.
int main(int count, char** arguments) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    const std::string command = count > 1 ? arguments[1] : "";
    const auto number = [&](int at, double otherwise) {
        return count > at ? std::stod(arguments[at]) : otherwise;
    };
    const tss::ThreadLimit one(1); // budgets are of processor time
    try {
        TrialOptions options;
        if (command == "run" && count >= 4) {
            options.poses = static_cast<std::uint64_t>(number(4, 1000));
            options.bakeSeconds = number(5, options.bakeSeconds);
            options.verifySeconds = number(6, options.verifySeconds);
            options.attackSeconds = number(7, options.attackSeconds);
            return run(std::stoull(arguments[2]), std::stoull(arguments[3]), options);
        }
        if (command == "one" && count >= 3) {
            options.poses = static_cast<std::uint64_t>(number(3, 5000));
            options.bakeSeconds = options.verifySeconds = 1e9;
            describe(tryScene(std::stoull(arguments[2]), options));
            return 0;
        }
        if (command == "file" && count >= 3)
            return file(arguments[2], static_cast<std::uint64_t>(number(3, 5000)));
        if (command == "write" && count == 4) {
            const NamedDraft drawn = drawScene(std::stoull(arguments[2]));
            tss::writeFileAtomically(arguments[3], extreme::textOf(sceneOf(drawn.draft, drawn.name)));
            return 0;
        }
        std::fputs(usage, stderr);
        return command == "--help" ? 0 : 2;
    } catch (const tss::InputError& error) {
        std::fprintf(stderr, "tss-adversary: %s\n", error.what());
        return 1;
    }
}
