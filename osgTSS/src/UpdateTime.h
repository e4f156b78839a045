#pragma once
#include <osg/Timer>

#include <atomic>

namespace osgTSS {

/// Time that the callbacks of a scene take in an update traversal, measured while somebody wants it.
struct UpdateTime {
    std::atomic<bool> wanted = false;
    osg::Timer_t begin = 0, end = 0; ///< of the first and the last callback since reset()
    double seconds = 0;              ///< in all of them

    /// From here on it counts anew.
    void reset() {
        begin = end = 0;
        seconds = 0;
    }
};

/// From here to the end of the block.
class MeasureUpdate {
public:
    explicit MeasureUpdate(UpdateTime& time)
        : _time(time), _wanted(time.wanted.load(std::memory_order_relaxed)) {
        if (_wanted) _start = osg::Timer::instance()->tick();
    }
    ~MeasureUpdate() {
        if (!_wanted) return;
        _time.end = osg::Timer::instance()->tick();
        if (_time.begin == 0) _time.begin = _start;
        _time.seconds += osg::Timer::instance()->delta_s(_start, _time.end);
    }
    MeasureUpdate(const MeasureUpdate&) = delete;
    MeasureUpdate& operator=(const MeasureUpdate&) = delete;

private:
    UpdateTime& _time;
    bool _wanted;
    osg::Timer_t _start = 0;
};

} // namespace osgTSS
