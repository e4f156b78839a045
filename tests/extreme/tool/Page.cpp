#include "tests/extreme/tool/Page.h"

#include "tests/extreme/scenes/ExtremeScene.h"
#include "tests/extreme/tool/Invariance.h"
#include "tests/extreme/tool/LongRun.h"
#include "tests/extreme/tool/RandomScene.h"

#include <fmt/format.h>

namespace extreme {

namespace {

struct Served {
    const ExtremeScene& scene;
    Outcome outcome;
};

std::string steps(const PairFigures& pair) {
    std::string text;
    for (const auto& [status, count] : pair.statuses)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status);
    return text;
}

std::string pairRow(const Served& served) {
    const PairFigures& pair = served.outcome.pairs.at(0);
    const tss::Pair& model = served.outcome.scene.pairs.at(0);
    const std::string proven = pair.verdict.holds() ? fmt::format("{} cells", pair.verdict.cells) : "FAILS";
    std::string row = fmt::format("| `{}` | {} | {} | {} + {} | ", served.scene.name, served.scene.asked,
                                  served.scene.holds, pair.verdict.spheresA, pair.verdict.spheresB);
    if (!model.table) return row + fmt::format("never meet | | {} | | | | | {} |\n", proven, steps(pair));
    const KernelFigures& kernel = *pair.kernel;
    row += fmt::format("{} | {:.3g} / {:.3g} | {} | ", model.table->testCount(),
                       model.table->boundMiss.value_or(-1), model.table->boundEarly.value_or(-1), proven);
    row += fmt::format("{} {} | {:.3g} | {:.2g} | {:.2g} | {} |\n", tss::name(kernel.form),
                       tss::name(kernel.precision), kernel.condition, kernel.floatBand, kernel.band,
                       steps(pair));
    return row;
}

std::string pairTable(const std::vector<Served>& all) {
    std::string text =
        "## Pairs\n\n"
        "Spheres: that the table answers for. Miss / early: its bounds, scene units. Proven: cells of Q that "
        "`tss verify`'s\nproof takes. Condition: by how many roundoffs of its squared reach the worst test "
        "may "
        "be off. Bands: gaps, in scene\nunits, at which rounding may turn a verdict, if the kernel were in "
        "float and as it is. Steps: what became of the 49\nsteps of the scene's own motion, which goes from "
        "limit to limit and back.\n\n"
        "| scene | asked | what must hold | spheres | tests | miss / early | proven | kernel | condition | "
        "float band | band | steps |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Served& served : all)
        if (served.scene.fate == Fate::Table || served.scene.fate == Fate::NeverMeet) text += pairRow(served);
    return text;
}

std::string skinTable(const std::vector<Served>& all) {
    std::string text = "\n## Skins\n\n"
                       "Farthest: that a vertex goes, as a share of the skin's size. Residual: the deepest "
                       "that one stays in "
                       "the muscle beyond\nits depth at rest, likewise, over the scene's own motion.\n\n"
                       "| scene | asked | what must hold | stretch, bend compliance | farthest | residual |\n"
                       "|---|---|---|---|---|---|\n";
    for (const Served& served : all) {
        if (served.scene.fate != Fate::Skin) continue;
        for (std::size_t k = 0; k < served.outcome.skins.size(); ++k) {
            const SkinFigures& skin = served.outcome.skins[k];
            const tss::SkinModel& model = served.outcome.scene.skins[k];
            text += fmt::format("| `{}` | {} | {} | {:g}, {:g} | {:.4f} | {:.2g} |\n", served.scene.name,
                                served.scene.asked, served.scene.holds, model.stretchCompliance,
                                model.bendCompliance, skin.farthest / skin.size, skin.residual / skin.size);
        }
    }
    return text;
}

std::string refusedTable(const std::vector<Served>& all) {
    std::string text = "\n## Refused\n\n| scene | asked | message |\n|---|---|---|\n";
    for (const Served& served : all) {
        if (served.scene.fate != Fate::NotReadable && served.scene.fate != Fate::NotBakeable) continue;
        text += fmt::format("| `{}` | {} | `{}` |\n", served.scene.name, served.scene.asked,
                            served.outcome.refusal);
    }
    return text;
}

std::string longRuns(const std::vector<Served>& all, const PageOptions& options) {
    std::string text = "\n## Long runs\n\n";
    for (const Served& served : all) {
        if (served.scene.name == "to_and_fro") {
            const ToAndFro run = driveToAndFro(served.outcome.scene, options.steps);
            text += fmt::format("- `to_and_fro`: {} steps through the contact and back, {} of them not free: "
                                "largest difference from the second\n  round {:g}; smallest gap {:.3g}.\n",
                                run.steps, run.blocked, run.drift, run.deepest);
        }
        if (served.scene.name != "skin_million") continue;
        for (const bool rest : {true, false}) {
            const ManyFrames run = playFrames(served.outcome.scene, options.frames, rest);
            text +=
                fmt::format("- `skin_million`, {} frames, {}: creep since the third round {:.2g} of the "
                            "size; memory grew by {} kB;\n  the last thousand frames took {:.2f} times as "
                            "long as the second; {:g} of its numbers are subnormal.\n",
                            run.frames, rest ? "letting go all the way" : "never quite letting go",
                            run.creep / run.size, run.growth / 1024, run.slowdown, run.subnormals);
        }
    }
    return text;
}

std::string invarianceTable() {
    std::string text =
        "\n## What must not matter\n\n"
        "The pair of `to_and_fro` baked again with something changed. Off: the farthest that a "
        "sphere is from its like, units of\nthe first bake, in which the pair is 40 long. "
        "Verdicts: at 2000 poses, outside of the band.\n\n"
        "| changed | same tests | off | band | verdicts that differ |\n|---|---|---|---|---|\n";
    for (const Invariance& result : invariances(2000))
        text += fmt::format("| {} | {} | {:.2g} | {:.2g} | {} of {} ({} hits) |\n", result.change,
                            result.sameTests ? "yes" : "no", result.off, result.band, result.differ,
                            result.poses, result.hits);
    return text;
}

std::string randomRuns(const PageOptions& options) {
    std::uint64_t refused = 0, stopped = 0, trouble = 0, tables = 0;
    for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
        const RandomRun run = runRandom(seed, 5);
        stopped += run.stopped;
        refused += !run.stopped && !run.refusal.empty();
        trouble += !run.troubles.empty();
        tables += run.table;
    }
    return fmt::format(
        "\n## Random search for trouble\n\n"
        "`tss-extreme random N` takes N random scenes through bake, verify and play, with 5 s "
        "of processor time for each. Here {}:\n{} served whole ({} with a table), {} stopped "
        "by their budget, {} refused with a place and a reason, {} in trouble: a\ncrash, a "
        "number that is not one, a bound that does not hold, a contact of the meshes missed, a "
        "free joint led into contact.\n",
        options.seeds, options.seeds - refused - stopped, tables, stopped, refused, trouble);
}

} // namespace

std::string stabilityPage(const PageOptions& options) {
    std::vector<Served> all;
    for (const ExtremeScene& scene : extremeScenes()) all.push_back({scene, serve(scene.text, scene.name)});
    std::string text = fmt::format(
        "# Stiff and extreme cases\n\n"
        "Every scene of `scenes/extreme`, taken through bake, verify and play with each kernel of the "
        "machine "
        "(scalar, SSE2,\nAVX2, ...). The scenes, and this page, are written by code:\n\n"
        "    build/bin/tss-extreme scenes scenes/extreme\n"
        "    build/bin/tss-extreme page docs/STABILITY.md {} {} {}\n\n"
        "(steps, frames and random scenes.) What must hold is asked by the tests under `tests/extreme`, in "
        "which an invalid\noperation, a division by zero or an overflow ends the test; `tss info` prints "
        "kernel, condition and band of any baked\nscene.\n\n",
        options.steps, options.frames, options.seeds);
    text += pairTable(all) + skinTable(all) + refusedTable(all);
    return text + longRuns(all, options) + invarianceTable() + randomRuns(options);
}

} // namespace extreme
