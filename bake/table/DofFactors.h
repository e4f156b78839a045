#pragma once
#include "bake/motion/MotionFrame.h"
#include "bake/table/SinVersin.h"

namespace tss {

/// What a pose is a polynomial of, per DOF, about the middle of its limits, d = q - middle:
/// {1, sin d, 1 - cos d} of a turn, {1, d, d^2} of a slide. Small where the motion is small, so that sums of
/// them lose nothing. Not for paths.
struct DofFactor {
    double middle = 0;
    bool turn = false;

    void evaluate(double q, double& first, double& second) const {
        const double d = q - middle;
        if (turn) {
            sinVersin(d, first, second);
        } else {
            first = d;
            second = d * d;
        }
    }
};

inline DofFactor dofFactor(const Dof& dof) {
    return {dof.lower + 0.5 * (dof.upper - dof.lower), dof.kind == DofKind::Rotation};
}

} // namespace tss
