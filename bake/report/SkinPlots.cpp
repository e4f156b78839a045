#include "bake/report/Drawing.h"

namespace tss::reporting {

std::vector<Plot> drawPlots(const SkinStudy&, const std::string& folder, const std::string& stem,
                            std::string& problem) {
    Drawing drawing(folder, stem);
    problem = drawing.problem;
    return drawing.plots;
}

} // namespace tss::reporting
