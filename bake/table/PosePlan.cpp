#include "bake/table/PosePlan.h"

namespace tss {

namespace {

std::vector<PosePlan::Products> inFours(const std::vector<FeatureForm::Feature>& features, std::size_t dofs,
                                        const std::vector<double>& weights) {
    constexpr std::size_t lanes = PosePlan::lanes;
    constexpr std::int32_t place[3] = {2, 0, 1};
    std::vector<PosePlan::Products> fours((features.size() + lanes - 1) / lanes);
    for (std::size_t i = 0; i < fours.size() * lanes; ++i) {
        PosePlan::Products& products = fours[i / lanes];
        const std::size_t lane = i % lanes;
        const bool real = i < features.size();
        products.centre[lane] = real ? features[i].centre : 0;
        products.weight[lane] = real && i < weights.size() ? weights[i] : 0;
        for (std::size_t k = 0; k < FeatureForm::maxDofs; ++k) {
            const std::int32_t at = place[real && k < dofs ? features[i].factor[k] : 0];
            products.factor[k][2 * lane] = 2 * at;
            products.factor[k][2 * lane + 1] = 2 * at + 1;
        }
    }
    return fours;
}

} // namespace

void PosePlan::take(std::span<const DofFactor> factors) {
    dofs = factors.size();
    for (std::size_t k = 0; k < dofs; ++k) {
        middle[k] = factors[k].middle;
        turn[k] = factors[k].turn ? -1 : 0;
        turns = turns || factors[k].turn;
    }
}

PosePlan::PosePlan(const FeatureForm& form) : featureCount(form.features.size()) {
    take(form.factors);
    features = inFours(form.features, dofs, {});
    shared = inFours(form.sharedFeatures, dofs, form.sharedWeights);
}

PosePlan::PosePlan(const PoseRecipe& recipe) {
    std::vector<DofFactor> factors;
    for (const PoseRecipe::Step& step : recipe.steps()) {
        factors.push_back(step.factor);
        steps.push_back({step.constant, step.first, step.second});
    }
    take(factors);
}

} // namespace tss
