#pragma once
#include "bake/robot/LeftOut.h"
#include "bake/robot/Robot.h"

#include <functional>

namespace tss {

/// A rigged character, whatever its format: bones, what animations make of them, and the meshes that follow
/// them by weights. All places are in the world of a robot, lengths in its units.
struct Character {
    struct Bone {
        std::string name;       ///< of its link; no other link has it
        int parent = -1;        ///< a bone before it; -1: none
        Eigen::Affine3d bound;  ///< where the meshes are bound to it
        Eigen::Affine3d stands; ///< where it is without an animation
    };
    struct Run {
        std::vector<double> times;                        ///< time codes, strictly rising
        std::vector<std::vector<Eigen::Affine3d>> places; ///< #times of #bones
    };
    struct Mesh {
        std::string name;                                         ///< of its skin; no link has it
        TriangleMesh surface;                                     ///< as it is bound
        std::vector<std::vector<std::pair<int, double>>> weights; ///< #V, of bones; none: the first bone's
        std::optional<Vec3> color;                                ///< linear RGB
        bool visible = true;
    };

    std::string name;        ///< for notes
    std::vector<Bone> bones; ///< at least one
    std::vector<Run> runs;   ///< one an animation
    std::vector<Mesh> meshes;
};

/// Places of all bones at a time.
using PlacesAt = std::function<std::vector<Eigen::Affine3d>(double time)>;

/// The places at these times, and at as many between them that no bone turns by more than 5 degrees in its
/// parent from one to the next.
Character::Run sampledRun(const Character& character, const std::vector<double>& keys,
                          const PlacesAt& placesAt);

/// Adds a link a bone, whose joint moves it as its keys do (keyedJoint()), against its parent or, where it
/// has none, against `world` (-1: the world itself); all rest as they are bound. A bone that no key moves is
/// fixed to its parent, and what its weights hold is the parent's. The body of a link is what its weights
/// hold most of the meshes (cutByWeights()); it is not drawn, the meshes are, as skins. Bones that follow one
/// another are in no pair (Robot::seams). The robot's motion are the animations, one a second after the
/// other. What is left out of it is noted by name.
void addCharacter(Robot& robot, const Character& character, int world, LeftOut& leftOut);

} // namespace tss
