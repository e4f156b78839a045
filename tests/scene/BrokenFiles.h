#pragma once
#include <vector>

/// One thing broken in the file of samples::everything().
struct Broken {
    const char* prim;  ///< prim path, "" for the layer
    const char* at;    ///< pointer below it that gets another value
    const char* value; ///< JSON; empty: taken away
    const char* found; ///< pointer below the prim that the message names; "=": the same
    const char* says;  ///< part of the message
};

/// All that is tried, by prim.
const std::vector<Broken>& brokenFiles();
