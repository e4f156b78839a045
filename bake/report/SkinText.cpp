#include "bake/report/Text.h"

#include <fmt/format.h>

namespace tss::reporting {

std::string skinText(const SkinStudy& study, const std::vector<Plot>& plots) {
    const double mm = study.millimetres;
    std::string text = fmt::format(
        "## {}: skin over {} muscle{}\n\n"
        "| | the paper: skin + muscle | this scene, skin at rest (the paper's way) | this scene, skin "
        "carried (default) |\n"
        "|---|---|---|---|\n| spheres | 1426 + 280 | {} + {} | {} + {} |\n| spheres used | 70 + 190 | {} + "
        "{} | {} + {} |\n"
        "| tests a step | 268 | {} | {} |\n| products a step | 1072 | {} | {} |\n"
        "| products a step with ellipsoids | 2870 (41 a test) | {:.0f} ({:.0f} a test) | |\n\n",
        study.path, study.muscles, study.muscles == 1 ? "" : "s", study.skinSpheres, study.muscleSpheres,
        study.skinSpheres, study.muscleSpheres, study.usedSkin, study.usedMuscle, study.carriedSkin,
        study.carriedMuscle, study.tests, study.carriedTests, 4 * study.tests, 4 * study.carriedTests,
        study.productsEllipsoid * static_cast<double>(study.usedSkin * study.muscles),
        study.productsEllipsoid);
    text += fmt::format(
        "{} activations, {} skin spheres of radius {} mm each; at {} of {} vertex and activation pairs the "
        "muscle's surface is within that radius of the vertex at rest.\n\n"
        "| method | tests a step | products a step | time a step | missed | deepest, mm | early | farthest, "
        "mm |\n"
        "|---|---|---|---|---|---|---|---|\n",
        study.activations, study.skinSpheres, number(study.thickness * mm), study.touching, study.judged);
    for (const SkinMethod& m : study.methods)
        text += fmt::format("| {} | {} | {} | {} µs | {} | {} | {} | {} |\n", m.name, number(m.tests),
                            number(m.products), number(m.nanoseconds / 1e3), m.missed,
                            number(m.deepestMiss * mm), m.early, number(m.farthestEarly * mm));
    text += pictureText(plots, "pareto") + "What each method is:\n\n";
    for (const SkinMethod& m : study.methods) text += fmt::format("- **{}**: {}.\n", m.name, m.about);
    return text + "\nWhat was not run:\n\n" + notRunText(study.notRun) + "\n";
}

} // namespace tss::reporting
