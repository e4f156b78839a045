#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/Solid.h"
#include "bake/spheres/SphereOptions.h"
#include "bake/spheres/SphereSet.h"

namespace tss {

/// The spheres and what is proven of them.
struct SphereFit {
    SphereSet spheres;
    double protrusion =
        0; ///< no point of a sphere is farther from the body (METHOD 1.5); infinity: not bounded here
    double coverage = 0; ///< no point of the surface is farther from the union; infinity: not bounded here
    bool hollow = false; ///< the body was taken for its surface alone
    std::vector<char> region{}; ///< a sphere: whether it stands for what overlaps at rest; empty: none does
    double enclosed = 0; ///< the other body never stands inside with the surfaces farther apart than this;
                         ///< infinity: not shown
    std::string note{};  ///< what was assumed of the mesh and what could not be reached; empty: nothing
};

/// One more note, after a semicolon.
void addNote(SphereFit& fit, const std::string& note);

/// Throws InputError for options out of range, as fitSpheres() does.
void checkOptions(const SphereOptions& options);

/// Fills a body with spheres by the method of the options. The mesh may be open, inside out, non-manifold or
/// a soup of triangles: the note says what was assumed (see Solid). The same spheres for any number of
/// threads. Stopped through `progress`, the result is still conservative, with more spheres than need be.
/// Throws InputError for a mesh that cannot be used (see cleaned()) and for options out of range.
SphereFit fitSpheres(const TriangleMesh& mesh, const SphereOptions& options, const Progress& progress = {});

/// P, the protrusion to build with for a tolerance L on a body with coordinates up to `magnitude`: less than
/// L by what rounding the spheres to float may add.
double protrusionFor(double tolerance, double magnitude);

/// The largest coordinate of the mesh, by absolute value.
double magnitude(const TriangleMesh& mesh);

} // namespace tss
