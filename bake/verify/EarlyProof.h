#pragma once
#include "bake/verify/StickingOut.h"

namespace tss::verify {

/// What is shown of a table's early reports.
struct EarlyResult {
    double bound = 0;      ///< where a test fires, points of the two bodies are no farther apart than this
    bool surfaces = false; ///< shown for the surfaces alone: nothing is taken to be behind openings
    bool proven = false;
    std::string reason;       ///< why not; empty when proven
    std::vector<double> pose; ///< that breaks it, or where it could not be told; may be empty
    std::uint64_t cells = 0;  ///< boxes of Q looked at
};

/// Shows from the meshes that wherever a test fires the two surfaces are at most `claimed` apart: how far the
/// spheres of each test stick out of their bodies bounds how far apart the bodies are, and Nesting.h shows
/// that then neither is inside the other with the surfaces apart.
EarlyResult proveEarly(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion, double size,
                       const StickingOut& outA, const StickingOut& outB, const std::vector<MeshTest>& tests,
                       double claimed, const Progress& progress);

} // namespace tss::verify
