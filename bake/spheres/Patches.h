#pragma once
#include "bake/base/Error.h"
#include "bake/base/Progress.h"
#include "bake/geometry/Solid.h"
#include "bake/geometry/SurfacePart.h"
#include "bake/spheres/RestNeighbour.h"
#include "bake/spheres/SphereSet.h"

#include <array>
#include <span>

namespace tss {

/// A piece of a triangle, the element that spheres must cover: a sphere that contains its three corners
/// contains all of it.
struct Patch {
    Corners corners;
    Vec3 normal;         ///< unit length, that of its triangle; some one where that has no area
    bool region = false; ///< of what overlaps at rest (METHOD 2.4)

    Vec3 centre() const { return (corners[0] + corners[1] + corners[2]) / 3; }
    double radius() const; ///< largest distance of a corner from the centre
    double area() const;
};

/// Cuts the longest edge in half.
std::array<Patch, 2> halves(const Patch& patch);

/// The triangles of a mesh as patches, those without an area too: segments and points of surface.
std::vector<Patch> patchesOf(const TriangleMesh& mesh);

/// Of the patches' centres.
Bvh treeOfCentres(std::span<const Patch> patches);

/// Contains all three corners, with a little to spare for rounding.
bool covers(const Sphere& sphere, const Patch& patch);

/// How candidate spheres are found for patches (METHOD 1.3).
struct PatchOptions {
    double protrusion = 0;                    ///< P, scene units, > 0
    std::size_t mostPatches = 0;              ///< more are refused: they would take gigabytes
    const RestNeighbour* neighbour = nullptr; ///< what the spheres must stay clear of, or null
    double slackFactor = 0.02;                ///< tau / P; above 0.1 it takes many more spheres
    double sizeFactor = 0.4; ///< k: a patch is split until its radius is at most k sqrt(2 R P)
};

/// The protrusion asks for more patches than can be had, or is too small beside the coordinates for doubles.
class TooFine : public InputError {
public:
    using InputError::InputError;
};

/// It is the other body at rest that asks for so many.
class RestTooClose : public TooFine {
public:
    using TooFine::TooFine;
};

/// Patches fine enough, each with the sphere found from its own centre, which covers it.
struct FittedPatches {
    std::vector<Patch> patches;
    SphereSet candidates;      ///< one per patch
    std::vector<double> inner; ///< for each the radius of the ball about its centre that is inside
};

/// Splits the patches until the sphere of each covers it and the patch is small beside the sphere.
/// Ends for every input: a patch smaller than (1 - tau/P) P is covered by its sphere whatever that is (P
/// being what it may stick out there, where a neighbour is near). Throws TooFine, and InputError when it is
/// stopped through progress: a part of the patches is of no use.
FittedPatches fitPatches(const Solid& solid, std::span<const Patch> patches, const PatchOptions& options,
                         const Progress& progress = {});

/// The same, but a patch that some candidates of others cover gets none of its own: its candidate has no
/// radius, and the ball inside one of -infinity. Much quicker for many small triangles beside a coarse
/// protrusion, and the choice among fewer candidates is hardly worse.
FittedPatches fitPatchesSparsely(const Solid& solid, std::span<const Patch> patches,
                                 const PatchOptions& options, const Progress& progress = {});

} // namespace tss
