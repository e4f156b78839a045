#pragma once
#include "bake/motion/Motion.h"
#include "bake/table/Table.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tss::compare {

/// A pose to ask about: the DOF values and T(q), both made before any clock starts.
struct PoseQuery {
    std::vector<double> q;
    Pose pose;
};

inline std::vector<PoseQuery> poseQueries(const Motion& motion,
                                          const std::vector<std::vector<double>>& values) {
    std::vector<PoseQuery> queries;
    queries.reserve(values.size());
    for (const auto& q : values) queries.push_back({q, pose(motion, q)});
    return queries;
}

/// Work as the paper counts it: a test of two spheres is 3 products for the squared distance of the centres
/// and 1 for the squared sum of the radii. What it takes to place the spheres is not counted.
struct Work {
    std::uint64_t tests = 0;
    std::uint64_t products = 0;
};
inline constexpr std::uint64_t productsPerSphereTest = 4;

/// The work of so many sphere tests.
inline Work sphereTests(std::uint64_t count) {
    return {count, count * productsPerSphereTest};
}

/// What a method promises against the meshes; nothing: it makes no promise.
struct StatedError {
    std::optional<double> miss;  ///< a contact of the meshes deeper than this is reported, scene units
    std::optional<double> early; ///< contact is reported only where the meshes are this near, scene units

    /// The same with what rounding or interpolation adds, scene units.
    StatedError widened(double byMiss, double byEarly) const {
        StatedError wider = *this;
        if (miss) *wider.miss += byMiss;
        if (early) *wider.early += byEarly;
        return wider;
    }
};

/// What every method says about itself.
struct Description {
    std::string name;   ///< short, without spaces: the row's key, e.g. "tree-all-8-balls"
    std::string family; ///< for the plots: "sphere tree", "TSS", ...
    std::string about;  ///< one sentence: what was built, and what was simplified
    StatedError stated;
    std::size_t bytes = 0; ///< what a query reads, without the code
    double buildSeconds = 0;
    bool slow = false; ///< takes milliseconds a query on meshes of some ten thousand triangles: it is judged
                       ///< at fewer poses
};

/// Another way to ask whether two bodies touch at a pose. Immutable once made; threads may share one unless
/// `about` says otherwise. A problem that a method was made from must outlive it.
class CollisionMethod {
public:
    virtual ~CollisionMethod() = default;
    virtual bool hit(const PoseQuery& query) const = 0;

    /// Number of hits: the loop that is timed, free of virtual calls inside.
    virtual std::size_t countHits(std::span<const PoseQuery> queries) const = 0;

    Description description;
    std::function<Work(const PoseQuery&)> work; ///< of hit(); null where it is not countable
};

/// The method that this function is: whether the two touch at a pose. work: see CollisionMethod.
template <class Hit>
std::unique_ptr<CollisionMethod> makeMethod(Description about, Hit hit,
                                            std::function<Work(const PoseQuery&)> work = {}) {
    struct Method final : CollisionMethod {
        explicit Method(Hit&& hit) : hits(std::move(hit)) {}
        bool hit(const PoseQuery& query) const override { return hits(query); }
        std::size_t countHits(std::span<const PoseQuery> queries) const override {
            std::size_t count = 0;
            for (const PoseQuery& query : queries) count += hits(query) ? 1 : 0;
            return count;
        }
        Hit hits;
    };
    auto method = std::make_unique<Method>(std::move(hit));
    method->description = std::move(about);
    method->work = std::move(work);
    return method;
}

/// Work counters for a traversal: either counts, or costs nothing.
struct CountWork {
    Work work;
    void sphereTest() {
        ++work.tests;
        work.products += productsPerSphereTest;
    }
};
struct IgnoreWork {
    void sphereTest() {}
};

/// The method of a function of a pose and a counter, which is told of every sphere test.
template <class Test>
std::unique_ptr<CollisionMethod> makeCountedMethod(Description about, const Test& test) {
    const auto hit = [test](const PoseQuery& query) {
        IgnoreWork none;
        return test(query, none);
    };
    return makeMethod(std::move(about), hit, [test](const PoseQuery& query) {
        CountWork counter;
        test(query, counter);
        return counter.work;
    });
}

/// Two bodies as all methods are given them. B's frame moves in A's by the motion.
struct ComparedPair {
    TriangleMesh meshA, meshB;
    Motion motion;
    SphereSet a, b;       ///< the whole sphere sets (the paper's Ms)
    FitRecord fitA, fitB; ///< of a and b, as far as it is known
    Table table;          ///< the reduced pairs, and which spheres of a and b they use
};

/// What a yes/no answer over the whole sphere sets promises against the meshes. miss: where the meshes touch,
/// the gap of the spheres is at most the sum of both coverages, which is 0 for spheres that contain the
/// surfaces. early: where spheres touch, the meshes are no farther apart than the sum of both protrusions.
inline StatedError statedBySpheres(const ComparedPair& pair) {
    const FitRecord &a = pair.fitA, &b = pair.fitB;
    StatedError stated;
    if (a.coverage && b.coverage) stated.miss = std::max(0.0, *a.coverage + *b.coverage);
    if (a.protrusion && b.protrusion) stated.early = *a.protrusion + *b.protrusion;
    return stated;
}

} // namespace tss::compare
