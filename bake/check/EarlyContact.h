#pragma once
#include "bake/model/SceneModel.h"
#include "bake/table/PreparedTable.h"

#include <algorithm>
#include <optional>

namespace tss {

/// How often a table reports contact where the meshes do not touch: a bound tells how far apart they may be
/// then, not whether the joint ever opens that far. Measured on the meshes, at poses spread over all limits.
struct EarlyContact {
    double atRest = 0;         ///< scene units: the surfaces are that far apart at rest; 0: they touch
    bool close = false;        ///< by so little that no tolerance is proposed for it
    bool restReported = false; ///< contact is reported at rest, though the surfaces are apart, not close
    bool held = false;         ///< rest is reported free, and every small step from it as contact
    int poses = 0;             ///< looked at
    int freePoses = 0;         ///< of those, where the surfaces are apart
    double share = 0;          ///< of the free ones: contact is reported
    double tolerance =
        0; ///< scene units: one that leaves the joint most of its clearance; 0: none needed or found
    double shareThen = 0; ///< of the free ones, with that tolerance: no more than this

    /// The tolerance is too coarse for the joint's clearance: contact is reported at rest or at many free
    /// poses. (Where most poses touch, the few others are near contact whatever the tolerance.)
    bool coarse() const { return restReported || share * freePoses > 0.1 * std::max(freePoses, poses / 2); }

    /// The meshes touch at most poses, though not all.
    bool touching() const { return !stuck() && 2 * freePoses < poses; }

    /// The bodies overlap wherever the joint goes: it cannot leave its rest.
    bool stuck() const { return close && 20 * freePoses < poses; }
};

/// Nothing for a pair without a table or a table without a bound. prepared: its table, where there is one
/// already.
std::optional<EarlyContact> measureEarlyContact(const SceneModel& scene, const Pair& pair);
std::optional<EarlyContact> measureEarlyContact(const SceneModel& scene, const Pair& pair,
                                                const PreparedTable& prepared);

} // namespace tss
