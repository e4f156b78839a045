#include "bake/pipeline/CheckBake.h"

#include "bake/geometry/MeshAudit.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MotionBound.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/pipeline/FillPair.h"
#include "bake/play/FreeMuscles.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinRig.h"
#include "bake/table/RoundingBand.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss {

namespace {

/// Throws for lengths whose squares the kernels could not tell from 0 or from infinity.
void checkLength(const std::string& path, const char* what, double least, double most) {
    if (least >= shortestLength && most <= longestLength) return;
    throw InputError(Where{"", "", path},
                     fmt::format("expected {} between {:g} and {:g} scene units, found {:g}; other units "
                                 "(metersPerUnit) have other numbers",
                                 what, shortestLength, longestLength,
                                 least >= shortestLength ? most : least));
}

/// Throws for a mesh that no spheres can be made for.
void checkBody(const Body& body) {
    if (body.mesh.empty()) throw InputError(Where{"", "", body.path}, "expected a mesh, the body has none");
    try {
        cleaned(body.mesh);
    } catch (const InputError& error) {
        throw InputError(Where{"", "", body.path}, error.message);
    }
    double farthest = 0;
    for (const Vec3& v : body.mesh.vertices) farthest = std::max(farthest, v.norm());
    checkLength(body.path, "the size and the coordinates of a mesh", diagonal(body.mesh), farthest);
}

/// A table reports contact from epsilon on: at rest there would be some.
void checkEpsilon(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                  const BakeOptions& options, double metersPerUnit) {
    if (!(options.epsilon > 0) || options.atRest == AtRest::Collide ||
        options.spheres != SphereMethod::Medial)
        return;
    const double apart = clearanceAtRest(a, b, motion);
    if (apart > 0 && apart <= options.epsilon)
        throw InputError(fmt::format("the meshes are {} apart at rest, and a table with --epsilon {} would "
                                     "report contact there: expected a smaller epsilon",
                                     lengthText(apart, metersPerUnit),
                                     lengthText(options.epsilon, metersPerUnit)));
}

void checkPair(const SceneModel& scene, const Pair& pair, const BakeOptions& options) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    wholeBox(motion); // which tells too many DOFs
    checkBody(a);
    checkBody(b);
    checkLength(pair.path, "the axes and ways of a motion", shortestLength, motionSize(motion));
    const double smaller = std::min(diagonal(a.mesh), diagonal(b.mesh));
    checkOptions(sphereOptions(options, options.tolerance.value_or(smaller / 500)));
    checkEpsilon(a.mesh, b.mesh, motion, options, scene.metersPerUnit);
}

void checkSkin(const SceneModel& scene, const SkinModel& skin, const BakeOptions& options) {
    checkBody(scene.bodies[skin.body]);
    for (const UnderSkin& under : underSkin(scene, skin))
        if (under.body >= 0) checkBody(scene.bodies[under.body]);
    const auto muscles = skinMuscles(scene, skin);
    for (const auto& muscle : muscles)
        if (const TriangleMesh& surface = muscle->muscle().surface; !surface.empty())
            checkOptions(sphereOptions(options, options.tolerance.value_or(diagonal(surface) / 100)));
    checkSkin(scene.bodies[skin.body].mesh, muscles.size(), skinParameters(scene, skin));
    const double size = diagonal(scene.bodies[skin.body].mesh);
    for (const double length : {skin.thickness, skin.travel})
        if (!(length >= 0 && length <= 100 * size))
            throw InputError(fmt::format(
                "thickness and travel of a skin must be lengths of at least 0 and at "
                "most a hundred times its size, {}; found {}",
                lengthText(100 * size, scene.metersPerUnit), lengthText(length, scene.metersPerUnit)));
}

template <class Item, class Check>
void collect(std::vector<InputError>& refused, const Item& item, const Check& check) {
    try {
        check();
    } catch (const InputError& error) {
        const std::string& path = error.where.path.empty() ? item.path : error.where.path;
        refused.emplace_back(Where{error.where.file, error.where.pointer, path}, error.message);
    }
}

} // namespace

std::vector<InputError> refusedByBake(const SceneModel& scene, const BakeRequest& request) {
    std::vector<InputError> refused;
    const auto options = [&](const BakeSettings& ofScene) {
        return optionsFor(ofScene, request.given, scene.metersPerUnit);
    };
    const std::vector<std::string> paths = pathsToBake(scene, request);
    const auto toBake = [&](const auto& item) { return std::ranges::find(paths, item.path) != paths.end(); };
    for (const Pair& pair : scene.pairs)
        if (toBake(pair)) collect(refused, pair, [&] { checkPair(scene, pair, options(pair.settings)); });
    for (const SkinModel& skin : scene.skins)
        if (toBake(skin)) collect(refused, skin, [&] { checkSkin(scene, skin, options(skin.settings)); });
    return refused;
}

std::vector<InputError> unplayableMuscles(const SceneModel& scene) {
    std::vector<InputError> refused;
    for (std::size_t m = 0; m < scene.muscles.size(); ++m)
        if (!underSomeSkin(scene, m))
            collect(refused, scene.muscles[m],
                    [&] { const MuscleDeformer muscle(muscleOf(scene, scene.muscles[m])); });
    return refused;
}

} // namespace tss
