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

/// Prims of that file.
namespace prims {
inline constexpr const char* jaw = "/Scene/Jaw";
inline constexpr const char* hinge = "/Scene/Hinge";
inline constexpr const char* ends = "/Scene/Ends";
inline constexpr const char* mesh = "/Scene/A";
inline constexpr const char* table = "/Scene/Jaw/Table";
inline constexpr const char* spheres = "/Scene/Jaw/Table/Spheres0";
inline constexpr const char* proof = "/Scene/Ends/Table";
inline constexpr const char* muscle = "/Scene/Frontalis";
inline constexpr const char* skin = "/Scene/Skin";
inline constexpr const char* skinTable = "/Scene/Skin/Table";
inline constexpr const char* layer = "";
} // namespace prims

/// All that is tried, by prim.
const std::vector<Broken>& brokenFiles();
