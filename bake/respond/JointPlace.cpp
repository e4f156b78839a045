// The buffers of a response, and the poses of a model's groups.
#include "bake/respond/JointModel.h"

#include <algorithm>

namespace tss {

ResponseBuffers buffersFor(const JointModel& model) {
    ResponseBuffers ws;
    ws.near.resize(model.unclusteredPairs);
    ws.active.resize(model.unclusteredPairs);
    std::size_t room = 0;
    for (const JointModel::Group& group : model.groups) room = std::max(room, group.prepared->testRoom());
    ws.found.resize(room);
    ws.rows = QpRows(model.unclusteredPairs + 2 * std::size_t(model.dofCount) + model.planes.size());
    ws.groups.resize(model.groups.size());
    ws.chains.resize(model.chains.size());
    ws.ends.resize(model.groups.size());
    ws.ended.resize(model.groups.size());
    ws.held.resize(model.groups.size());
    if (!model.clustered) return ws;
    ws.listed.resize(model.pairs.size());
    ws.caches.resize(model.groups.size());
    for (NearCache& cache : ws.caches) cache.tests.resize(NearCache::most);
    return ws;
}

namespace {

/// Places a group with the poses of its chain, computing only links whose values changed. Same bits as
/// evaluateFrame().
void placeOnChain(const JointModel& model, const JointModel::Group& group, PlacedGroup& placed,
                  PlacedChain& chain) {
    const std::size_t count = group.dofs.size();
    std::size_t same = 0;
    while (same < std::min(count, chain.count) && chain.at[same] == placed.at[same]) ++same;
    if (same < count) {
        std::copy(placed.at.begin() + std::ptrdiff_t(same), placed.at.begin() + std::ptrdiff_t(count),
                  chain.at.begin() + std::ptrdiff_t(same));
        evaluateLinks(model.chains[std::size_t(group.chain)].motion, chain.at.data(), same, count,
                      chain.before.data(), chain.twists.data());
        chain.count = count;
    }
    placed.frame.pose = chain.before[count] * group.motion.base;
    std::copy_n(chain.twists.begin(), count, placed.frame.twists.begin());
    placed.frame.rowAhead = false;
}

} // namespace

void placeGroup(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& step,
                ResponseBuffers& ws) {
    const JointModel::Group& group = model.groups[g];
    PlacedGroup& placed = ws.groups[g];
    DofValues direction;
    bool same = placed.valid && !group.paths; // the twists of a path depend on the direction
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const double value = q[group.dofs[k]];
        same = same && placed.at[k] == value;
        placed.at[k] = value;
        direction[k] = step[group.dofs[k]];
    }
    if (same) return;
    placed.valid = true;
    if (group.chain >= 0) return placeOnChain(model, group, placed, ws.chains[std::size_t(group.chain)]);
    evaluateFrame(group.motion, placed.at.data(), direction.data(), placed.frame);
}

} // namespace tss
