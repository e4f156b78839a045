#pragma once
#include "bake/base/Stopwatch.h"
#include "bake/model/SceneModel.h"
#include "bake/pipeline/Bake.h"
#include "bake/tool/Summary.h"

namespace tss::tool {

/// "jaw.incomplete.tss" for "jaw.tss", or "jaw.incomplete2.tss": what a bake that did not come to its end
/// leaves, so that a file of the name asked for is always whole.
std::string incompleteName(const std::string& output, int number = 1);

/// Bakes a scene for a file. What is done is written to the incomplete file from time to time and where the
/// bake cannot go on; once all is done that file is removed. One that an earlier bake has left stays, unless
/// it is the input of this one. SIGINT and SIGTERM end the bake and not the program until all is written.
class KeptParts {
public:
    KeptParts(SceneModel& scene, const std::string& input, std::string output, BakeTimes times,
              const Console& console);
    ~KeptParts();

    /// Notes of the bake go to people as it ends, and stay in notes().
    void run(BakeRequest request);

    bool complete() const { return failures_.empty() && signal_ == 0 && missing_.empty(); }
    int signal() const { return signal_; } ///< that ended it; 0: none
    const std::vector<InputError>& failures() const { return failures_; }
    const std::vector<std::string>& missing() const { return missing_; } ///< paths of those without a table
    bool bakedAny() const { return bakedAny_; }                          ///< by this bake
    const Json& notes() const { return notes_; }
    const BakeTimes& times() const { return times_; }

    /// Writes what there is: the output, or the incomplete file; nothing where there is no table at all.
    /// Returns the name, empty for nothing.
    std::string write();

private:
    void done(const PairReport& report);
    void writeTo(const std::string& file) const;
    void release(); ///< signals end the program again

    SceneModel& scene_;
    const std::string output_;
    std::string incomplete_;
    BakeTimes times_;
    const Console& console_;
    Json notes_ = Json::object();
    std::vector<InputError> failures_;
    std::vector<std::string> missing_;
    int signal_ = 0;
    bool holds_ = false; ///< signals are noted
    bool bakedAny_ = false;
    bool kept_ = false; ///< the incomplete file is this bake's own
    Stopwatch sinceKept_;
    double nextKept_; ///< seconds after which it is written again
};

} // namespace tss::tool
