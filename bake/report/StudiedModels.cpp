#include "bake/report/Text.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::reporting {

namespace {

std::string inMillimetres(double length, double millimetres) {
    return fmt::format("{:.3g} mm", length * millimetres);
}

/// Named by its tolerance and, where it has one, its epsilon.
Recipe named(BakeOptions options, double millimetres) {
    std::string name = inMillimetres(*options.tolerance, millimetres);
    if (options.epsilon > 0) name += ", ε " + inMillimetres(options.epsilon, millimetres);
    return {name, std::move(options)};
}

BakePoint bakePoint(const Model& model, const std::string& about) {
    const compare::ComparedPair& problem = model.problem;
    const Table& table = problem.table;
    BakePoint point;
    point.name = model.recipe.name;
    point.about = about;
    point.tolerance = *model.recipe.options.tolerance;
    point.epsilon = model.recipe.options.epsilon;
    const auto sticksOut = [](const FitRecord& fit, const SphereSet& spheres, const TriangleMesh& mesh) {
        return fit.protrusion ? *fit.protrusion : protrusionOf(spheres, mesh);
    };
    point.protrusion = std::max(sticksOut(problem.fitA, problem.a, problem.meshA),
                                sticksOut(problem.fitB, problem.b, problem.meshB));
    point.spheresA = problem.a.size();
    point.spheresB = problem.b.size();
    point.usedA = table.a.size();
    point.usedB = table.b.size();
    point.tests = table.testCount();
    point.restTests =
        static_cast<std::size_t>(std::ranges::count_if(table.restGaps, [](double gap) { return gap < 0; }));
    point.bytes = tableBytes(table);
    point.certified = table.certified;
    if (table.record.lowerBound > 0) point.lowerBound = static_cast<double>(table.record.lowerBound);
    point.sphereSeconds = model.sphereSeconds;
    point.tableSeconds = model.tableSeconds;
    return point;
}

/// Makes the models of one pair, whose figures go into the study as each is made.
class Maker {
public:
    Maker(PairStudy& study, const SceneModel& scene, const Pair& pair, bool quick, const Progress& progress)
        : study_(study), scene_(scene), pair_(pair), quick_(quick), progress_(progress) {}

    std::vector<StudiedModel> all;
    std::shared_ptr<const Model> base;

    /// Tables of ever finer spheres, the base among them.
    void addTolerances(const TriangleMesh& a, const TriangleMesh& b) {
        const BakeOptions start = startOptions(a, b);
        for (const double factor :
             quick_ ? std::vector{1.0, 0.5} : std::vector{4.0, 2.0, 1.0, 0.5, 0.25, 0.125}) {
            BakeOptions changed = start;
            changed.tolerance = factor * *start.tolerance;
            const Recipe recipe = named(changed, study_.millimetres);
            tell("spheres and table, " + recipe.name);
            add(study_.tolerances, makeModel(scene_, pair_, recipe),
                factor == 1 ? MethodScope::All : MethodScope::Spheres);
            if (factor != 1) continue;
            base = all.back().model;
            study_.base = study_.tolerances.back();
        }
    }

    /// Tables over the base's spheres for other epsilons.
    void addEpsilons() {
        study_.epsilons.push_back(study_.base);
        for (const double factor :
             quick_ ? std::vector{0.1, 1.0} : std::vector{0.01, 0.03, 0.1, 0.3, 1.0, 3.0}) {
            BakeOptions changed = base->recipe.options;
            changed.epsilon = factor * *changed.tolerance;
            const Recipe recipe = named(changed, study_.millimetres);
            tell("table, " + recipe.name);
            add(study_.epsilons, makeModel(*base, recipe), MethodScope::Table);
        }
    }

