#include "bake/compare/Machine.h"

#include <CGAL/version.h>
#include <LinearMath/btScalar.h>
#include <fcl/config.h>
#include <fstream>
#include <hwy/highway.h>
#include <thread>

namespace tss::compare {

#define TSS_TEXT_OF(x) #x
#define TSS_TEXT(x) TSS_TEXT_OF(x)

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
    const std::int64_t supported = hwy::SupportedTargets();
    machine.vectors = hwy::TargetName(supported & -supported); // the best is the lowest bit
    machine.libraries = "FCL " FCL_VERSION ", Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
                        std::to_string(BT_BULLET_VERSION % 100) + ", CGAL " TSS_TEXT(CGAL_VERSION);
    return machine;
}

} // namespace tss::compare
