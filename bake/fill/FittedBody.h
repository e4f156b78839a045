#pragma once
#include "bake/fill/ContactZoneFit.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/search/UndecidedCells.h"
#include "bake/spheres/SphereMethods.h"

namespace tss {

/// One of the two bodies of a contact zone, level by level.
struct FittedBody {
    FittedBody(const TriangleMesh& mesh, bool hollow)
        : solid(cleaned(mesh), hollow ? Interior::Hollow : Interior::Filled), surface(solid.mesh()),
          magnitude(tss::magnitude(solid.mesh())) {}

    Solid solid;
    MeshQuery surface;       ///< without closing fans: contact is of the mesh itself
    double magnitude;        ///< largest coordinate, scene units
    std::vector<Patch> zone; ///< surface within reach, without the region that overlaps at rest
    RestSide rest;

    /// The spheres of a level; what fit() falls back on when a finer level takes too many.
    struct Spheres {
        MedialSet fitted;      ///< to the zone, on this level
        double protrusion = 0; ///< of all spheres of the level, scene units
        SphereSet coarse;      ///< inscribed balls of the levels before
    };
    Spheres spheres;

    WholeFits* kept = nullptr; ///< where spheres of all of the body are kept, or null
    std::string path;          ///< prim path of the body, by which they are

    void begin(RestSide side) {
        rest = std::move(side);
        spheres.protrusion = rest.protrusion;
        for (const Patch& patch : rest.patches)
            if (!patch.region) zone.push_back(patch);
    }
    void fit(double tolerance, MedialOptions medial, const Progress& progress) {
        const double own = protrusionFor(tolerance, magnitude);
        const bool alone = zone.size() == rest.patches.size() &&
                           !(rest.neighbour && rest.neighbour->binds(own)); // the same beside any other body
        if (kept && alone) {
            spheres.fitted = kept->spheres(path, solid, own, medial, progress);
        } else {
            medial.neighbour = rest.neighbour;
            spheres.fitted = medialSpheres(solid, zone, own, medial, progress);
        }
        spheres.protrusion = std::max(own, rest.protrusion);
    }
    std::size_t count() const { return spheres.fitted.spheres.size() + rest.region.spheres.size(); }
    LevelSpheres level() const {
        const MedialSet& fitted = spheres.fitted;
        LevelSpheres level{fitted.spheres, fitted.inner, std::vector<char>(fitted.spheres.size(), 0)};
        const MedialSet& region = rest.region;
        level.spheres.insert(level.spheres.end(), region.spheres.begin(), region.spheres.end());
        level.inner.insert(level.inner.end(), region.inner.begin(), region.inner.end());
        level.region.resize(level.spheres.size(), 1);
        return level;
    }
    SphereSet allSpheres() const {
        SphereSet all = level().spheres;
        all.insert(all.end(), spheres.coarse.begin(), spheres.coarse.end());
        return all;
    }
    /// Keeps the inscribed balls of the level, which show contact where finer spheres are not looked for.
    void keepInscribed() {
        const SphereSet inner = inscribed(spheres.fitted);
        spheres.coarse.insert(spheres.coarse.end(), inner.begin(), inner.end());
    }
    ContactZoneBody result(const ContactZoneOptions& options) const {
        ContactZoneBody body;
        const LevelSpheres finest = level();
        body.fit.spheres = options.conservative ? finest.spheres : inscribed({finest.spheres, finest.inner});
        body.fit.protrusion = options.conservative ? spheres.protrusion : 0;
        body.fit.coverage = options.conservative ? 0 : spheres.protrusion;
        body.fit.note = solid.assumptions();
        body.fit.hollow = solid.hollow();
        body.fine = body.fit.spheres.size();
        body.neighbour = rest.neighbour;
        body.zone = zone;
        for (const Patch& patch : rest.patches)
            if (patch.region) body.zone.push_back(patch);
        body.fit.spheres.insert(body.fit.spheres.end(), spheres.coarse.begin(), spheres.coarse.end());
        if (rest.region.spheres.empty()) return body;
        body.fit.region = finest.region;
        body.fit.region.resize(body.fit.spheres.size(), 0);
        return body;
    }
};

} // namespace tss