    /// Other spheres and tables at the base's tolerance: what the paper does, and what is lost or won.
    void addOtherRecipes() {
        tell("other recipes");
        Recipe paper{"paper", base->recipe.options};
        paper.options.spheres = SphereMethod::Growth;
        paper.options.search = SearchMethod::Sampled;
        paper.options.reduce = ReduceMethod::Cooccurrence;
        if (quick_) paper.options.samples = 2000;
        addSpheres(paper,
                   "the paper's own: spheres by growth in the narrow regions, sampled search, reduction by "
                   "co-occurrence");
        Recipe growth{"growth, certified", base->recipe.options};
        growth.options.spheres = SphereMethod::Growth;
        growth.options.search = SearchMethod::Certified;
        growth.options.reduce = ReduceMethod::Cover;
        addSpheres(growth, "the paper's spheres by growth, with the certified search and cover");
        if (!quick_) {
            add(study_.recipes, wholeBodies(*base, {"whole bodies", base->recipe.options}),
                MethodScope::Spheres, "our spheres over the whole surfaces, not only where the two can meet");
            Recipe inscribed{"inscribed", base->recipe.options};
            inscribed.options.conservative = false;
            addSpheres(inscribed,
                       "spheres inside the bodies instead of about their surface (`--no-conservative`)");
            Recipe sampled{"paper's reduction", base->recipe.options};
            sampled.options.search = SearchMethod::Sampled;
            sampled.options.reduce = ReduceMethod::Cooccurrence;
            addTable(sampled, "our spheres, the paper's sampled search and its reduction by co-occurrence");
            sampled.name = "minimal over samples";
            sampled.options.reduce = ReduceMethod::Minimal;
            addTable(
                sampled,
                "our spheres, the smallest set that answers alike at the poses explored (the paper's M_ss)");
        }
        const compare::ComparedPair& problem = base->problem;
        const AtRest asked = optionsFor(scene_, pair_).atRest;
        if (asked == AtRest::Collide ||
            ruleOfSpheres(problem.a, problem.b, problem.motion, AtRest::Ignore).empty())
            return;
        const bool ignored = asked == AtRest::Ignore;
        Recipe atRest{ignored ? "at rest: ignore" : "at rest: offset", base->recipe.options};
        atRest.options.atRest = asked;
        addSpheres(atRest,
                   ignored ? "what `tss bake` stores by the scene's settings: the region that overlaps at "
                             "rest never touches"
                           : "what `tss bake` stores: the region that overlaps at rest touches only where "
                             "it goes deeper");
    }

private:
    void tell(const std::string& what) const { report(progress_, study_.path + ": " + what, 0); }

    void add(std::vector<BakePoint>& points, std::shared_ptr<const Model> model, MethodScope scope,
             const std::string& about = "") {
        points.push_back(bakePoint(*model, about));
        all.push_back({std::move(model), scope});
    }

    /// What `tss bake` would be asked for. Where the scene asks for so many spheres at most, the tolerance
    /// that these reach takes the place of that number.
    BakeOptions startOptions(const TriangleMesh& a, const TriangleMesh& b) {
        BakeOptions options = optionsFor(scene_, pair_);
        options.atRest = AtRest::Collide;
        if (!options.tolerance) options.tolerance = std::min(diagonal(a), diagonal(b)) / 500;
        if (options.maxSpheres == 0) return options;
        tell("spheres, as many as the scene asks for");
        const BakePoint point = bakePoint(*makeModel(scene_, pair_, {"", options}), "");
        study_.notes.push_back(
            fmt::format("The scene asks for at most {} spheres a body; these, {} + {}, stick "
                        "out by {} mm, the tolerance that this report starts from.",
                        options.maxSpheres, point.spheresA, point.spheresB,
                        number(point.protrusion * study_.millimetres)));
        options.maxSpheres = 0;
        if (point.protrusion > 0) options.tolerance = point.protrusion;
        return options;
    }

    /// Other spheres, with a table over them.
    void addSpheres(const Recipe& recipe, const std::string& about) {
        add(study_.recipes, makeModel(scene_, pair_, recipe), MethodScope::Spheres, about);
    }

    /// Another table over the base's spheres.
    void addTable(const Recipe& recipe, const std::string& about) {
        add(study_.recipes, makeModel(*base, recipe), MethodScope::Table, about);
    }

    PairStudy& study_;
    const SceneModel& scene_;
    const Pair& pair_;
    const bool quick_;
    const Progress& progress_;
};

} // namespace

std::pair<std::shared_ptr<const Model>, std::vector<StudiedModel>>
studiedModels(PairStudy& study, const SceneModel& scene, const Pair& pair, const TriangleMesh& a,
              const TriangleMesh& b, bool quick, const Progress& progress) {
    Maker maker(study, scene, pair, quick, progress);
    maker.addTolerances(a, b);
    if (maker.base->proof || maker.base->problem.table.testCount() == 0) return {maker.base, {}};
    maker.addEpsilons();
    maker.addOtherRecipes();
    std::erase_if(maker.all,
                  [](const StudiedModel& one) { return one.model->problem.table.testCount() == 0; });
    return {maker.base, std::move(maker.all)};
}

} // namespace tss::reporting
