#include "bake/pipeline/BoundTable.h"

#include <algorithm>
#include <cmath>

namespace tss {

void boundProof(Selection& selection, const PairTask& task) {
    if (!selection.proof) return;
    double& clearance = selection.proof->clearance;
    clearance -= task.spheres.a.coverage + task.spheres.b.coverage;
    // Surface outside the contact zone is only known to stay this far away.
    if (task.spheres.zoneA || task.spheres.zoneB) clearance = std::min(clearance, task.spheres.zoneMargin);
    if (std::isfinite(clearance) && clearance > 0 && task.ruled.rule.empty() && task.ruled.region.empty())
        return;
    selection.proof.reset();
    selection.certified = true;
}

void boundTable(Table& table, const PairTask& task) {
    if (!table.certified) return;
    const SphereFit &a = task.spheres.a, &b = task.spheres.b;
    table.boundEarly =
        boundOrUnknown(std::max({a.protrusion + b.protrusion + table.epsilon, a.enclosed, b.enclosed}));
    // Tests were selected among the pairs that come within the margin; where the surfaces meet, some test
    // does.
    if (!task.ruled.bySpheres && task.margin >= a.coverage + b.coverage) table.boundMiss = task.margin;
    if (!(table.epsilon > 0)) return;
    // Where spheres touch, some test's gap is at most epsilon: counted as contact from there on it misses
    // nothing. At rest all are farther apart than that.
    table.restGaps.resize(table.testCount(), 0);
    for (double& gap : table.restGaps) gap += table.epsilon;
}

} // namespace tss
