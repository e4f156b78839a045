#include "bake/report/Text.h"

#include "bake/report/Columns.h"

#include <fmt/format.h>

namespace tss::reporting {

namespace {

/// What a table is made of; besidePaper: with the paper's own skin beside it.
std::string countTable(const SkinStudy& study, bool besidePaper) {
    const auto paper = [&](const char* text) { return std::string(besidePaper ? text : ""); };
    std::string text = fmt::format(
        "| |{} skin at rest (the paper's way) | skin carried by its {} (what `tss bake` makes) |\n"
        "|---|{}---|---|\n| spheres |{} {} + {} | {} + {} |\n| spheres used |{} {} + {} | {} + {} |\n"
        "| tests a step |{} {} | {} |\n| products a step |{} {} | {} |\n",
        paper(" the paper: skin + muscle |"),
        study.bones == 0     ? "muscles"
        : study.muscles == 0 ? "bones"
                             : "muscles and bones",
        paper("---|"), paper(" 1426 + 280 |"), study.skinSpheres, study.muscleSpheres, study.skinSpheres,
        study.muscleSpheres, paper(" 70 + 190 |"), study.usedSkin, study.usedMuscle, study.carriedSkin,
        study.carriedMuscle, paper(" 268 |"), study.tests, study.carriedTests, paper(" 1072 |"),
        compare::productsPerSphereTest * study.tests, compare::productsPerSphereTest * study.carriedTests);
    const auto withEllipsoids = [&](std::size_t spheres) {
        return study.productsEllipsoid * static_cast<double>(spheres * study.below());
    };
    return text + fmt::format("| products a step, the same skin spheres against one bent ellipsoid a {} |{} "
                              "{:.0f} ({} × {:.0f}) | {:.0f} |\n",
                              study.partName(), paper(" 2870 (70 × 41) |"), withEllipsoids(study.usedSkin),
                              study.usedSkin * study.below(), study.productsEllipsoid,
                              withEllipsoids(study.carriedSkin));
}

std::string answerTable(const SkinStudy& study) {
    return markdownTable(answerColumns(study), study.motion.answers,
                         [](const SkinAnswer& a) { return a.usual; });
}

/// Which of the skin's spheres touch, by each method.
std::string touchText(const SkinStudy& study, const std::vector<Plot>& plots) {
    const std::string part = study.partName();
    const bool contracts = study.activations > 1;
    std::string text = fmt::format(
        "\n### Which skin spheres touch a {0}\n\n"
        "The paper's question, {1}: which of the skin's spheres, one a vertex at its rest place with a "
        "radius of {2} mm, touch a {0}? The truth is the distance of the vertex to the {0}'s surface: within "
        "the radius at {3} of {4} {5}. The spheres stand in for the surface and stick out of it, so that "
        "sphere methods say so somewhat early; all over the same spheres agree.\n\n",
        part,
        contracts ? fmt::format("at {} activations", study.activations)
                  : "once, at rest, for nothing below the skin contracts",
        number(study.thickness * study.millimetres), study.touching, study.judged,
        contracts ? "vertices and activations" : "vertices");
    text += pictureText(plots, "pareto") + markdownTable(methodColumns(study), study.methods) + "\n" +
            pictureText(plots, "steps");
    for (const SkinMethod& m : study.methods) text += fmt::format("- **{}**: {}.\n", m.name, m.about);
    return text;
}

/// How deep the skin would be if nothing pushed it.
std::string overlapText(const SkinStudy& study) {
    const SkinMotionStudy& motion = study.motion;
    const double mm = study.millimetres;
    const std::string part = study.partName();
    if (motion.untouched > 0)
        return fmt::format(
            "Deepest left: how much deeper than at rest a skin vertex is in a {}; it would be {} mm if {}, "
            "and is {} mm in the converged solve, the same problem solved until nothing moves.\n\n",
            part, number(motion.untouched * mm),
            motion.bones ? "the skin were only carried and nothing pushed it" : "the skin stayed where it is",
            number(motion.converged * mm));
    return motion.bones ? fmt::format("In this motion the skin comes no deeper into a {} than it is at rest, "
                                      "even if it is only carried: there is no overlap to resolve.\n\n",
                                      part)
                        : "In this motion no muscle comes deeper into the skin than it is at rest, even if "
                          "the skin stayed where it is: there is no overlap to resolve, the muscles only "
                          "carry the skin along.\n\n";
}

} // namespace

std::string skinText(const SkinStudy& study, const std::vector<Plot>& plots, bool besidePaper) {
    const SkinMotionStudy& motion = study.motion;
    std::string text =
        fmt::format("## {}\n\nA skin of {} vertices over {}.\n\n### {}\n\n", study.path, study.skinSpheres,
                    study.partCount(), besidePaper ? "Beside the paper" : "The table");
    text += countTable(study, besidePaper);
    if (besidePaper) text += "\nThe meshes are not the same: the counts say of what size such tables are.\n";
    text += touchText(study, plots);
    if (motion.answers.empty() || !(motion.farthestMove > 0))
        return text + "\nNothing of the skin moves.\n\n### What was not run\n\n" + notRunText(study.notRun) +
               "\n";
    text += fmt::format("\n### What the skin does about it\n\nPlayed over {} steps along {}; {} of the "
                        "vertices can move, at most {} mm. ",
                        motion.steps, motion.motion, motion.touched,
                        number(motion.farthestMove * study.millimetres));
    if (motion.bones) text += "Joints go where the motion asks, and are not kept out of contact. ";
    if (study.activations > 1)
        text += fmt::format("The muscles keep their volume to {:.1e} of it. ", motion.muscleVolume);
    text += overlapText(study);
    if (motion.untouched > 0) text += pictureText(plots, "answer");
    text += answerTable(study) + "\n" + pictureText(plots, "depth");
    return text + "### What was not run\n\n" + notRunText(study.notRun) + "\n";
}

} // namespace tss::reporting
