#pragma once
#include "bake/motion/MuscleDeformer.h"
#include "bake/play/JointPlan.h"
#include "bake/respond/SkinRig.h"

#include <osg/Timer>
#include <osgTSS/Scene>

#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <set>

namespace osgTSS {

/// How some pairs are resolved, and room to do it in: one room serves one update after another, warm in the
/// processor's caches, where rooms of a thousand instances would not be.
class SharedPlan {
public:
    explicit SharedPlan(std::shared_ptr<const tss::JointPlan> plan) : _plan(std::move(plan)) {}
    const tss::JointPlan& operator*() const { return *_plan; }
    const tss::JointPlan* operator->() const { return _plan.get(); }

    /// What use(room) returns, in a room that nobody else is in. Safe from any thread.
    template <class Use>
    auto inRoom(const Use& use) {
        std::vector<tss::JointWorkspace> room;
        {
            const std::lock_guard lock(_mutex);
            if (!_rooms.empty()) {
                room = std::move(_rooms.back());
                _rooms.pop_back();
            }
        }
        if (room.empty()) room = tss::workspaces(*_plan);
        auto result = use(room);
        const std::lock_guard lock(_mutex);
        _rooms.push_back(std::move(room));
        return result;
    }

private:
    std::shared_ptr<const tss::JointPlan> _plan;
    std::mutex _mutex;
    std::vector<std::vector<tss::JointWorkspace>> _rooms; ///< that nobody is in
};

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

/// What is made once from a scene's model and shared by all graphs that play it. Safe from any thread.
struct Scene::Cache {
    explicit Cache(std::shared_ptr<const tss::SceneModel> model) : model(std::move(model)) {}

    std::shared_ptr<SharedPlan> plan(const std::vector<std::string>& pairPaths);

    /// The deformer of a muscle, in the frame of its own surface. Throws tss::InputError.
    std::shared_ptr<const tss::MuscleDeformer> muscle(int index);

    /// The rig of a skin, with its muscles in the skin's frame; null when it has no table. Throws
    /// tss::InputError.
    std::shared_ptr<const tss::SkinRig> rig(int index);

    /// The time of all callbacks of the scene. In update and event traversals only.
    UpdateTime updateTime;

private:
    std::shared_ptr<const tss::SceneModel> model;
    std::mutex mutex;
    std::map<std::vector<std::string>, std::weak_ptr<SharedPlan>> plans;
    std::deque<std::shared_ptr<SharedPlan>> recent; ///< pairs are let go and taken up again now and then
    std::set<std::string> told; ///< warnings, once each whatever pairs are planned together
    std::map<int, std::shared_ptr<const tss::MuscleDeformer>> muscles;
    std::map<int, std::shared_ptr<const tss::SkinRig>> rigs;
};

} // namespace osgTSS
