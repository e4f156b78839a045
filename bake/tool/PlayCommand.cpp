#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/respond/JointResponse.h"
#include "bake/scene/Kinematics.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "bake/tool/Command.h"
#include "bake/tool/Csv.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace tss::tool {

namespace {

struct PlayArguments {
    std::string scene, motion, output, meshes;
};

/// The asked DOF values of all joints, one row a step; joints in file order, DOFs in the joint's order.
std::vector<std::vector<double>> askedSteps(const SceneModel& scene, const PlayArguments& arguments) {
    std::vector<const Dof*> dofs;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) dofs.push_back(&dof);
    std::vector<std::vector<double>> steps;
    if (!arguments.motion.empty()) {
        Csv csv = readCsv(arguments.motion);
        const bool numbered = !csv.header.empty() && (csv.header[0] == "step" || csv.header[0] == "time");
        for (auto& row : csv.rows) {
            if (numbered) row.erase(row.begin());
            if (row.size() != dofs.size())
                throw InputError(Where{arguments.motion, "", ""},
                                 fmt::format("expected {} columns, one a DOF of the scene's joints, found {}",
                                             dofs.size(), row.size()));
            for (std::size_t k = 0; k < dofs.size(); ++k) row[k] = fromUser(*dofs[k], row[k]);
            steps.push_back(row);
        }
        return steps;
    }
    for (double time = scene.startTimeCode; time <= scene.endTimeCode; ++time) {
        std::vector<double> row;
        for (const Joint& joint : scene.joints)
            for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
                const bool driven = k < joint.drives.size() && !joint.drives[k].empty();
                row.push_back(driven ? joint.drives[k].at(time) : joint.dofs[k].rest);
            }
        steps.push_back(row);
    }
    return steps;
}

/// Columns of the scene-wide row that the DOFs of a pair's chain stand in.
std::vector<std::size_t> columnsOf(const SceneModel& scene, const Pair& pair) {
    std::vector<std::size_t> first{0};
    for (const Joint& joint : scene.joints) first.push_back(first.back() + joint.dofs.size());
    std::vector<std::size_t> columns;
    for (int joint : pair.joints)
        for (std::size_t k = 0; k < scene.joints[joint].dofs.size(); ++k) columns.push_back(first[joint] + k);
    return columns;
}

std::vector<double> pick(const std::vector<double>& row, const std::vector<std::size_t>& columns) {
    std::vector<double> values;
    for (std::size_t column : columns) values.push_back(row[column]);
    return values;
}

/// Bodies as they stand at the joints' values, in one OBJ with a group each.
std::string posedMeshes(const SceneModel& scene, const std::vector<double>& row) {
    const std::vector<Pose> placements = posedBodies(scene, row);
    std::string text;
    std::size_t first = 1;
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
        const Body& body = scene.bodies[k];
        if (body.mesh.empty()) continue;
        text += fmt::format("g {}\n", body.path.substr(body.path.rfind('/') + 1));
        for (const Vec3& vertex : body.mesh.vertices) {
            const Vec3 x = placements[k] * vertex;
            text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
        }
        for (const Tri& t : body.mesh.triangles)
            text += fmt::format("f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
        first += body.mesh.vertices.size();
    }
    return text;
}

std::string numbered(const std::string& pattern, std::size_t step) {
    const std::size_t percent = pattern.find('%');
    const std::size_t end = percent == std::string::npos ? percent : pattern.find('d', percent);
    if (end == std::string::npos)
        throw InputError("--mesh-out: expected a name with a number in it, like f_%04d.obj, found \"" +
                         pattern + "\"");
    const std::string digits = pattern.substr(percent + 1, end - percent - 1);
    int width = 0;
    for (char c : digits) {
        if (c < '0' || c > '9' || width > 20)
            throw InputError("--mesh-out: expected %d or %04d in \"" + pattern + "\"");
        width = 10 * width + (c - '0');
    }
    return pattern.substr(0, percent) + fmt::format("{:0{}d}", step, width) + pattern.substr(end + 1);
}

std::string header(const SceneModel& scene) {
    std::string text = "step";
    for (const char* prefix : {"asked_", ""})
        for (const Joint& joint : scene.joints)
            for (const Dof& dof : joint.dofs)
                text +=
                    fmt::format(",{}{}:{}", prefix, joint.path.substr(joint.path.rfind('/') + 1), dof.name);
    return text + ",gap,status\n";
}

/// One line of the result: asked and resolved values as people write them.
std::string line(const SceneModel& scene, std::size_t step, const std::vector<double>& asked,
                 const std::vector<double>& resolved, double gap, JointStatus status) {
    std::string text = std::to_string(step);
    for (const auto* row : {&asked, &resolved}) {
        std::size_t column = 0;
        for (const Joint& joint : scene.joints)
            for (const Dof& dof : joint.dofs) text += fmt::format(",{}", toUser(dof, (*row)[column++]));
    }
    return text + fmt::format(",{},{}\n", gap, name(status));
}

/// Lets every pair with a table have its say on the way from `row` to `asked`, in file order.
JointResult step(const SceneModel& scene, std::vector<double>& row, const std::vector<double>& asked) {
    std::vector<double> want = asked;
    JointResult worst;
    worst.gap = std::numeric_limits<double>::infinity();
    for (const Pair& pair : scene.pairs) {
        const std::vector<std::size_t> columns = columnsOf(scene, pair);
        if (!pair.table) continue;
        const std::vector<double> last = pick(row, columns), goal = pick(want, columns);
        JointResult result = respond(*pair.table, {last, goal});
        for (std::size_t k = 0; k < columns.size(); ++k) want[columns[k]] = result.q[k];
        if (result.gap < worst.gap) worst = result;
    }
    row = want;
    return worst;
}

void play(const PlayArguments& arguments, const Console& console) {
    const SceneModel scene = loadScene(arguments.scene);
    const auto steps = askedSteps(scene, arguments);
    std::vector<double> row;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) row.push_back(dof.rest);

    std::string text = header(scene);
    std::map<std::string, int> statuses;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const JointResult result = step(scene, row, steps[k]);
        text += line(scene, k, steps[k], row, result.gap, result.status);
        ++statuses[name(result.status)];
        if (!arguments.meshes.empty())
            writeFileAtomically(numbered(arguments.meshes, k), posedMeshes(scene, row));
    }
    writeFileAtomically(arguments.output, text);
    console.say(fmt::format("{} steps, wrote {}", steps.size(), arguments.output));
    for (const auto& [status, count] : statuses) console.say(fmt::format("  {:<10}{}", status, count));
    console.print({{"steps", steps.size()}, {"statuses", statuses}, {"output", arguments.output}});
}

} // namespace

void addPlay(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "play", "resolves a motion step by step");
    auto arguments = std::make_shared<PlayArguments>();
    command->add_option("scene", arguments->scene, "a baked scene")->required();
    command->add_option("--motion", arguments->motion,
                        "CSV, one row a step, one column a DOF of the joints in file order (default: the "
                        "scene's own drives)");
    command->add_option("-o,--output", arguments->output, "CSV: step, asked and resolved DOFs, gap, status")
        ->required();
    command->add_option("--mesh-out", arguments->meshes, "also the posed meshes, like f_%04d.obj");
    command->callback([arguments, &console] { play(*arguments, console); });
}

} // namespace tss::tool
