#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/SourceHash.h"
#include "bake/play/MechanismQuery.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "bake/tool/Command.h"
#include "bake/tool/CsvTable.h"

#include <fmt/format.h>

namespace tss::tool {

namespace {

/// Rows outside the limits that are listed; all are counted.
constexpr std::size_t mostRowsNamed = 1000;

struct QueryArguments {
    std::string scene, pair, poses, output;
    bool distance = false; ///< of the meshes themselves, too
    bool allPairs = false;
};

/// The two bodies as they are, to ask for their distance.
struct Meshes {
    Meshes(const SceneModel& scene, const Pair& pair)
        : a(scene.bodies[pair.bodyA].mesh), b(scene.bodies[pair.bodyB].mesh) {}
    MeshQuery a, b;
};

void sayHits(const QueryArguments& arguments, const Console& console, std::size_t poses, std::size_t hits,
             const Json& outsideRows, std::size_t outside, const std::string& madeFor) {
    console.say(
        fmt::format("{}, {}, wrote {}", counted(poses, "pose"), counted(hits, "hit"), arguments.output));
    if (outside > 0)
        console.say(fmt::format("{}, the first in row {}, outside the limits that the {} made for: no bound "
                                "holds there, and the hits are without",
                                counted(outside, "pose"), outsideRows[0].get<std::size_t>() + 1, madeFor));
    console.print({{"poses", poses},
                   {"hits", hits},
                   {"outsideLimits", outside},
                   {"outsideRows", outsideRows},
                   {"output", arguments.output}});
}

/// Every pair at once, from the values of all joints.
void runAllPairs(const QueryArguments& arguments, const Console& console) {
    using Verdict = MechanismAnswer::Verdict;
    const SceneModel scene = loadScene(arguments.scene);
    requireFresh(scene, arguments.scene);
    const MechanismQuery mechanism(scene);
    if (const std::vector<int>& bare = mechanism.unanswered(); !bare.empty())
        throw InputError(Where{arguments.scene, "", scene.pairs[bare.front()].path},
                         fmt::format("{} without a table; expected a scene written by tss bake",
                                     counted(bare.size(), "pair")));
    const auto [poses, remark] = readDofRows(arguments.poses, dofColumns(scene));
    if (!remark.empty()) console.say(remark);
    std::vector<double> values;
    for (const std::vector<double>& row : poses) values.insert(values.end(), row.begin(), row.end());
    std::vector<MechanismAnswer> answers(poses.size());
    MechanismWorkspace workspace = mechanism.workspace();
    mechanism.ask(values.data(), answers.size(), answers.data(), workspace);
    std::string text = "hit,pair\n";
    std::size_t hits = 0, outside = 0;
    Json outsideRows = Json::array();
    for (std::size_t row = 0; row < poses.size(); ++row) {
        const MechanismAnswer& answer = answers[row];
        if (answer.verdict == Verdict::Beyond && ++outside <= mostRowsNamed) outsideRows.push_back(row);
        hits += answer.verdict == Verdict::Contact;
        text += answer.verdict == Verdict::Beyond ? "nan,\n"
                : answer.pair < 0                 ? "0,\n"
                                                  : "1," + scene.pairs[answer.pair].path + "\n";
    }
    writeFileAtomically(arguments.output, text);
    sayHits(arguments, console, poses.size(), hits, outsideRows, outside, "tables and proofs were");
}

void runQuery(const QueryArguments& arguments, const Console& console) {
    refuseOverwriting(arguments.output, {arguments.scene, arguments.poses});
    expectText(arguments.output);
    if (arguments.allPairs) return runAllPairs(arguments, console);
    const SceneModel scene = loadScene(arguments.scene);
    const Pair& pair = chooseFreshPair(scene, arguments.pair, arguments.scene);
    if (!pair.table && !pair.proof)
        throw InputError(Where{arguments.scene, "", pair.path},
                         "has no table; expected a scene written by tss bake");
    const Motion motion = pairMotion(scene, pair);
    const auto [poses, remark] = readDofRows(arguments.poses, dofColumns(scene, pair));
    if (!remark.empty()) console.say(remark);
    const std::unique_ptr<const Meshes> meshes =
        arguments.distance ? std::make_unique<const Meshes>(scene, pair) : nullptr;
    std::string text =
        std::string("table_gap,hit,pair,px,py,pz,nx,ny,nz") + (meshes ? ",distance" : "") + "\n";
    std::size_t hits = 0, outside = 0;
    Json outsideRows = Json::array();
    for (std::size_t row = 0; row < poses.size(); ++row) {
        const std::vector<double>& q = poses[row];
        const bool out = beyondLimits(motion, q);
        if (out && ++outside <= mostRowsNamed) outsideRows.push_back(row);
        if (pair.proof) { // within the limits they never meet: no test is made; beyond nothing is known
            text += out ? "nan,nan,-1,,,,,," : fmt::format("{},0,-1,,,,,,", pair.proof->clearance);
        } else {
            const QueryResult r = query(*pair.table, pose(motion, q));
            hits += r.hit() && !out;
            const std::string hit = out ? "nan" : r.hit() ? "1" : "0";
            if (r.test < 0) // the table has none
                text += "," + hit + ",-1,,,,,,";
            else
                text += fmt::format("{},{},{},{},{},{},{},{},{}", r.gap, hit, r.test, r.point.x(),
                                    r.point.y(), r.point.z(), r.normal.x(), r.normal.y(), r.normal.z());
        }
        text += meshes ? fmt::format(",{}\n", meshes->a.distanceTo(meshes->b, pose(motion, q))) : "\n";
    }
    writeFileAtomically(arguments.output, text);
    sayHits(arguments, console, poses.size(), hits, outsideRows, outside,
            pair.proof ? "proof was" : "table was");
}

} // namespace

void addQuery(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "query", "contact, its point and its normal at given poses");
    auto arguments = std::make_shared<QueryArguments>();
    command->add_option("scene", arguments->scene, "a baked scene")->required();
    command->add_option("--pair", arguments->pair, "prim path of the pair (not needed when there is one)");
    command->add_option("--poses", arguments->poses, "CSV, one column a DOF: degrees, or the DOF's own unit")
        ->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "CSV: table_gap,hit,pair,px,py,pz,nx,ny,nz; lengths in scene units, point and normal in "
                     "body A's frame. table_gap is that of the table's spheres: where it is above 0 it is no "
                     "distance of the meshes; a table without a test has none. Beyond the limits no bound "
                     "holds: hit is nan there, and so is the table_gap of a pair that never collides")
        ->required();
    command->add_flag(
        "--distance", arguments->distance,
        "a last column, distance: that of the meshes themselves, 0 where they touch or overlap; slow");
    command
        ->add_flag("--all-pairs", arguments->allPairs,
                   "whether any pair of the scene touches: one column for each DOF of all joints, in the "
                   "order of the file; CSV: hit,pair, one that touches. Nan: outside the limits of some "
                   "pair, and no other one touches")
        ->excludes(command->get_option("--pair"))
        ->excludes(command->get_option("--distance"));
    command->callback([arguments, &console] { runQuery(*arguments, console); });
}

} // namespace tss::tool
