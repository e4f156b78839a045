#pragma once
#include "bake/base/Progress.h"
#include "bake/report/Accuracy.h"
#include "bake/report/MethodSet.h"
#include "bake/report/Timing.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace tss::reporting {

struct ReportOptions {
    bool quick = false;                      ///< under a minute for a pair of some ten thousand triangles
    std::vector<std::string> methods;        ///< parts of names wanted; empty: all
    std::vector<std::vector<double>> motion; ///< steps to count tests along, one value per DOF (radians,
                                             ///< scene units); empty: the scene's own drives, or a sweep
    std::string motionFile;                  ///< that they were read from, for what the report says of itself
    std::vector<std::string> pairs;          ///< prim paths; empty: all
    std::uint64_t seed = 20;
    bool besidePaper = false; ///< also the paper's own counts, and what this project set out to reach
};

/// One method with one setting.
struct Row {
    std::string method;  ///< its name
    std::string setting; ///< name of the BakePoint whose spheres it stands on; empty where it has none
    compare::Description about;
    ErrorFigures uniform, near;
    FirstContact firstContact;
    Times times;
    std::optional<double> tests, products; ///< a query, mean over the uniform poses; none: not countable

    double deepestMiss() const { return std::max(uniform.deepestMiss, near.deepestMiss); }
    double farthestEarly() const { return std::max(uniform.farthestEarly, near.farthestEarly); }
    /// Scene units: the deepest miss or the farthest early contact, whichever is more.
    double worst() const { return std::max(deepestMiss(), farthestEarly()); }
    /// Share of the uniform poses with a wrong verdict.
    double wrong() const {
        return static_cast<double>(uniform.missed + uniform.early) /
               static_cast<double>(std::max<std::size_t>(1, uniform.poses));
    }
    std::size_t misses() const { return uniform.missed + near.missed; }
    /// Whether it was judged at some of the poses only: its worst error does not compare with those of
    /// others.
    bool slow() const { return about.slow; }
};

/// The Pareto front: the rows that no other one beats in both numbers, by rising x. Rows with x <= 0 and slow
/// ones are left out.
std::vector<const Row*> paretoFront(const std::vector<Row>& rows, const std::function<double(const Row&)>& x,
                                    const std::function<double(const Row&)>& y);

/// Tests a step along a motion, one series a method (the paper's Figure 2j).
struct StepSeries {
    std::string name;
    std::vector<double> tests;
};
struct StepStudy {
    std::string motion;           ///< in words
    std::vector<double> leading;  ///< value of the leading DOF at each step, its own unit
    std::vector<char> touching;   ///< by the meshes
    std::vector<char> inRegion;   ///< the step lies in the angular region of collision of the spheres
    std::size_t inMeshRegion = 0; ///< steps in that of the meshes
    std::vector<StepSeries> series;
};

/// Share of colliding samples by slice of the leading DOF (the paper's Figure 2i). The angular region of
/// collision goes from the first slice in which one collides to the last.
struct RegionCurve {
    std::vector<double> middle, share;
    double lower = 0, upper = 0; ///< equal: there is none

    /// The share of the samples in the region that collide.
    double meanShare() const;
    bool contains(double value) const { return upper > lower && value >= lower && value <= upper; }
};
struct RegionStudy {
    RegionCurve spheres, meshes;
};

/// What a sampled search loses.
struct SamplingPoint {
    std::size_t samples = 0;
    std::string reduce; ///< "cooccurrence", "minimal"
    std::size_t tests = 0;
    double missedUniform = 0, missedNear = 0; ///< of the poses where the whole sphere model collides, 0..1
    double seconds = 0;
};
/// A model: what it was made by and what came of it.
struct BakePoint {
    std::string name, about;
    double tolerance = 0, epsilon = 0; ///< scene units
    double protrusion = 0;             ///< scene units: no sphere sticks out of its body by more
    std::size_t spheresA = 0, spheresB = 0, usedA = 0, usedB = 0, tests = 0, restTests = 0, bytes = 0;
    bool certified = false;           ///< for every pose, not for those explored alone
    std::optional<double> lowerBound; ///< of tests for the same answers
    double sphereSeconds = 0, tableSeconds = 0;
};

/// Everything about one pair.
struct PairStudy {
    std::string path, nameA, nameB;
    std::size_t trianglesA = 0, trianglesB = 0;
    std::vector<std::string> dofs;       ///< name and limits in words
    std::size_t leading = 0;             ///< index of the leading DOF; 0 where nothing is compared
    std::string leadingDof, leadingUnit; ///< its name and unit, see unitOf()
    double millimetres = 1;              ///< in a scene unit
    std::optional<std::string> never;    ///< that the two never meet, in words: nothing is compared then
    std::vector<std::string> notes;      ///< sentences of what a reader has to know first
    std::size_t uniformPoses = 0, nearPoses = 0, touchingUniform = 0, timedPoses = 0;
    std::optional<double> earlyBound; ///< scene units; of the base's table
    std::size_t freeWithinBound = 0;  ///< free uniform poses with the meshes nearer than that
    Times fclDirectly;                ///< FCL's OBBRSS trees asked without the interface of the methods
    std::size_t leftOut = 0;          ///< poses with a part wholly inside the other body
    std::vector<Row> rows;
    std::vector<NotRun> notRun;
    StepStudy steps;
    RegionStudy region;
    std::vector<SamplingPoint> sampling;
    BakePoint base;                    ///< as `tss bake` makes it; every method was built for its spheres
    std::vector<BakePoint> tolerances; ///< the base among them, coarse to fine
    std::vector<BakePoint> epsilons;   ///< over the base's spheres, the base first
    std::vector<BakePoint> recipes;    ///< other ways to make spheres and table, the paper's own first
    double seconds = 0;
};

/// The unit of a DOF's values as reports have them, of toUser(): "degrees", "times 1 mm", "of its path".
std::string unitOf(const Dof& dof, double metersPerUnit);

PairStudy studyPair(const SceneModel& scene, const Pair& pair, const ReportOptions& options,
                    const Progress& progress);

// Parts of studyPair(), each filling its own figures of the study.

/// Tests a step along a motion, and the angular region of collision.
void studySteps(PairStudy& study, const SceneModel& scene, const Pair& pair, const Model& model,
                const compare::MeshTruth& truth, const ReportOptions& options, int steps);

/// What tables from a sampled search miss of what the same spheres collide at.
void studySampling(PairStudy& study, const Model& model, const ReportOptions& options);

/// That the two never meet, in words, with the distance that `tss bake` proves and stores. model: one without
/// a test, made from the pair.
std::string neverText(const SceneModel& scene, const Pair& pair, const Model& model);

/// What a reader of the figures has to know of this pair, a sentence each: where the poses tell little, and
/// what has no row.
std::vector<std::string> notesOf(const PairStudy& study);

/// A model of the pair under study, with the methods that were made for it.
struct StudiedModel {
    std::shared_ptr<const Model> model;
    MethodScope scope;
    MethodSet methods{};
};

/// The base model, what `tss bake` makes of these meshes, but for contact at rest, which counts here as it
/// does to the meshes; and all that the report's rows stand on, the base among them: finer and coarser
/// spheres, other epsilons over the same spheres, what the paper does, as far as their tables have tests.
/// None where the base's has none. Their figures go into the study. a, b: the two meshes, cleaned.
std::pair<std::shared_ptr<const Model>, std::vector<StudiedModel>>
studiedModels(PairStudy& study, const SceneModel& scene, const Pair& pair, const TriangleMesh& a,
              const TriangleMesh& b, bool quick, const Progress& progress);

} // namespace tss::reporting
