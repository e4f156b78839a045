#pragma once
#include "bake/base/Progress.h"
#include "bake/base/Words.h"
#include "bake/model/SceneModel.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace tss::tool {

using Json = nlohmann::ordered_json;

/// What every command has: --json, --quiet, and how it ends.
struct Console {
    bool json = false;  ///< one JSON object on stdout, everything else on stderr
    bool quiet = false; ///< nothing but errors and what was asked for
    int exitCode = 0;   ///< 0 done, 1 the input is at fault

    /// A line for people: on stdout, or on stderr with --json; nothing with --quiet.
    void say(const std::string& text) const;
    /// What was asked for, also with --quiet.
    void answer(const std::string& text) const;
    /// The result with --json.
    void print(const Json& result) const;
    /// A progress bar on stderr when that is a terminal; nothing otherwise.
    Progress progress() const;
};

/// The extension of a file name as it is written, ".tss"; empty: it has none.
std::string fileExtension(const std::string& file);

/// Whether a file name has the extension of a mesh file.
bool isMeshName(const std::string& file);

/// Throws InputError where the output would replace a file that is read.
void refuseOverwriting(const std::string& output, std::initializer_list<std::string> inputs);

/// Throws InputError where a scene cannot be written under this name, or a text for people and other
/// programs: before long work, not after it.
void expectScene(const std::string& output);
void expectText(const std::string& output);

/// The pair of this prim path, or the only one of the scene when the path is empty. Throws InputError that
/// names the file and the pairs there are, and where its table was made for another scene.
const Pair& chooseFreshPair(const SceneModel& scene, const std::string& path, const std::string& file);

/// Adds --json and --quiet to a command.
CLI::App* addCommand(CLI::App& app, Console& console, const std::string& name,
                     const std::string& description);

// One function a command, in a file of its name.
void addMake(CLI::App& app, Console& console);
void addBake(CLI::App& app, Console& console);
void addMerge(CLI::App& app, Console& console);
void addVerify(CLI::App& app, Console& console);
void addInfo(CLI::App& app, Console& console);
void addQuery(CLI::App& app, Console& console);
void addPlay(CLI::App& app, Console& console);
void addValidate(CLI::App& app, Console& console);
void addConvert(CLI::App& app, Console& console);
void addBench(CLI::App& app, Console& console);
void addReport(CLI::App& app, Console& console); ///< only with OSGTSS_REPORT

} // namespace tss::tool
