#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "bake/tool/ChoosePair.h"
#include "bake/tool/Command.h"
#include "bake/tool/Csv.h"
#include "bake/tool/DofSpec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tss::tool {

namespace {

/// Rows outside the limits that are listed; all are counted.
constexpr std::size_t mostRowsNamed = 1000;

struct QueryArguments {
    std::string scene, pair, poses, output;
    bool distance = false; ///< of the meshes themselves, too
};

/// The values lie outside the limits or planes that the table was made for, by more than files round.
bool beyond(const Motion& motion, const std::vector<double>& q) {
    constexpr double share = 1e-6; // of a range
    for (std::size_t k = 0; k < q.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        const double hair = share * (dof.upper - dof.lower) + 1e-12 * std::abs(q[k]);
        if (!(q[k] >= dof.lower - hair && q[k] <= dof.upper + hair)) return true;
    }
    return std::any_of(motion.planes.begin(), motion.planes.end(), [&](const LimitPlane& plane) {
        double excess = -plane.bound, hair = 1e-12 * std::abs(plane.bound);
        for (std::size_t k = 0; k < q.size(); ++k) {
            const Dof& dof = motion.dofs[k];
            excess += plane.coefficients[k] * q[k];
            hair +=
                std::abs(plane.coefficients[k]) * (share * (dof.upper - dof.lower) + 1e-12 * std::abs(q[k]));
        }
        return !(excess <= hair);
    });
}

/// The two bodies as they are, to ask for their distance.
struct Meshes {
    Meshes(const SceneModel& scene, const Pair& pair)
        : a(scene.bodies[pair.bodyA].mesh), b(scene.bodies[pair.bodyB].mesh) {}
    MeshQuery a, b;
};

void runQuery(const QueryArguments& arguments, const Console& console) {
    refuseOverwriting(arguments.output, {arguments.scene, arguments.poses});
    const SceneModel scene = loadScene(arguments.scene);
    const Pair& pair = chooseFreshPair(scene, arguments.pair, arguments.scene);
    if (!pair.table && !pair.proof)
        throw InputError(Where{arguments.scene, "", pair.path},
                         "has no table; expected a scene written by tss bake");
    const Motion motion = pairMotion(scene, pair);
    const Csv poses = readCsv(arguments.poses, motion.dofCount());
    std::vector<std::string> names;
    for (const Dof& dof : motion.dofs) names.push_back(dof.name);
    checkColumns(poses, names, arguments.poses);

    const std::unique_ptr<const Meshes> meshes =
        arguments.distance ? std::make_unique<const Meshes>(scene, pair) : nullptr;
    std::string text =
        std::string("table_gap,hit,pair,px,py,pz,nx,ny,nz") + (meshes ? ",distance" : "") + "\n";
    std::size_t hits = 0, outside = 0;
    Json outsideRows = Json::array();
    for (std::size_t row = 0; row < poses.rows.size(); ++row) {
        std::vector<double> q = poses.rows[row];
        for (std::size_t k = 0; k < q.size(); ++k) q[k] = fromUser(motion.dofs[k], q[k]);
        const bool out = beyond(motion, q);
        if (out && ++outside <= mostRowsNamed) outsideRows.push_back(row);
        if (pair.proof) { // within the limits they never meet: no test is made; beyond nothing is known
            text += out ? "nan,0,-1,,,,,," : fmt::format("{},0,-1,,,,,,", pair.proof->clearance);
        } else {
            const QueryResult r = query(*pair.table, pose(motion, q));
            hits += r.hit() && !out;
            text += fmt::format("{},{},{},{},{},{},{},{},{}", r.gap, r.hit() ? 1 : 0, r.test, r.point.x(),
                                r.point.y(), r.point.z(), r.normal.x(), r.normal.y(), r.normal.z());
        }
        text += meshes ? fmt::format(",{}\n", meshes->a.distanceTo(meshes->b, pose(motion, q))) : "\n";
    }
    writeFileAtomically(arguments.output, text);
    console.say(fmt::format("{} poses, {} hits, wrote {}", poses.rows.size(), hits, arguments.output));
    if (outside > 0)
        console.say(
            fmt::format("{} poses, the first in row {}, lie outside the limits that the {} was made for: no "
                        "bound holds there, and they are not among the hits",
                        outside, outsideRows[0].get<std::size_t>() + 1, pair.proof ? "proof" : "table"));
    console.print({{"poses", poses.rows.size()},
                   {"hits", hits},
                   {"outsideLimits", outside},
                   {"outsideRows", outsideRows},
                   {"output", arguments.output}});
}

} // namespace

void addQuery(Options& app, Console& console) {
    Options* command = addCommand(app, console, "query", "contact, its point and its normal at given poses");
    auto arguments = std::make_shared<QueryArguments>();
    command->add_option("scene", arguments->scene, "a baked scene")->required();
    command->add_option("--pair", arguments->pair, "prim path of the pair (not needed when there is one)");
    command->add_option("--poses", arguments->poses, "CSV, one column a DOF: degrees, or the DOF's own unit")
        ->required();
    command
        ->add_option(
            "-o,--output", arguments->output,
            "CSV: table_gap,hit,pair,px,py,pz,nx,ny,nz; lengths in scene units, point and normal in body A's "
            "frame. table_gap is that of the table's spheres: where it is above 0 it is no distance of the "
            "meshes. Beyond the limits no bound holds: --json lists such rows, and of a pair that never "
            "collides their table_gap is nan")
        ->required();
    command->add_flag(
        "--distance", arguments->distance,
        "a last column, distance: that of the meshes themselves, 0 where they touch or overlap; slow");
    command->callback([arguments, &console] { runQuery(*arguments, console); });
}

} // namespace tss::tool
