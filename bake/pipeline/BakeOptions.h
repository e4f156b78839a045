#pragma once
#include "bake/base/Stopwatch.h"
#include "bake/fill/WholeFits.h"
#include "bake/model/SceneModel.h"
#include "bake/search/AtRest.h"
#include "bake/spheres/SphereOptions.h"

#include <optional>
#include <string>
#include <vector>

namespace tss {

enum class SearchMethod { Certified, Sampled };
/// What a body is that stands inside the other, surfaces apart (METHOD 1.8).
enum class Inside {
    Free,    ///< no contact: the other one is hollow
    Contact, ///< both bodies are solid
};

enum class ReduceMethod { Cover, Cooccurrence, Minimal, None };

/// Settings of a bake, each of them one of bakeOptions(). Lengths in scene units.
struct BakeOptions {
    SphereMethod spheres = SphereMethod::Medial;
    GrowthOptions growth; ///< of SphereMethod::Growth (METHOD 1.1)
    std::optional<double>
        tolerance;      ///< protrusion of the spheres (METHOD 1.6); default: 1/500 of the smaller diagonal
    double epsilon = 0; ///< 0: the table answers as the whole sphere model does (METHOD 3.3)
    double depth = 0;   ///< > 0: the gap too is right down to this depth (METHOD 3.4); 0: yes/no
    int maxSpheres = 0; ///< a body; 0: as many as the tolerance needs
    ReduceMethod reduce = ReduceMethod::Cover;
    SearchMethod search = SearchMethod::Certified;
    int samples = 20000; ///< poses explored by the sampled search
    AtRest atRest = AtRest::Offset;
    Inside inside = Inside::Free;
    bool conservative = true; ///< spheres contain the surface; otherwise they are inscribed
    bool keepSpheres = false; ///< store all generated spheres too
    /// Seconds for each pair's cover; 0: no limit. Not given: `mostLooks` is the limit. Over more than six
    /// DOFs no cover is looked for (METHOD 3.3).
    std::optional<double> budget;
    /// Without a budget: looks at pairs of spheres for a cover, after which the table tests all pairs that
    /// may touch; about a minute of one core. Gap-true tables, which cannot do that, have no limit.
    std::uint64_t mostLooks = 2'000'000'000;
    std::size_t mostPatches = MedialOptions().mostPatches; ///< of surface that a body is cut into
    /// The pair or skin is to be done by then; its search for the few tests ends halfway there.
    Deadline until;
    double effort = 1; ///< share of the usual limit of work for finding the contact zone, in (0, 1]
    std::shared_ptr<WholeFits> kept = std::make_shared<WholeFits>(); ///< of one scene; shared by copies
    /// The most pairs of spheres that a table may test where no cover of them is found. A query looks at few
    /// of them, in clusters, but each takes some 150 bytes in memory.
    std::size_t mostTests = 1'000'000;
    double metersPerUnit = 1; ///< of the scene, for what is said of lengths
};

/// One setting by the name that it has on the command line (without dashes), in scene files
/// (tss:bake:NAME) and in the node kit.
struct BakeOption {
    const char* name;
    std::string about; ///< the line of help; empty: the command line has an option of its own for it
    void (*set)(BakeOptions& options, const std::string& key, const std::string& text, double metersPerUnit);
};

/// All there are, as help lists them.
const std::vector<BakeOption>& bakeOptions();

/// Sets one option by its name from its text. Lengths may carry a unit. Throws InputError naming the option
/// and what was expected.
void setOption(BakeOptions& options, const std::string& key, const std::string& text, double metersPerUnit);

/// Whether setOption() knows this name.
bool isOption(const std::string& key);

/// What a table states as its method: "medial/certified/cover".
std::string methodName(const BakeOptions& options);

/// The options of one pair: the defaults, then the scene's own settings, then those given now.
BakeOptions optionsFor(const BakeSettings& ofScene, const BakeSettings& given, double metersPerUnit);

/// The options of a pair of the scene, which has many: each may test a share of forty million pairs of
/// spheres, so that all tables together fit in memory.
BakeOptions optionsFor(const SceneModel& scene, const Pair& pair);

/// "0.2mm", "1cm", "2e-3m", "0.01in" or a plain number in scene units. Throws InputError.
double parseLength(const std::string& text, double metersPerUnit);

/// A length in scene units as people read it: "0.2 mm", "350 um", "1.2 m".
std::string lengthText(double length, double metersPerUnit);

/// The same as an option of the command line takes it, without a blank: "0.2mm".
std::string lengthOption(double length, double metersPerUnit);

/// Rounded down to one digit: 0.2 of 0.29. value > 0.
double roundedDownToDigit(double value);

/// A finite number and nothing else. Throws InputError that names `what`.
double parseNumber(const std::string& text, const std::string& what);

} // namespace tss
