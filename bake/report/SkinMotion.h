#pragma once
#include "bake/model/SceneModel.h"
#include "bake/respond/SkinRig.h"

namespace tss::reporting {

/// In the order of underSkin(): the muscles and bones of a skin.
using Muscles = std::vector<std::shared_ptr<const MuscleDeformer>>;

/// What a step of a skin's motion asks of what is below it.
struct SkinAsked {
    std::vector<double> activations; ///< one each, 0 of a bone
    std::vector<Pose> poses;         ///< motion of each since rest, in the skin's frame; empty: none moves
};

/// The motion that a skin is judged along.
struct SkinAskedMotion {
    std::string inWords;
    std::vector<SkinAsked> steps;
    bool bones = false; ///< some bone moves in it
};

/// The scene's own animation, joints as it asks for them. Where nothing below the skin moves in that, all
/// activations from their lower end to their upper one and back; of a skin on bones alone, each joint value
/// from one limit to the other in turn.
SkinAskedMotion skinAskedMotion(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                int steps);

/// Whether an activation changes its shape.
bool contracts(const MuscleDeformer& muscle);
bool anyContracts(const Muscles& muscles);

/// The mean activation of those that can contract; 0 where none can.
double meanActivation(const Muscles& muscles, const std::vector<double>& activations);

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
