#pragma once
#include "Framing.h"

namespace tss {
struct SceneModel;
}

namespace osgTSS {

/// Where a point of the scene is drawn, in world coordinates. turned: the loader stands its Y axis up.
template <class Point>
osg::Vec3d shown(const Point& x, bool turned) {
    return turned ? osg::Vec3d(x.x(), -x.z(), x.y()) : osg::Vec3d(x.x(), x.y(), x.z());
}

/// Whether bodies stand still and dwarf all that moves, as a ground does.
bool hasScenery(const tss::SceneModel& scene);

/// Adds what bodies and skins reach when the joints and muscles of the scene do all that is asked of them,
/// without such scenery. animated: the graph's own animations play. still: as the motion begins alone.
void addReach(Framing& framing, const tss::SceneModel& scene, bool turned, bool animated, bool still);

} // namespace osgTSS
