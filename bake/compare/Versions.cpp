#include "bake/compare/Versions.h"

#include <CGAL/version.h>
#include <LinearMath/btScalar.h>
#include <fcl/config.h>
#include <hwy/highway.h>

namespace tss::compare {

#define TSS_TEXT_OF(x) #x
#define TSS_TEXT(x) TSS_TEXT_OF(x)

std::string libraryVersions() {
    return "FCL " FCL_VERSION ", Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
           std::to_string(BT_BULLET_VERSION % 100) + ", CGAL " TSS_TEXT(CGAL_VERSION);
}

std::string vectorInstructions() {
    const std::int64_t supported = hwy::SupportedTargets();
    return hwy::TargetName(supported & -supported); // the best is the lowest bit
}

} // namespace tss::compare
