#include "bake/report/Text.h"

#include "bake/report/Columns.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::reporting {

namespace {

const Row* findRow(const PairStudy& study, const std::string& method, const std::string& setting) {
    for (const Row& row : study.rows)
        if (row.method == method && row.setting == setting) return &row;
    return nullptr;
}

/// The first that has a time, of a method that needs no spheres.
const Row* findMeshRow(const PairStudy& study, const std::string& method) {
    const Row* row = findRow(study, method, "");
    return row && row->times.median > 0 ? row : nullptr;
}

/// Families as a reader wants to meet them; what is not named comes last.
std::size_t place(const std::string& family) {
    static const char* const order[] = {"TSS",
                                        "C-space grid",
                                        "motion regions",
                                        "allowed paths",
                                        "sphere tree, used spheres",
                                        "sphere tree, all spheres",
                                        "medial sphere tree",
                                        "octree sphere tree",
                                        "O'Rourke-Badler",
                                        "all pairs",
                                        "mesh tree (FCL)",
                                        "mesh tree (Bullet)"};
    return static_cast<std::size_t>(std::find(std::begin(order), std::end(order), family) -
                                    std::begin(order));
}

/// As the paper has it where the leading DOF turns.
std::string regionName(const PairStudy& study) {
    return study.leadingUnit == "degrees" ? "angular region" : "region";
}

std::string methodTable(const PairStudy& study) {
    std::vector<Row> rows;
    for (const Row& row : study.rows)
        if (row.setting.empty() || row.setting == study.base.name) rows.push_back(row);
    std::ranges::stable_sort(
        rows, [](const Row& a, const Row& b) { return place(a.about.family) < place(b.about.family); });
    return markdownTable(methodColumns(study), rows);
}

/// What lies on the front of the plot, in words.
std::string frontText(const PairStudy& study) {
    const double mm = study.millimetres;
    const auto worst = [mm](const Row& row) { return std::max(leastErrorDrawn, mm * row.worst()); };
    std::string text = "On the front:";
    for (const Row* row : paretoFront(
             study.rows, [](const Row& r) { return r.times.median; }, worst))
        text += fmt::format("{} {}{} ({}, {} mm{})", text.back() == ':' ? "" : ";", row->method,
                            row->setting.empty() ? "" : fmt::format(" with {}", row->setting),
                            timeText(row->times.median), number(mm * row->worst()),
                            row->misses() ? fmt::format(", {} contacts missed", row->misses()) : "");
    return text + (std::ranges::any_of(study.rows, &Row::slow)
                       ? ". Slow methods, judged at fewer poses, take no part.\n\n"
                       : ".\n\n");
}

/// One line a model: what the table costs and errs, and how its methods over the same spheres or on the
/// meshes compare.
std::string ratioTable(const PairStudy& study) {
    const Row* fcl = findMeshRow(study, "fcl-obbrss");
    const Row* bullet = findMeshRow(study, "bullet-gimpact");
    std::string text = "| spheres | tests | missed | deepest missed, mm | early, uniform | farthest early, "
                       "mm | time a query (p10–p90) | its loop over indices | sphere tree of all | FCL, OBB "
                       "and RSS | Bullet GImpact |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    const auto add = [&](const BakePoint& point) {
        const Row* ours = findRow(study, "tss", point.name);
        if (!ours || !(ours->times.median > 0)) return;
        const auto against = [&](const Row* row) {
            return row && row->times.median > 0
                       ? fmt::format("{}×", number(row->times.median / ours->times.median))
                       : std::string("–");
        };
        text += fmt::format(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            point.name == study.base.name ? "**" + point.name + "**" : point.name, point.tests,
            shareText(ours->misses(), ours->uniform.touching + ours->near.touching),
            ours->misses() ? number(study.millimetres * ours->deepestMiss()) : "",
            shareText(ours->uniform.early, ours->uniform.poses - ours->uniform.touching),
            ours->uniform.early + ours->near.early ? number(study.millimetres * ours->farthestEarly()) : "",
            timeText(ours->times), against(findRow(study, "tss-scalar", point.name)),
            against(findRow(study, "tree-all-8-balls", point.name)), against(fcl), against(bullet));
    };
    for (const BakePoint& point : modelsOf(study)) add(point);
    return text;
}

