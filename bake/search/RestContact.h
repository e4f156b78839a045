#pragma once
#include "bake/base/Progress.h"
#include "bake/search/ContactParts.h"
#include "bake/table/Table.h"

namespace tss {

/// How two meshes lie to each other where the joint rests, and what is excepted of them (METHOD 2.4).
struct RestContact {
    double clearance = 0; ///< the surfaces are this far apart at rest, scene units; 0: they touch or overlap
    RestRegion region;    ///< where they touch or overlap; empty where they are apart. No depth yet

    /// What is near the other body at rest and not of the region: at most `reach` and at least `apart` away.
    TriangleMesh nearA, nearB;
    double apart = 0; ///< > 0, scene units
};

struct RestContactOptions {
    double reach = 0; ///< surfaces this near to each other count as touching where contact goes on, > 0
    double close = 0; ///< what is this near to the other's region at rest is of the region too, though it
                      ///< touches nothing, >= 0
    double near = 0;  ///< where surfaces touch at all, others this near at rest count as touching too, >= 0
    double step = 0;  ///< no point of B moves farther than this from one pose that is looked at to the next,
                      ///< > 0, scene units; as far as `poses` allow
    int poses = 1000; ///< of Q that are looked at, about; twice as many where these are not enough for `step`
    double size = 0;  ///< parts of this radius are cut no further, scene units; 0: half of `reach`
};

/// Decides by the surfaces. Apart: no region. Otherwise the region is what is inside the other body or within
/// reach of it at rest, as far as it hangs together with what touches there; so no connected piece of it is
/// farther from the other body at rest than `close` or `near` allow. Then it is grown along the
/// motion, from pose to pose over a grid of Q outwards from rest, and over poses between where the grid is
/// coarse: contact that hangs together with the region is the same contact carried on and joins it; where any
/// other is met the joint is stopped and goes no farther. The same for any number of threads; stopped, the
/// region is smaller. touching: surfaces no farther apart than this touch, for coordinates are rounded.
RestContact findRestContact(const ContactSurface& a, const ContactSurface& b, const Motion& motion,
                            double touching, const RestContactOptions& options,
                            const Progress& progress = {});

/// Up to which distance rounding lets surfaces be apart that are meant to touch.
double touchingDistance(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

} // namespace tss
