#include "bake/respond/JointResponse.h"

#include "bake/respond/JointResponder.h"
#include "bake/table/Query.h"

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

JointResult respond(const Table& table, const JointRequest& request) {
    // A free pose is only ever needed from a start in collision, and costly to look for.
    const bool hit = query(table, clampToLimits(table.motion, request.last)).hit();
    const JointResponder responder(table, hit ? JointResponder::Preparation::Fully
                                              : JointResponder::Preparation::Once);
    JointWorkspace workspace = responder.workspace();
    const JointAnswer answer = responder.respond(request.last.data(), request.asked.data(), workspace);
    JointResult result;
    result.q.assign(answer.q.begin(), answer.q.begin() + responder.dofCount());
    result.status = answer.status;
    const QueryResult there = query(table, result.q);
    result.gap = there.gap;
    result.test = there.test;
    return result;
}

} // namespace tss
