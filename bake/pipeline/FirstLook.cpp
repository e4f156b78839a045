#include "bake/pipeline/FirstLook.h"

#include "bake/base/Order.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/Kinematics.h"
#include "bake/pipeline/FillPair.h"
#include "bake/search/RestContact.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <set>

namespace tss {

namespace {

/// Rounded to one digit.
double oneDigit(double value) {
    const double digit = std::pow(10, std::floor(std::log10(value)));
    return std::round(value / digit) * digit;
}

double smallerDiagonal(const SceneModel& scene, const Pair& pair) {
    return std::min(diagonal(scene.bodies[pair.bodyA].mesh), diagonal(scene.bodies[pair.bodyB].mesh));
}

constexpr double usualShare = 1.0 / 30, roomShare = 0.3; ///< of the smaller diagonal, of the distance at rest
constexpr double nearShare = usualShare / roomShare; ///< of that diagonal: from there on room does not count

/// The tolerance of a first look at a pair whose meshes are so far apart at rest, scene units.
double firstTolerance(const SceneModel& scene, const Pair& pair, double distance) {
    const double smaller = smallerDiagonal(scene, pair);
    if (areBones(scene, pair.bodyA, pair.bodyB)) return usualShare * smaller; // the skin bends otherwise
    if (!(distance > 0)) return smaller / 100;
    if (isLongChain(scene, pair)) return usualShare * smaller;
    return std::max(std::min(usualShare * smaller, roomShare * distance), smaller / 500);
}

/// The mesh of each body as it is asked for, made once.
class Surfaces {
public:
    explicit Surfaces(const SceneModel& scene) : scene_(scene), surfaces_(scene.bodies.size()) {}

