#include "bake/report/Machine.h"

#include "bake/compare/Versions.h"

#include <fstream>
#include <thread>

namespace tss::reporting {

Machine thisMachine() {
    Machine machine;
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; machine.processor.empty() && std::getline(info, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
            machine.processor = line.substr(line.find(": ") + 2);
    if (machine.processor.empty()) machine.processor = "unknown processor";
    machine.cores = std::thread::hardware_concurrency();
#if defined(__clang__)
    machine.compiler = "clang " __clang_version__;
#elif defined(__GNUC__)
    machine.compiler = "gcc " __VERSION__;
#endif
#if defined(NDEBUG)
    machine.build = "optimised, no assertions, no contraction of products and sums";
#else
    machine.build = "with assertions: times are not comparable";
#endif
    machine.vectors = compare::vectorInstructions();
    machine.libraries = compare::libraryVersions();
    return machine;
}

} // namespace tss::reporting
