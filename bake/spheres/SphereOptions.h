#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>

namespace tss {

struct RestNeighbour;

/// The generators of METHOD 1.
enum class SphereMethod {
    Medial,    ///< 1.3: balls inside the body, few, coverage by construction (the default)
    Shrinking, ///< 1.3: one plain shrinking ball a triangle, none left out
    Surface,   ///< 1.2 [paper]: one sphere per vertex
    Growth,    ///< 1.1 [paper]: growth from triangle centroids into the body
};

/// How finely the medial and shrinking generators work (METHOD 1.3).
struct MedialOptions {
    std::size_t mostPatches = 10'000'000;           ///< a finer tolerance is refused: it would take gigabytes
    std::shared_ptr<const RestNeighbour> neighbour; ///< what the spheres must stay clear of at rest, or null
};

/// For trials of whether `limit` spheres suffice: a tolerance that takes far more patches needs no look.
inline MedialOptions forTrial(MedialOptions options, std::size_t limit) {
    options.mostPatches = std::min(options.mostPatches, 100'000 + 200 * limit);
    return options;
}

/// Every parameter of the paper's growth (METHOD 1.1), with the paper's values.
struct GrowthOptions {
    double start = 0.01;     ///< T_min: where the growth along a line begins
    double step = 0.01;      ///< delta t
    double end = 0.101;      ///< T_max: where it ends
    double maxRadius = 0.02; ///< the threshold radius
    bool relative = true;    ///< the four above are fractions of the bounding diagonal, else scene units
};

/// What spheres are asked for.
struct SphereOptions {
    SphereMethod method = SphereMethod::Medial;
    double tolerance =
        0; ///< L, scene units: the spheres stick out of the body at most this far; 0: diagonal/400
    int maxSpheres = 0;       ///< > 0: the best tolerance for at most so many, not finer than `tolerance`
    bool hollow = false;      ///< the body is its surface alone (Interior::Hollow; medial and shrinking)
    bool conservative = true; ///< the union contains the surface; else the spheres are inside the body
                              ///< (medial and shrinking; METHOD 1.6)
    MedialOptions medial;
    GrowthOptions growth;
};

} // namespace tss
