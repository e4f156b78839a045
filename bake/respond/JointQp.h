#pragma once
#include "bake/motion/MotionFrame.h"

namespace tss {

using JointValues = DofValues;

/// One linear demand: normal . y >= bound, the normal of unit length.
struct QpRow {
    JointValues normal;
    double bound = 0;
};

/// The point nearest to the origin that meets every row: the dual active-set method of Goldfarb and Idnani
/// (Mathematical Programming 27, 1983) for an identity Hessian. n <= maxDofs unknowns; a row counts as
/// met within `tolerance`. Returns false where no point meets them all; y is then of no use. Allocates
/// nothing.
bool nearestToOrigin(int n, const QpRow* rows, int rowCount, double tolerance, JointValues& y);

} // namespace tss
