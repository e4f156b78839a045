#pragma once
#include "bake/reduce/CertifiedCover.h"
#include "bake/search/NodePairs.h"
#include "bake/verify/Verify.h"
#include "tests/search/Scenes.h"

#include <utility>

/// Tables of the scenes made by code, for the tests of the verifier. Pairs that overlap at rest are no
/// exception unless said otherwise.
inline tss::VerifyOptions colliding() {
    return {};
}

/// What overlaps at rest touches where it goes deeper.
inline tss::VerifyOptions offset(const scenes::Scene& scene) {
    const tss::ContactRule rule = ruleOfSpheres(scene.a, scene.b, scene.motion, tss::AtRest::Offset);
    tss::VerifyOptions o;
    o.regionA = rule.regionA();
    o.regionB = rule.regionB();
    o.depth = -rule.threshold();
    return o;
}

inline tss::Table tableOf(const scenes::Scene& scene, const tss::CoverResult& cover,
                          const tss::CoverOptions& options) {
    tss::Table table = tss::makeTable(scene.a, scene.b, cover.pairs, cover.restGaps, scene.motion);
    table.epsilon = cover.epsilon;
    table.gapDepth = options.gapDepth;
    table.gapMargin = options.gapMargin;
    table.certified = true;
    return table;
}

inline tss::Table baked(const scenes::Scene& scene, double epsilon = 0, double depth = 0, double margin = 0,
                        tss::AtRest atRest = tss::AtRest::Collide) {
    tss::CoverOptions options;
    options.epsilon = epsilon;
    options.gapDepth = depth;
    options.gapMargin = margin;
    options.rule = ruleOfSpheres(scene.a, scene.b, scene.motion, atRest);
    return tableOf(scene, tss::certifiedCover(scene.a, scene.b, nullptr, scene.motion, options), options);
}

/// The two ends of what is left of the segment from a free pose to one in contact after halving it many
/// times: the last pose where the models do not touch and the first where they do.
inline std::pair<std::vector<double>, std::vector<double>>
bisected(const tss::SphereTree& a, const tss::SphereTree& b, const tss::Motion& motion,
         std::vector<double> free, std::vector<double> hit, int halvings = 30) {
    for (int step = 0; step < halvings; ++step) {
        std::vector<double> middle(free.size());
        for (std::size_t i = 0; i < free.size(); ++i) middle[i] = 0.5 * (free[i] + hit[i]);
        (tss::smallestGap(a, b, tss::pose(motion, middle), 1e-300) <= 0 ? hit : free) = middle;
    }
    return {free, hit};
}

inline std::pair<std::vector<double>, std::vector<double>>
bisected(const scenes::Scene& scene, const std::vector<double>& free, const std::vector<double>& hit) {
    return bisected(tss::SphereTree(scene.a), tss::SphereTree(scene.b), scene.motion, free, hit);
}

/// The table with one of its tests left out.
inline tss::Table without(const tss::Table& table, std::size_t test) {
    auto pairs = tests(table);
    auto rest = table.restGaps;
    pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(test));
    if (!rest.empty()) rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(test));
    tss::Table less = makeTable(table.a, table.b, pairs, rest, table.motion);
    less.epsilon = table.epsilon;
    less.gapDepth = table.gapDepth;
    less.gapMargin = table.gapMargin;
    return less;
}