/// What this project set out to reach, and whether the base's table does.
std::string goalsText(const PairStudy& study, bool goals) {
    const Row* ours = findRow(study, "tss", study.base.name);
    if (!ours || !(ours->times.median > 0)) return "";
    std::string text = goals ? "Goals of this project, with the table of " + study.base.name + ":" : "";
    const auto goal = [&](const Row* row, const std::string& what, double times) {
        if (!goals || !row || !(row->times.median > 0)) return;
        const double ratio = row->times.median / ours->times.median;
        text += fmt::format("{} {} in at least {} times the table's time: {}, {}reached",
                            text.back() == ':' ? "" : ";", what, number(times), number(ratio),
                            ratio >= times ? "" : "not ");
    };
    goal(findMeshRow(study, "fcl-obbrss"), "FCL's first hit", 5000);
    goal(findRow(study, "tree-all-8-balls", study.base.name), "the sphere tree", 500);
    goal(findRow(study, "tree-all-8-balls", "whole bodies"), "the sphere tree over whole bodies", 500);
    goal(findRow(study, "tss-scalar", study.base.name), "the scalar loop over indices", 10);
    if (goals) text += ". ";
    const Row* fcl = findMeshRow(study, "fcl-obbrss");
    if (fcl && study.fclDirectly.median > 0)
        text += fmt::format("FCL is not slowed down by being asked through this report: its row takes {} "
                            "times what it takes when called directly ({}).",
                            number(fcl->times.median / study.fclDirectly.median),
                            timeText(study.fclDirectly.median));
    return text.empty() ? text : text + "\n";
}

/// When to choose what, from the figures above and nothing else.
std::string advice(const PairStudy& study) {
    const Row* ours = findRow(study, "tss", study.base.name);
    if (!ours || !(ours->times.median > 0)) return "";
    const double mm = study.millimetres;
    std::string text;
    const Row* winner = nullptr;
    for (const Row& row : study.rows) {
        if (row.about.family != "C-space grid") continue;
        const Row* table = findRow(study, "tss", row.setting);
        const auto named = [&](const BakePoint& point) { return point.name == row.setting; };
        if (!table || std::ranges::none_of(study.tolerances, named)) continue;
        const bool faster = row.times.median < table->times.median,
                   right = row.worst() <= 1.1 * table->worst();
        if (faster && right && (!winner || row.times.median < winner->times.median)) winner = &row;
        text += fmt::format(
            "- {} over the spheres of {}: {} and {} against the table's {} and {}; it misses {} contacts, "
            "the deepest by {} mm, and is early by {} mm at most (the table: {}, {} and {} mm). {}\n",
            row.method, row.setting, timeText(row.times.median), bytesText(row.about.bytes),
            timeText(table->times.median), bytesText(table->about.bytes), row.misses(),
            number(mm * row.deepestMiss()), number(mm * row.farthestEarly()), table->misses(),
            number(mm * table->deepestMiss()), number(mm * table->farthestEarly()),
            faster && right ? "**Here the grid wins.**"
            : faster        ? "Quicker, but not as right."
            : right         ? "As right, but not quicker."
                            : "Neither quicker nor as right.");
    }
    text +=
        winner
            ? "\nWhere only yes or no is wanted, memory is no matter and no bound is needed, take the **grid "
              "of gaps** here: its time does not depend on the shape. It knows no contact point, its memory "
              "grows with the power of the DOFs, and what it promises between its points is little.\n\n"
            : "\nA **grid of gaps** does not win here by the figures above.\n\n";
    return text +
           "Take the **table** where the motion is constrained and known when baking, every frame asks, and "
           "it must be known how wrong an answer can be; it also gives gap, contact point, normal and "
           "gradient. Take a **mesh tree** (FCL, Bullet) where the motion is free, or where the exact answer "
           "of the triangles is wanted and its time does not matter. A **sphere tree** serves where spheres "
           "are wanted and the motion is not known beforehand. **Angular regions** and **allowed paths** are "
           "next to free of cost, and right for a single DOF only.\n";
}

