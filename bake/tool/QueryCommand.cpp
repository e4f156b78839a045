#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "bake/tool/ChoosePair.h"
#include "bake/tool/Command.h"
#include "bake/tool/Csv.h"
#include "bake/tool/DofSpec.h"

#include <fmt/format.h>

namespace tss::tool {

namespace {

struct QueryArguments {
    std::string scene, pair, poses, output;
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

    std::string text = "gap,hit,pair,px,py,pz,nx,ny,nz\n";
    std::size_t hits = 0, outside = 0;
    for (std::vector<double> q : poses.rows) {
        for (std::size_t k = 0; k < q.size(); ++k) q[k] = fromUser(motion.dofs[k], q[k]);
        outside += withinLimits(motion, q, 1e-6) ? 0 : 1;
        if (pair.proof) { // they never meet: no test is made
            text += fmt::format("{},0,-1,,,,,,\n", pair.proof->clearance);
            continue;
        }
        const QueryResult r = query(*pair.table, pose(motion, q));
        hits += r.hit();
        text += fmt::format("{},{},{},{},{},{},{},{},{}\n", r.gap, r.hit() ? 1 : 0, r.test, r.point.x(),
                            r.point.y(), r.point.z(), r.normal.x(), r.normal.y(), r.normal.z());
    }
    writeFileAtomically(arguments.output, text);
    console.say(fmt::format("{} poses, {} hits, wrote {}", poses.rows.size(), hits, arguments.output));
    if (outside > 0)
        console.say(fmt::format(
            "{} poses lie outside the limits that the table was made for: no bound holds there", outside));
    console.print({{"poses", poses.rows.size()},
                   {"hits", hits},
                   {"outsideLimits", outside},
                   {"output", arguments.output}});
}

} // namespace

void addQuery(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "query", "gap, contact point and normal at given poses");
    auto arguments = std::make_shared<QueryArguments>();
    command->add_option("scene", arguments->scene, "a baked scene")->required();
    command->add_option("--pair", arguments->pair, "prim path of the pair (not needed when there is one)");
    command->add_option("--poses", arguments->poses, "CSV, one column a DOF: degrees, or the DOF's own unit")
        ->required();
    command
        ->add_option(
            "-o,--output", arguments->output,
            "CSV: gap,hit,pair,px,py,pz,nx,ny,nz; lengths in scene units, point and normal in body A's "
            "frame. The gap is that of the table's spheres: where it is above 0 it is no distance of the "
            "meshes")
        ->required();
    command->callback([arguments, &console] { runQuery(*arguments, console); });
}

} // namespace tss::tool
