#include "bake/BakePair.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/Solid.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SourceHash.h"
#include "bake/tool/Command.h"
#include "bake/tool/DofSpec.h"
#include "bake/verify/Verify.h"

#include <fmt/format.h>

namespace tss::tool {

namespace {

RestOverlaps restOverlaps(AtRest mode) {
    switch (mode) {
    case AtRest::Ignore:
        return RestOverlaps::Ignore;
    case AtRest::Collide:
        return RestOverlaps::Collide;
    case AtRest::Offset:
        break;
    }
    return RestOverlaps::Offset;
}

/// The spheres that the table answers for: those stored with --keep-spheres, or made again from the meshes.
std::pair<SphereSet, SphereSet> wholeSpheres(const SceneModel& scene, const Pair& pair, const Motion& motion,
                                             const BakeOptions& options, const Progress& progress) {
    const BakeRecord& record = pair.table ? pair.table->record : pair.proof->record;
    if (pair.table && pair.table->a.size() == record.spheresA && pair.table->b.size() == record.spheresB)
        return {pair.table->a, pair.table->b};
    PairSpheres spheres = fillPair(scene, pair, motion, options, progress);
    if (spheres.a.spheres.size() != record.spheresA || spheres.b.spheres.size() != record.spheresB)
        throw InputError(
            Where{"", "", pair.path},
            fmt::format("was made from {} + {} spheres, but its meshes and settings give {} + {}",
                        record.spheresA, record.spheresB, spheres.a.spheres.size(),
                        spheres.b.spheres.size()));
    return {std::move(spheres.a.spheres), std::move(spheres.b.spheres)};
}

/// The farthest that a sphere sticks out of its body.
double protrusion(const TriangleMesh& mesh, const SphereSet& spheres) {
    const Solid solid(cleaned(mesh));
    double worst = 0;
    for (const Sphere& sphere : spheres)
        worst = std::max(worst, solid.protrusion(sphere.centre, sphere.radius));
    return worst;
}

/// What does not hold of a pair; empty when all holds. The figures go into `json`.
std::string verifyPair(const SceneModel& scene, const Pair& pair, Json& json, const Progress& progress) {
    if (const std::string stale = staleness(scene, pair); !stale.empty()) return stale;
    const BakeOptions options = optionsFor(pair.settings, {}, scene.metersPerUnit);
    const Motion motion = pairMotion(scene, pair);
    const auto [a, b] = wholeSpheres(scene, pair, motion, options, progress);
    VerifyOptions how;
    how.atRest = restOverlaps(options.atRest);
    const VerifyResult result =
        pair.proof ? verifyNeverCollides(a, b, pair.proof->clearance * (1 - 1e-9), motion, how, progress)
                   : verifyTable(a, b, *pair.table, motion, how, progress);
    json["spheresA"] = a.size();
    json["spheresB"] = b.size();
    json["cells"] = result.cells;
    json["band"] = result.band;
    if (!result.proven) {
        std::string pose;
        for (std::size_t k = 0; k < result.pose.size(); ++k)
            pose +=
                fmt::format("{}{:.9g}", k ? ", " : " at DOF values ", toUser(motion.dofs[k], result.pose[k]));
        json["pose"] = result.pose;
        return result.reason + pose;
    }
    if (!pair.table || pair.table->boundEarly < 0) return "";
    const double early = protrusion(scene.bodies[pair.bodyA].mesh, pair.table->a) +
                         protrusion(scene.bodies[pair.bodyB].mesh, pair.table->b) + pair.table->epsilon;
    json["early"] = early;
    if (early <= pair.table->boundEarly * (1 + 1e-6)) return "";
    return fmt::format("its spheres stick out by {:.6g} together, more than the stored bound of {:.6g}",
                       early, pair.table->boundEarly);
}

void verify(const std::string& file, Console& console) {
    const SceneModel scene = loadScene(file);
    Json result = {{"file", file}, {"pairs", Json::array()}};
    int bad = 0;
    for (const Pair& pair : scene.pairs) {
        if (!pair.table && !pair.proof) continue;
        Json json = {{"path", pair.path}};
        std::string why;
        if (pair.proof || pair.table->certified)
            why = verifyPair(scene, pair, json, console.progress());
        else
            why = "is not certified: it was made from samples, and states no bound";
        json["holds"] = why.empty();
        json["reason"] = why;
        bad += !why.empty();
        if (why.empty())
            console.say(fmt::format("{}: holds at every pose ({} cells, rounding band {:.2g})", pair.path,
                                    json["cells"].dump(), json["band"].get<double>()));
        else
            fmt::print(stderr, "{} (<{}>): {}\n", file, pair.path, why);
        result["pairs"].push_back(json);
    }
    if (result["pairs"].empty())
        throw InputError(Where{file, "", ""}, "nothing to verify; expected a baked scene");
    result["holds"] = bad == 0;
    console.print(result);
    console.exitCode = bad == 0 ? 0 : 1;
}

} // namespace

void addVerify(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "verify", "proves the stored bounds again, with code of its own");
    auto file = std::make_shared<std::string>();
    command->add_option("scene", *file, "a baked scene")->required();
    command->footer(
        "Proven again: that the table answers as all spheres do, at every pose, and how far the table's\n"
        "spheres stick out of the meshes. That the spheres cover the contact zone (miss 0) follows from\n"
        "making them again from the meshes; it is not proven by other code.");
    command->callback([file, &console] { verify(*file, console); });
}

} // namespace tss::tool
