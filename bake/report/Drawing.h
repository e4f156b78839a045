#pragma once
#include "bake/base/Words.h"
#include "bake/report/Plots.h"

namespace tss::reporting {

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

} // namespace tss::reporting
