#include "bake/model/SceneModel.h"

#include <osgTSS/Clock>

#include <cmath>

namespace osgTSS {

Clock::Clock(const tss::SceneModel& scene, Source source)
    : source(source), start(scene.startTimeCode), end(scene.endTimeCode), rate(scene.timeCodesPerSecond) {}

double Clock::timeCode(const osg::FrameStamp& frame) const {
    double elapsed = source == FRAME_NUMBER ? frame.getFrameNumber() : frame.getSimulationTime() * rate;
    if (!std::isfinite(elapsed)) elapsed = 0;
    const double period = end - start;
    if (period > 0) elapsed -= period * std::floor(elapsed / period);
    return start + elapsed;
}

} // namespace osgTSS
