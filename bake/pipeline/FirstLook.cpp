#include "bake/pipeline/FirstLook.h"

#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/WholeTurn.h"
#include "bake/search/RestContact.h"
#include "bake/search/SurfacesApart.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>
#include <utility>

namespace tss {

namespace {

/// Rounded to one digit.
double oneDigit(double value) {
    const double digit = std::pow(10, std::floor(std::log10(value)));
    return std::round(value / digit) * digit;
}

/// Rounded down to one digit; a value that is short of a digit by rounding counts as that.
double oneDigitBelow(double value) {
    const double digit = std::pow(10, std::floor(std::log10(value)));
    return std::floor(value / digit * (1 + 1e-6)) * digit;
}

/// Seconds of processor time of all threads of this program: other programs take none of them.
double processSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Whether the surfaces of the pair are shown never to meet before this program has run for so many seconds:
/// what is proposed must not hang on what else runs.
bool staysApart(const SceneModel& scene, const Pair& pair, double until) {
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    const Motion motion = onceRound(pairMotion(scene, pair));
    const auto inTime = [&](std::string_view, double) { return processSeconds() < until; };
    return inTime("", 0) &&
           surfacesApart(cleaned(a), cleaned(b), motion, touchingDistance(a, b, motion), inTime).has_value();
}

} // namespace

bool isLongChain(const SceneModel& scene, const Pair& pair) {
    return pairDofs(scene, pair).size() > 3;
}

std::vector<double> distancesAtRest(const SceneModel& scene) {
    std::vector<std::optional<MeshQuery>> surfaces(scene.bodies.size());
    const auto surfaceOf = [&](int body) -> const MeshQuery& {
        if (!surfaces[body]) surfaces[body].emplace(scene.bodies[body].mesh);
        return *surfaces[body];
    };
    std::vector<double> distances;
    for (const Pair& pair : scene.pairs) {
        const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
        double distance = std::numeric_limits<double>::infinity();
        if (!a.empty() && !b.empty()) {
            const Motion motion = pairMotion(scene, pair);
            distance =
                surfaceOf(pair.bodyA).distanceTo(surfaceOf(pair.bodyB), pose(motion, restValues(motion)));
            if (distance <= touchingDistance(a, b, motion)) distance = 0;
        }
        distances.push_back(distance);
    }
    return distances;
}

double usualTolerance(const SceneModel& scene) {
    const double millimetres = 1000 * scene.metersPerUnit;
    std::vector<double> sizes;
    for (const Body& body : scene.bodies)
        if (!body.mesh.empty()) sizes.push_back(millimetres * diagonal(body.mesh));
    if (sizes.empty()) return 0;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return oneDigit(*middle / 30) / millimetres;
}

double firstTolerance(const SceneModel& scene, const std::vector<double>& distancesAtRest) {
    const double millimetres = 1000 * scene.metersPerUnit, usual = millimetres * usualTolerance(scene);
    const double least = usual / 100; // fitted parts, where a bake makes spheres finer by itself
    std::vector<std::pair<double, const Pair*>> rooms; // millimetres
    for (std::size_t k = 0; k < scene.pairs.size(); ++k)
        if (const double room = 0.3 * millimetres * distancesAtRest[k]; room > least && room < usual)
            rooms.emplace_back(room, &scene.pairs[k]);
    std::ranges::sort(rooms, {}, &std::pair<double, const Pair*>::first);
    constexpr double seconds = 10; // five on two cores
    const double until = processSeconds() + seconds;
    for (const auto& [room, pair] : rooms)
        if (!staysApart(scene, *pair, until)) return oneDigitBelow(room) / millimetres;
    return usual / millimetres;
}

double firstBudget(const SceneModel& scene) {
    const auto pairs = static_cast<double>(scene.pairs.size());
    return pairs > 0 ? std::min(5.0, oneDigit(200 / pairs)) : 5;
}

} // namespace tss
