#pragma once
#include "bake/report/SkinAsked.h"
#include "bake/respond/SkinRig.h"

namespace tss::reporting {

/// One setting of the run time's answer for a skin, over a whole motion. Lengths in scene units.
struct SkinAnswer {
    int sweeps = 0;         ///< most sweeps of the solver an update; 0: the paper's way, sphere pushes sphere
    bool usual = false;     ///< what applications get
    double nanoseconds = 0; ///< an update, median over the steps that move; processor time
    double deepest =
        0; ///< how much deeper than at rest a skin vertex is in what is below it, worst step and vertex
    double meanDepth = 0;  ///< the same, mean over the steps of the worst vertex
    double farthest = 0;   ///< distance of a vertex to where the converged solve has it, worst
    double rms = 0;        ///< the same, root of the mean square over steps and touched vertices
    double areaChange = 0; ///< of the skin that moves, worst step, as a fraction
};

/// The skin's motion as the answers are judged: what each step asks and how far away the truth is.
struct SkinMotionStudy {
    std::string motion; ///< in words
    std::size_t steps = 0, touched = 0;
    std::vector<SkinAnswer> answers;
    bool bones = false;   ///< some bone moves
    double untouched = 0; ///< deepest of the skin that nothing pushes out, scene units: while muscles alone
                          ///< move it stays at rest, with bones it is carried
    double converged = 0; ///< deepest of the converged solve
    double farthestMove = 0; ///< of a vertex from rest in the converged solve
    double muscleVolume = 0; ///< largest change of a muscle's volume, as a fraction
    std::vector<double> perStepAsked, perStepUntouched, perStepUsual; ///< mean activation; deepest of each
};

/// Plays the motion of skinAskedMotion() with solvers of several sweeps and the paper's pushes, and judges
/// them against the surfaces of what is below the skin and the converged solve (METHOD 8). skin: with its
/// table.
SkinMotionStudy studySkinMotion(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                bool quick);

} // namespace tss::reporting