/// What a table is made of; besidePaper: with the paper's own pair beside it.
std::string countTable(const PairStudy& study, bool besidePaper) {
    const BakePoint& ours = study.base;
    const auto paper = [&](const char* text) { return std::string(besidePaper ? text : ""); };
    std::string head = "| |" + paper(" the paper: dog's skull + mandible |"), rule = "|---|" + paper("---|"),
                spheres, used, tests, products;
    const auto column = [&](const std::string& title, const BakePoint& point) {
        head += fmt::format(" {} |", title);
        rule += "---|";
        spheres += fmt::format(" {} + {} |", point.spheresA, point.spheresB);
        used += fmt::format(" {} + {} |", point.usedA, point.usedB);
        tests += fmt::format(" {} |", point.tests);
        products += fmt::format(" {} |", compare::productsPerSphereTest * point.tests);
    };
    for (const BakePoint& recipe : study.recipes)
        if (recipe.name == "paper") column("the paper's recipe on this pair", recipe);
    column(fmt::format("{}{}, {}", paper("this software: "), ours.name,
                       ours.certified ? "every pose proven" : "sampled poses only"),
           ours);
    std::string text = head + "\n" + rule + "\n| spheres |" + paper(" 1158 + 812 |") + spheres +
                       "\n| spheres used |" + paper(" 9 + 22 |") + used + "\n| tests a step |" +
                       paper(" 22 |") + tests + "\n| products a step |" + paper(" 88 |") + products + "\n\n";
    if (ours.lowerBound)
        text += fmt::format("No table that gives the answers of these spheres at {} has fewer than {}. ",
                            ours.certified ? "every pose" : "the poses explored",
                            counted(static_cast<std::size_t>(*ours.lowerBound), "test"));
    const StepStudy& steps = study.steps;
    const auto shareOf = [&](std::size_t part) {
        return 100 * static_cast<double>(part) /
               static_cast<double>(std::max<std::size_t>(1, steps.leading.size()));
    };
    text += fmt::format("Steps in the {} of collision: {:.0f} % of {} along {} by the meshes, {:.0f} % by "
                        "the spheres of {}{}.{}\n",
                        regionName(study), shareOf(steps.inMeshRegion), steps.leading.size(), steps.motion,
                        shareOf(static_cast<std::size_t>(std::ranges::count(steps.inRegion, char{1}))),
                        ours.name, paper(" (the paper: 22 %)"),
                        paper(" The pairs and their limits are not the same: the counts say of what size "
                              "such tables are, not which method is better."));
    return text;
}

std::string sizeTable(const PairStudy& study) {
    std::string text = markdownTable(modelColumns(study), modelsOf(study), isBase(study));
    text += "\n";
    for (const BakePoint& point : study.recipes)
        text +=
            fmt::format("- **{}**: {}{}.\n", point.name, point.about,
                        point.restTests ? fmt::format(", {} of {} tests", point.restTests, point.tests) : "");
    return text;
}

std::string samplingTable(const PairStudy& study) {
    return "What tables from a sampled search miss of the poses at which the same spheres collide:\n\n" +
           markdownTable(samplingColumns(), study.sampling);
}

std::string whatTheyAre(const PairStudy& study) {
    std::string text;
    std::vector<std::string> said;
    for (const Row& row : study.rows) {
        if (std::ranges::find(said, row.method) != said.end()) continue;
        if (!row.setting.empty() && row.setting != study.base.name) continue;
        said.push_back(row.method);
        text += fmt::format("- **{}**: {}.\n", row.method, row.about.about);
    }
    return text;
}

std::string facts(const PairStudy& study) {
    std::string text = fmt::format("{} ({} triangles) moves against {} ({} triangles)", study.nameB,
                                   study.trianglesB, study.nameA, study.trianglesA);
    for (std::size_t k = 0; k < study.dofs.size(); ++k) text += (k ? ", " : " by ") + study.dofs[k];
    text += ".\n\n";
    if (study.never) return text;
    text += fmt::format("Judged at {} poses spread uniformly over the limits, {} of them touching, and at {} "
                        "poses near contact, both ends of segments bisected to a millionth of the limits; "
                        "timed at the first {} of the uniform poses (slow methods at fewer, at least 100). "
                        "Contact at rest counts as contact, as the meshes say.",
                        study.uniformPoses, study.touchingUniform, study.nearPoses, study.timedPoses);
    if (study.earlyBound && study.touchingUniform < study.uniformPoses)
        text += fmt::format(" At {} of the {} free ones the meshes are nearer than {} mm, the early bound of "
                            "the table with spheres of {}: only there may it report contact early.",
                            study.freeWithinBound, study.uniformPoses - study.touchingUniform,
                            number(*study.earlyBound * study.millimetres), study.base.name);
    if (study.leftOut)
        text += fmt::format(" {} poses were left out: a closed part of one body is wholly inside the other "
                            "there, which is contact for solids and none for surfaces.",
                            study.leftOut);
    text += "\n\n";
    for (const std::string& note : study.notes) text += note + "\n\n";
    return text;
}

