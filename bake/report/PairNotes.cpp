#include "bake/report/Columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tss::reporting {

namespace {

bool hasNoSpheres(const BakePoint& point) {
    return point.spheresA == 0 || point.spheresB == 0;
}

/// Names of the models that have no row, for their tables are empty.
std::vector<std::string> withoutTests(const PairStudy& study, bool spheres) {
    std::vector<std::string> names;
    for (const BakePoint& point : modelsOf(study))
        if (point.tests == 0 && hasNoSpheres(point) != spheres) names.push_back(point.name);
    return names;
}

} // namespace

std::string neverText(const SceneModel& scene, const Pair& pair, const Model& model) {
    if (!model.proof && !model.problem.table.certified)
        return "At none of the poses explored do the spheres of the two meet within these limits.";
    SceneModel baked = scene;
    Pair one = pair;
    PairReport notes;
    bakePair(baked, one, model.recipe.options, notes, {});
    const std::string apart = one.proof ? ": their surfaces stay more than " +
                                              lengthText(one.proof->clearance, scene.metersPerUnit) +
                                              " apart at every pose"
                                        : "";
    return "The two can never meet within these limits" + apart + ", proven.";
}

std::vector<std::string> notesOf(const PairStudy& study) {
    std::vector<std::string> notes;
    if (study.uniformPoses > 0 && study.touchingUniform == study.uniformPoses)
        notes.push_back(
            "The meshes touch at every one of these poses: no method can be early at them, and their errors "
            "tell nothing apart. Where they should not touch, look at the joint's origin, axis and limits.");
    if (study.uniformPoses > 0 && study.touchingUniform == 0)
        notes.push_back(
            "The meshes touch at none of these poses: no method can miss a contact at them, and all contact "
            "that one reports is early. A finer tolerance may prove that they never meet.");
    if (!study.base.certified)
        notes.push_back(fmt::format("The table of {} is made from sampled poses, as the scene asks: nothing "
                                    "is promised for the others.",
                                    study.base.name));
    for (const BakePoint& point : study.recipes)
        if (point.name.starts_with("at rest"))
            notes.push_back(
                fmt::format("The bodies overlap where the joint rests. `tss bake` excepts that region, with "
                            "the table called \"{}\" below, and so misses what here counts as contact.",
                            point.name));
    if (const auto names = withoutTests(study, false); !names.empty())
        notes.push_back(fmt::format("Without a sphere of some body, and so without a row below: {}. Growth "
                                    "starts at the triangles and needs many small ones.",
                                    fmt::join(names, "; ")));
    if (const auto names = withoutTests(study, true); !names.empty())
        notes.push_back(fmt::format(
            "With a table that has no test, reports no contact at any pose, and has no row below: {}.",
            fmt::join(names, "; ")));
    return notes;
}

} // namespace tss::reporting
