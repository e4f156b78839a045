#include "bake/pipeline/SearchPair.h"

#include "bake/search/CertifiedSearch.h"

#include <cmath>

namespace tss {

PairTask pairTask(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options) {
    const double lacking = spheres.a.coverage + spheres.b.coverage;
    const bool fitted = options.spheres == SphereMethod::Medial && options.search == SearchMethod::Certified;
    return {spheres, motion, options, ruleAtRest(spheres, motion, options),
            fitted && std::isfinite(lacking) ? lacking : 0};
}

SampledSearchOptions sampledSearch(const PairTask& task) {
    SampledSearchOptions search;
    search.samples = static_cast<std::size_t>(task.options.samples);
    search.rule = task.ruled.rule;
    return search;
}

CandidatePairs searchPair(const PairTask& task, const Progress& progress) {
    const SphereSet &a = task.spheres.a.spheres, &b = task.spheres.b.spheres;
    if (task.options.search == SearchMethod::Sampled)
        return searchSampled(a, b, task.motion, sampledSearch(task), progress);
    CertifiedSearchOptions certified;
    certified.rule = task.ruled.rule;
    certified.margin = task.margin;
    // The cover can do without the list, which wide limits make very long; the other reductions need it.
    if (task.options.reduce == ReduceMethod::Cover)
        certified.effort = task.spheres.testAll ? 5'000'000 : 50'000'000;
    return searchCertified(a, b, task.motion, certified, progress);
}

bool allListed(const CandidatePairs& candidates, const BakeOptions& options) {
    return candidates.certified || options.search == SearchMethod::Sampled;
}

} // namespace tss
