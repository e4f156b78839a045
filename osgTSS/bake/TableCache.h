#pragma once
#include "bake/model/SceneModel.h"

#include <chrono>
#include <string>

namespace osgTSS {

/// The file that tables and proofs of an earlier bake are taken from and put into. What cannot be read or
/// written is told, and costs no more than the time to bake it again.
class TableCache {
public:
    /// file: a .tss; empty: nothing is kept.
    explicit TableCache(std::string file) : _file(std::move(file)) {}

    /// Gives the model's pairs and skins what the file holds for them, where that was baked from the same.
    /// Returns how many got something.
    std::size_t takeInto(tss::SceneModel& model) const;

    void save(const tss::SceneModel& model);
    /// Saves if the last time is a while ago, so that what a long bake has done is not lost when it is ended.
    void saveNowAndThen(const tss::SceneModel& model);

private:
    using Time = std::chrono::steady_clock;
    std::string _file;
    Time::time_point _saved = Time::now();
};

} // namespace osgTSS