std::string errorSection(const PairStudy& study, const std::vector<Plot>& plots) {
    return "\n### Error against run time\n\n" + pictureText(plots, "pareto") + frontText(study) +
           pictureText(plots, "verdicts") +
           fmt::format("All methods, those on spheres with the spheres of {}:\n\n", study.base.name) +
           methodTable(study) +
           fmt::format(
               "\nMissed: poses where the meshes touch and the method says free; how deep: the deepest "
               "vertex of one mesh inside the other, 0 where only edges cross. Early: free poses where it "
               "says contact; how far: the distance of the meshes. Promised: what holds for every pose "
               "within the limits, – where nothing is promised. First contact: along straight ways from a "
               "free to a touching pose, how far the farthest point of the moving body is at worst from "
               "where the meshes first touch{}. Tests: of two spheres, a query, 4 products each as the paper "
               "counts; a table is counted with all of its tests, of which its kernels leave out what cannot "
               "matter at the pose; the others stop at the first hit.\n\n",
               study.leadingUnit == "degrees"
                   ? fmt::format(", and the angle of {} in between", study.leadingDof)
                   : "");
}

std::string ratioSection(const PairStudy& study, bool besidePaper) {
    return "### How much quicker, at which error\n\n"
           "The table for each model, and how many times its time others take. The loop over indices is the "
           "same table as the paper runs it, the sphere tree stands on the same spheres; FCL answers for the "
           "triangles exactly, Bullet in single precision. With ε above 0 a yes/no table is silent where its "
           "own nearest pair is still up to ε apart while others touch, however deep those are.\n\n" +
           ratioTable(study) + "\n" + goalsText(study, besidePaper) + "\n";
}

std::string motionSection(const PairStudy& study, const std::vector<Plot>& plots) {
    std::string text =
        "\n### Along a motion\n\n" + pictureText(plots, "steps") + pictureText(plots, "region");
    for (const auto& [region, whose] : {std::pair(&study.region.meshes, std::string("meshes")),
                                        std::pair(&study.region.spheres, "spheres of " + study.base.name)})
        text += region->upper > region->lower
                    ? fmt::format("The {} of collision of the {} is {:.3g} to {:.3g} {} of {}; {:.3g} % of "
                                  "the poses in it collide.\n",
                                  regionName(study), whose, region->lower, region->upper, study.leadingUnit,
                                  study.leadingDof, 100 * region->meanShare())
                    : fmt::format("There is no {} of collision of the {}: nothing collided.\n",
                                  regionName(study), whose);
    return text + "\n";
}

std::string sweepSection(const PairStudy& study, const std::vector<Plot>& plots) {
    return "### Sweeps\n\n" + sizeTable(study) + "\n" + pictureText(plots, "bake") +
           pictureText(plots, "epsilon") + pictureText(plots, "memory") + samplingTable(study) + "\n" +
           pictureText(plots, "sampling");
}

} // namespace

std::vector<const Row*> paretoFront(const std::vector<Row>& rows, const std::function<double(const Row&)>& x,
                                    const std::function<double(const Row&)>& y) {
    std::vector<const Row*> sorted, front;
    for (const Row& row : rows)
        if (x(row) > 0 && !row.slow()) sorted.push_back(&row);
    std::ranges::stable_sort(sorted, [&](const Row* a, const Row* b) { return x(*a) < x(*b); });
    for (const Row* row : sorted)
        if (front.empty() || y(*row) < y(*front.back())) front.push_back(row);
    return front;
}

std::string pairText(const PairStudy& study, const std::vector<Plot>& plots, bool besidePaper) {
    std::string text = fmt::format("## {}\n\n", study.path) + facts(study);
    if (study.never)
        return text + *study.never + " No table is needed and no method has anything to find.\n\n";
    text += (besidePaper ? "### Beside the paper\n\n" : "### The table\n\n") +
            countTable(study, besidePaper) + errorSection(study, plots) + ratioSection(study, besidePaper) +
            "### When to choose what\n\n" + advice(study) + motionSection(study, plots) +
            sweepSection(study, plots) + "### What each method is\n\n" + whatTheyAre(study);
    if (!study.notRun.empty()) text += "\n### What was not run\n\n" + notRunText(study.notRun);
    return text + "\n";
}

} // namespace tss::reporting
