#pragma once
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

/// Draws the plots of a pair as SVG into folder/plots by gnuplot, data and scripts beside them, so that
/// anyone can draw them again. stem: what their names begin with. Where gnuplot cannot be run, no plot is in
/// the list, and `problem` says why.
std::vector<Plot> drawPlots(const PairStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem);

/// The same for a skin.
std::vector<Plot> drawPlots(const SkinStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem);
} // namespace tss::reporting
