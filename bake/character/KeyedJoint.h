#pragma once
#include "bake/model/SceneModel.h"

#include <vector>

namespace tss {

/// By how much more than the range of its keys a bone's joint may move, as a share of that range, at each
/// end: animations that are blended go a little beyond either.
inline constexpr double keysSlack = 0.05;

/// Turns of less than this (radians, from the mean of all keys) are no degree of freedom: what keys are
/// rounded by.
inline constexpr double keysStill = 1e-3;

/// Where a bone stands in its parent at the keys of its animations, and where it is bound.
struct KeyedPoses {
    struct Sample {
        Pose pose;
        bool first; ///< of a run: the angles before are another animation's
    };
    std::vector<Sample> samples; ///< at least one
    std::size_t rest = 0;        ///< which of them is where the joint rests
    double still = keysStill;    ///< turns of less are none
    double size = 0;             ///< length that the digits of the keys are of
    bool anyTurn = false; ///< turns that are no three angles of less than 80 degrees in the middle, too
};

/// The joint whose DOFs are the axes that the keys use.
struct KeyedJoint {
    Joint joint;                             ///< without a path, bodies and drives
    std::vector<std::vector<double>> values; ///< #DOFs of #samples
    double off = 0; ///< the largest difference of an entry of a sample's rotation and the joint's there
};

/// As few DOFs as serve: "slide.x" ... "slide.z", then one "turn", or "turn1" to "turn3" about the axes that
/// the keys turn about most; slides shorter than 1e-4 of the size are none. Limits are the range of the keys
/// and keysSlack. A joint without DOFs is a bone that stands, where its frame0 is. Throws InputError with the
/// reason for keys that turn too far about several axes, unless any turn is asked for.
KeyedJoint keyedJoint(const KeyedPoses& poses);

} // namespace tss
