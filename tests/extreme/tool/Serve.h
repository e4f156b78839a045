#pragma once
#include "bake/check/VerifyPair.h"
#include "bake/pipeline/Bake.h"
#include "bake/respond/JointStatus.h"
#include "bake/table/PreparedTable.h"

#include <map>
#include <optional>

namespace extreme {

/// How the table of a pair is asked at run time.
struct KernelFigures {
    tss::KernelForm form = tss::KernelForm::Direct;
    tss::KernelPrecision precision = tss::KernelPrecision::Float;
    double condition = 0; ///< roundoffs of its squared reach by which the worst test may be off
    double floatBand = 0; ///< gaps at which the sign may be wrong in float, scene units
    double band = 0;      ///< and with the kernel that was chosen
};

struct PairFigures {
    std::string path;
    tss::PairVerdict verdict;
    std::optional<KernelFigures> kernel;
    std::map<std::string, int> statuses; ///< of the steps played
    double deepest = 0;                  ///< smallest gap of a step, scene units
};

struct SkinFigures {
    std::string path;
    double size = 0;     ///< diagonal, scene units
    double farthest = 0; ///< that a vertex went, scene units
    double residual = 0; ///< deepest in the muscle beyond its depth at rest, scene units
};

/// What became of a scene on its way through reading, baking, saving, loading, proving and playing.
struct Outcome {
    std::string refusal;   ///< message of the InputError that ended it; empty: served
    bool read = false;     ///< it was read; a refusal after that came from the bake
    tss::SceneModel scene; ///< baked, written and read again
    std::string text;      ///< the baked file
    std::vector<tss::PairReport> reports;
    std::vector<PairFigures> pairs;
    std::vector<SkinFigures> skins;
    std::vector<std::string> troubles; ///< what must never be: numbers that are not finite, bounds that do
                                       ///< not hold, a free joint led into contact, a mesh contact missed
};

struct ServeOptions {
    int poses = 200; ///< of each pair, at which kernels and meshes are compared
    int steps = 0;   ///< more steps of play with random values asked, beyond the limits too
    std::uint64_t seed = 1;
    tss::Progress progress;
    tss::BakeSettings given;
};

/// Takes a file's text all the way. Throws nothing but std::logic_error and the like: a refusal is part of
/// the outcome.
Outcome serve(const std::string& text, const std::string& name, const ServeOptions& options = {});

/// The kernels that this build and this processor have.
std::vector<tss::KernelTarget> kernelTargets();

/// An edge of one mesh goes through a triangle of the other, B placed by the pose.
bool meshesCross(const tss::TriangleMesh& a, const tss::TriangleMesh& b, const tss::Pose& pose);

} // namespace extreme
