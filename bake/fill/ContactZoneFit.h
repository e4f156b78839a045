#pragma once
#include "bake/base/Progress.h"
#include "bake/fill/NestedBodies.h"
#include "bake/fill/RestPlan.h"
#include "bake/fill/WholeFits.h"
#include "bake/motion/Motion.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/Patches.h"

#include <optional>

namespace tss {

/// How two bodies are filled where they can meet (METHOD 1.4).
struct ContactZoneOptions {
    double tolerance = 0; ///< L, scene units: the conservative spheres stick out at most this far; 0: 1/500
                          ///< of the smaller diagonal
    double margin = 0;    ///< contact is wanted to this distance, scene units, >= 0
    double depth = 0;     ///< gap-true tables: poses in a contact less deep than this are refined too, >= 0
    double epsilon = 0;   ///< of the table: at rest spheres are kept farther apart than that, >= 0
    AtRest atRest = AtRest::Offset;
    int maxSpheres = 0; ///< > 0: of each body; the finest level that takes no more is used. Where the region
                        ///< that overlaps at rest takes more than half of it, twice what the region takes
    bool conservative = true; ///< false: all spheres are inscribed, and the zone is covered to the tolerance
    bool whole =
        false; ///< fill all of both surfaces to the tolerance, without looking for what can meet in Q
    /// The result of findNested() for this tolerance or a finer one, where it is known: it also holds for
    /// coarser ones.
    std::optional<Nesting> nesting = {};
    bool solid = false; ///< openings count as closed whether or not the other body stands behind them
    double effort = 1;  ///< share of the usual limit of work for finding what comes near, in (0, 1]
    MedialOptions medial;
    std::shared_ptr<WholeFits> kept; ///< spheres of whole bodies; null: none are kept
    std::string pathA, pathB;        ///< prim paths of the bodies, by which they are
};

/// One body's share.
struct ContactZoneBody {
    SphereFit fit;           ///< protrusion of all spheres; coverage of the zone
    std::vector<Patch> zone; ///< the surface that the finest spheres cover, in the body's frame
    std::size_t fine = 0;    ///< number of spheres of the finest level, which come first; the others are
                             ///< inscribed balls of coarser levels
    std::shared_ptr<const RestNeighbour> neighbour; ///< what the spheres stay clear of at rest, or null
};

/// What one level did, for people and for tests.
struct ContactZoneLevel {
    double tolerance = 0;
    std::size_t spheresA = 0, spheresB = 0; ///< fitted on this level
    double areaA = 0, areaB = 0;            ///< of the zones
    std::size_t undecided = 0;              ///< cells of Q left after it
};

struct ContactZoneFit {
    ContactZoneBody a, b;
    std::vector<ContactZoneLevel> levels;
    bool neverMeet = false; ///< proven: the surfaces stay farther apart than the margin at every pose of Q,
                            ///< but for the region
    RestContact rest;       ///< of the cleaned meshes
};

/// Spheres for two bodies in one motion, fine only where the verdict needs it. Level by level, the tolerance
/// halved: fit spheres to the surface within reach of the other body over the poses still undecided; drop the
/// poses at which an inscribed pair fires or no conservative pair touches; go on with the rest. At the end,
/// for every pose of Q: where the meshes touch, some pair of spheres does (true contact is never missed), and
/// where a pair does, the meshes are at most 2 L apart or one reaches into the other. Surfaces out of reach
/// have no spheres: what is inside the other body from the beginning, surfaces apart, is not contact. Meshes
/// that never meet get the spheres that show it, or none when the surfaces alone do. Where the joint rests,
/// the spheres are apart wherever the meshes are (see RestPlan). Stopped through progress, the result is that
/// of the level reached and the note says so. Throws InputError where there is no level yet, and for a mesh
/// that cannot be used.
ContactZoneFit fitContactZone(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                              const ContactZoneOptions& options, const Progress& progress = {});

} // namespace tss
