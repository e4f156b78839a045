#pragma once
#include "bake/respond/JointStatus.h"
#include "bake/table/Table.h"

namespace tss {

struct JointRequest {
    std::span<const double> last;  ///< where the joint is, one value a DOF
    std::span<const double> asked; ///< where it is asked to go
};

struct JointResult {
    std::vector<double> q; ///< where it may go
    double gap = 0;        ///< of the table at q
    int test = -1;         ///< the test that gives the gap
    JointStatus status = JointStatus::Free;
};

/// Keeps a joint out of collision (METHOD 5): never through an obstacle; from a free start never into
/// collision and never farther from the asked pose than the start; no stiffness, no time step, the same bits
/// for the same input. The simple entry: it prepares everything anew at each call. At run time use a
/// JointResponder.
JointResult respond(const Table& table, const JointRequest& request);

} // namespace tss
