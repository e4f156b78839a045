// The `tss` command: tables of sphere pairs from the shell. Exit 0 done, 1 the input is at fault, 2 usage, 3
// internal.
#include "bake/base/Error.h"
#include "bake/tool/Command.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <iostream>

namespace {

int fail(const tss::tool::Console& console, int code, const std::string& message,
         const tss::Where& where = {}) {
    fmt::print(stderr, "tss: {}\n", message);
    console.print(
        {{"error",
          {{"message", message}, {"file", where.file}, {"pointer", where.pointer}, {"path", where.path}}},
         {"exit", code}});
    return code;
}

/// What makes a scene of a file that is none, as far as its name says what it is.
std::string hintFor(const tss::InputError& error) {
    if (error.message.find("expected JSON") == std::string::npos) return "";
    const std::string& file = error.where.file;
    if (tss::tool::isMeshName(file)) return "; of a mesh `tss convert` makes a scene, of two `tss make`";
    for (const char* robot : {".urdf", ".xml", ".mjcf", ".usda"})
        if (file.ends_with(robot)) return "; of a robot's file `tss make` makes a scene";
    for (const char* graph : {".osg", ".osgt", ".osgb", ".osgx", ".ive"})
        if (file.ends_with(graph)) return "; of a graph `osgconv " + file + ".tss OUT.tss` makes a scene";
    return "";
}

/// A word that is no command; said here, as it would else be called a missing one.
bool mistyped(const CLI::App& app, const std::string& word) {
    std::string names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (command->get_name() == word) return false;
        names += " " + command->get_name();
    }
    if (word.starts_with('-')) return false;
    fmt::print(stderr, "tss: \"{}\" is no command; expected one of{}\n", word, names);
    return true;
}

/// The exit code, unless what was said has not got out.
int said(int code) {
    std::cout.flush();
    if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout) return code;
    fmt::print(stderr, "tss: standard output cannot be written: {}\n", std::strerror(errno));
    return std::max(code, 1);
}

} // namespace

int main(int argc, char** argv) {
    using namespace tss::tool;
    std::signal(SIGXFSZ,
                SIG_IGN); // a file that may not grow further is an error to report, and its rest to remove
    CLI::App app("Tabulated sphere subsets: collisions between things whose motion is constrained.", "tss");
    app.set_version_flag("--version", std::string("tss ") + OSGTSS_VERSION);
    app.require_subcommand(1);
    app.footer("Lengths take a unit (0.2mm, 1cm) or are scene units; angles are degrees.\n"
               "Exit: 0 done, 1 the input is at fault, 2 usage, 3 internal error.");
    Console console;
    addMake(app, console);
    addBake(app, console);
    addMerge(app, console);
    addInfo(app, console);
    addVerify(app, console);
    addQuery(app, console);
    addPlay(app, console);
    addValidate(app, console);
    addConvert(app, console);
    addBench(app, console);
#ifdef OSGTSS_HAVE_REPORT
    addReport(app, console);
#endif
    if (argc > 1 && mistyped(app, argv[1])) return 2;
    try {
        app.parse(argc, argv);
        return said(console.exitCode);
    } catch (const CLI::ParseError& error) {
        return said(app.exit(error) == 0 ? 0 : 2);
    } catch (const tss::InputError& error) {
        return fail(console, 1, std::string(error.what()) + hintFor(error), error.where);
    } catch (const std::bad_alloc&) {
        return fail(console, 1, "not enough memory for this input");
    } catch (const std::exception& error) {
        return fail(console, 3, std::string("internal error: ") + error.what());
    }
}
