#pragma once
#include "bake/base/Words.h"
#include "bake/model/SceneModel.h"
#include "bake/report/SkinStudy.h"
#include "bake/report/Study.h"

namespace tss::reporting {

/// A plot that was drawn: its file inside the report's folder and what it shows.
struct Plot {
    std::string file, caption;
};

/// Errors are drawn on a logarithmic axis: smaller ones of a pair's methods, 0 among them, count as this,
/// millimetres.
constexpr double leastErrorDrawn = 1e-4;

/// The k-th of twelve colours that are told apart on white.
const char* colour(std::size_t k);

/// Collects the plots of one study: writes data and script into folder/plots, runs gnuplot, keeps what was
/// drawn. In a script, the variable FILE is the data's name.
class Drawing {
public:
    /// stem: what the names of all files begin with.
    Drawing(std::string folder, std::string stem);

    void draw(const std::string& name, const std::string& data, const std::string& script,
              const std::string& caption, int width = 900, int height = 560);

    std::vector<Plot> plots;
    std::string problem; ///< why there are fewer plots than there should be

private:
    std::string folder_, stem_;
};

/// Draws the plots of a pair as SVG into folder/plots by gnuplot, data and scripts beside them, so that
/// anyone can draw them again. stem: what their names begin with. Where gnuplot cannot be run, no plot is in
/// the list, and `problem` says why.
std::vector<Plot> drawPlots(const PairStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem);

/// The same for a skin.
std::vector<Plot> drawPlots(const SkinStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem);

/// A drawing of two bodies.
struct Picture {
    std::string caption;
    std::string png; ///< the file's bytes; what is not covered is transparent
};

/// The bodies of a pair where the joint rests and where its leading DOF is at either limit, all from the same
/// side: along the axis of a DOF that turns, else from the front.
std::vector<Picture> picturesOf(const SceneModel& scene, const Pair& pair, std::size_t leadingDof);

} // namespace tss::reporting
