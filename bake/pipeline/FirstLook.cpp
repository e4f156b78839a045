#include "bake/pipeline/FirstLook.h"

#include "bake/model/Kinematics.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

double oneDigit(double value) {
    const double digit = std::pow(10, std::floor(std::log10(value)));
    return std::round(value / digit) * digit;
}

} // namespace

bool isLongChain(const SceneModel& scene, const Pair& pair) {
    return pairDofs(scene, pair).size() > 3;
}

double firstTolerance(const SceneModel& scene) {
    std::vector<double> sizes; // millimetres
    for (const Body& body : scene.bodies)
        if (!body.mesh.empty()) sizes.push_back(1000 * scene.metersPerUnit * diagonal(body.mesh));
    if (sizes.empty()) return 0;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return oneDigit(*middle / 30) / (1000 * scene.metersPerUnit);
}

double firstBudget(const SceneModel& scene) {
    const auto pairs = static_cast<double>(scene.pairs.size());
    return pairs > 0 ? std::min(5.0, oneDigit(200 / pairs)) : 5;
}

} // namespace tss
