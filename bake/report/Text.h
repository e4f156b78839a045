#pragma once
#include "bake/base/Words.h"
#include "bake/report/Report.h"

namespace tss::reporting {

// Pieces of report.md.

/// Three digits, thousands as they are.
std::string number(double value);
/// "12.3 ns", "4.5 µs".
std::string timeText(double nanoseconds);
/// With the tenth and ninetieth percentile.
std::string timeText(const Times& times);
std::string bytesText(std::size_t bytes);
/// "3 of 40"; "0" for none, "–" of nothing.
std::string shareText(std::size_t part, std::size_t whole);
std::string notRunText(const std::vector<NotRun>& notRun);
/// The plot whose file name has this part, with its caption; nothing where it was not drawn.
std::string pictureText(const std::vector<Plot>& plots, const std::string& part);

/// besidePaper: also the paper's own counts, and what this project set out to reach.
std::string pairText(const PairStudy& study, const std::vector<Plot>& plots, bool besidePaper);
std::string skinText(const SkinStudy& study, const std::vector<Plot>& plots, bool besidePaper);

} // namespace tss::reporting