    const MeshQuery& of(int body) {
        if (!surfaces_[body]) surfaces_[body].emplace(scene_.bodies[body].mesh);
        return *surfaces_[body];
    }

private:
    const SceneModel& scene_;
    std::vector<std::optional<MeshQuery>> surfaces_;
};

/// Of all drives' samples, no more than 400 of them.
std::vector<double> timesToLookAt(const SceneModel& scene) {
    constexpr std::size_t most = 400;
    std::set<double> all;
    for (const Joint& joint : scene.joints)
        for (const TimeSamples& drive : joint.drives) all.insert(drive.times.begin(), drive.times.end());
    std::vector<double> times(all.begin(), all.end());
    if (times.size() <= most) return times;
    std::vector<double> some;
    for (std::size_t k = 0; k < most; ++k) some.push_back(times[k * (times.size() - 1) / (most - 1)]);
    return some;
}

} // namespace

bool isLongChain(const SceneModel& scene, const Pair& pair) {
    return pairDofs(scene, pair).size() > 3;
}

std::vector<double> distancesAtRest(const SceneModel& scene) {
    Surfaces surfaces(scene);
    std::vector<double> distances;
    for (const Pair& pair : scene.pairs) {
        const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
        double distance = std::numeric_limits<double>::infinity();
        if (!a.empty() && !b.empty()) {
            const Motion motion = pairMotion(scene, pair);
            const Pose bToA = pose(motion, restValues(motion));
            const MeshQuery &surfaceA = surfaces.of(pair.bodyA), &surfaceB = surfaces.of(pair.bodyB);
            const double far = nearShare * smallerDiagonal(scene, pair);
            distance = surfaceA.distanceTo(surfaceB, bToA, far);
            if (distance <= touchingDistance(a, b, motion)) distance = 0;
            if (!(distance < far))
                distance = std::max(far, (bToA * surfaceB.centre() - surfaceA.centre()).norm() -
                                             surfaceA.radius() - surfaceB.radius());
        }
        distances.push_back(distance);
    }
    return distances;
}

std::vector<MotionContact> contactsInMotion(const SceneModel& scene,
                                            std::span<const std::pair<int, int>> bodies) {
    Surfaces surfaces(scene);
    std::vector<MotionContact> contacts(bodies.size());
    const std::vector<double> times = timesToLookAt(scene);
    for (const double time : times) {
        const std::vector<Pose> placed = posedBodies(scene, drivenValues(scene, time));
        for (std::size_t p = 0; p < bodies.size(); ++p) {
            const auto [a, b] = bodies[p];
            const TriangleMesh &meshA = scene.bodies[a].mesh, &meshB = scene.bodies[b].mesh;
            if (meshA.empty() || meshB.empty()) continue;
            const double smaller = std::min(diagonal(meshA), diagonal(meshB)), crossing = 1e-6 * smaller,
                         within = contacts[p].near ? crossing : nearShare * smaller;
            const MeshQuery &surfaceA = surfaces.of(a), &surfaceB = surfaces.of(b);
            const Pose bToA = placed[a].inverse(Eigen::Isometry) * placed[b];
            if ((bToA * surfaceB.centre() - surfaceA.centre()).norm() >
                surfaceA.radius() + surfaceB.radius() + within)
                continue;
            const double distance = surfaceA.distanceTo(surfaceB, bToA, within);
            contacts[p].near = contacts[p].near || distance < within;
            if (distance < crossing) contacts[p].crossing += 1.0 / static_cast<double>(times.size());
        }
    }
    return contacts;
}

bool areBones(const SceneModel& scene, int bodyA, int bodyB) {
    return !scene.bodies[bodyA].visible && !scene.bodies[bodyB].visible;
}

PairsLeftOut pairForAnimation(SceneModel& scene, bool near) {
    std::vector<std::pair<int, int>> bones;
    for (const Pair& pair : scene.pairs)
        if (areBones(scene, pair.bodyA, pair.bodyB)) bones.emplace_back(pair.bodyA, pair.bodyB);
    const std::vector<MotionContact> contacts = contactsInMotion(scene, bones);
    PairsLeftOut leftOut;
    std::size_t next = 0;
    std::erase_if(scene.pairs, [&](Pair& pair) {
        if (!areBones(scene, pair.bodyA, pair.bodyB)) return false;
        const MotionContact& contact = contacts[next++];
        const bool far = near && !contact.near;
        if (contact.holds())
            leftOut.held.push_back(primName(scene.bodies[pair.bodyA].path) + " and " +
                                   primName(scene.bodies[pair.bodyB].path));
        else if (far)
            ++leftOut.far;
        else
            pair.settings["inside"] = "contact";
        return contact.holds() || far;
    });
    return leftOut;
}

double usualTolerance(const SceneModel& scene) {
    const double millimetres = 1000 * scene.metersPerUnit;
    std::vector<double> sizes;
    for (const Body& body : scene.bodies)
        if (!body.mesh.empty()) sizes.push_back(millimetres * diagonal(body.mesh));
    if (sizes.empty()) return 0;
    return oneDigit(median(sizes) / 30) / millimetres;
}

void setFirstTolerances(SceneModel& scene, const std::vector<double>& distancesAtRest) {
    if (std::ranges::none_of(scene.pairs, [&](const Pair& pair) { return isLongChain(scene, pair); })) return;
    const double millimetres = 1000 * scene.metersPerUnit;
    for (std::size_t k = 0; k < scene.pairs.size(); ++k) {
        Pair& pair = scene.pairs[k];
        const double first = firstTolerance(scene, pair, distancesAtRest[k]),
                     tolerance = millimetres * (isLongChain(scene, pair) ? toleranceNextTo(first) : first);
        if (tolerance > 0 && std::isfinite(tolerance))
            pair.settings["tolerance"] = fmt::format("{:.2g}mm", tolerance);
    }
}

double firstBudget(const SceneModel& scene) {
    const auto pairs = static_cast<double>(scene.pairs.size());
    return pairs > 0 ? std::min(5.0, oneDigit(200 / pairs)) : 5;
}

} // namespace tss
