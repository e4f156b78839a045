#include "bake/respond/JointStatus.h"

namespace tss {

const char* name(JointStatus status) {
    switch (status) {
    case JointStatus::Free:
        return "free";
    case JointStatus::Blocked:
        return "blocked";
    case JointStatus::Slid:
        return "slid";
    case JointStatus::Separated:
        return "separated";
    case JointStatus::Stuck:
        return "stuck";
    case JointStatus::Returning:
        return "returning";
    }
    return "?";
}

} // namespace tss
