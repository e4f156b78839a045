#include "bake/BakeOptions.h"
#include "bake/VerifyPair.h"
#include "bake/base/Error.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/Command.h"
#include "bake/tool/DofSpec.h"
#include "bake/verify/Kernel.h"

#include <fmt/format.h>

namespace tss::tool {

namespace {

/// Proves the rounding of the table's run-time kernel.
std::string kernelVerified(const Table& table, Json& json) {
    const PreparedTable prepared(table);
    const KernelVerdict kernel = verifyKernel(table, prepared);
    json["kernel"] = {{"form", name(prepared.form())},
                      {"precision", name(prepared.precision())},
                      {"band", prepared.signBand()},
                      {"provenBand", kernel.early},
                      {"provenGap", kernel.gapOff}};
    return kernel.proven ? "" : "its run-time kernel: " + kernel.reason;
}

/// Proves a pair again; the figures go into `json`. Returns what does not hold, with the pose that breaks it.
std::string verified(const SceneModel& scene, const Pair& pair, Json& json, const Progress& progress) {
    const PairVerdict verdict = verifyPair(scene, pair, progress);
    json["spheresA"] = verdict.spheresA;
    json["spheresB"] = verdict.spheresB;
    json["cells"] = verdict.cells;
    json["band"] = verdict.band;
    if (verdict.early >= 0) json["early"] = verdict.early;
    if (verdict.reason.empty() && pair.table) return kernelVerified(*pair.table, json);
    if (verdict.pose.empty()) return verdict.reason;
    json["pose"] = verdict.pose;
    const Motion motion = pairMotion(scene, pair);
    std::string pose;
    for (std::size_t k = 0; k < verdict.pose.size(); ++k)
        pose +=
            fmt::format("{}{:.9g}", k ? ", " : " at DOF values ", toUser(motion.dofs[k], verdict.pose[k]));
    return verdict.reason + pose;
}

void verify(const std::string& file, Console& console) {
    const SceneModel scene = loadScene(file);
    Json result = {{"file", file}, {"pairs", Json::array()}};
    int bad = 0;
    for (const Pair& pair : scene.pairs) {
        if (!pair.table && !pair.proof) continue;
        Json json = {{"path", pair.path}};
        const std::string why = inFile(file, [&] { return verified(scene, pair, json, console.progress()); });
        json["holds"] = why.empty();
        json["reason"] = why;
        bad += !why.empty();
        if (why.empty())
            console.say(fmt::format("{}: holds at every pose ({} cells, rounding band {})", pair.path,
                                    json["cells"].dump(),
                                    lengthText(json["band"].get<double>(), scene.metersPerUnit)));
        else
            fmt::print(stderr, "{} (<{}>): {}\n", file, pair.path, why);
        result["pairs"].push_back(json);
    }
    if (result["pairs"].empty())
        throw InputError(Where{file, "", ""},
                         "nothing to verify; expected a scene with a baked pair of rigid bodies");
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
        "Proven again: that the table answers as all spheres do, at every pose; that the run-time kernel\n"
        "(fold, float) rounds within its band; how far the table's spheres stick out of the meshes. That the "
        "spheres cover the contact zone (miss 0) follows from\n"
        "making them again from the meshes; it is not proven by other code.");
    command->callback([file, &console] { verify(*file, console); });
}

} // namespace tss::tool
