#pragma once
#include <string>
#include <vector>

namespace osgTSS {

/// How tss-render speaks: --json, --quiet.
struct Speech {
    bool json = false, quiet = false;
};

/// Which pictures were written, of how many frames; at least one.
void tellPictures(const Speech& speech, unsigned int frames, const std::vector<std::string>& files);

/// Returns the code to exit with, as it is given.
int tellFailure(const Speech& speech, int code, const std::string& message);

} // namespace osgTSS
