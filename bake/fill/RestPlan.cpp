#include "bake/fill/RestPlan.h"

#include "bake/base/Error.h"
#include "bake/spheres/GenerateSpheres.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss {

namespace {

/// Share of the smaller body's diagonal: surface that is exempt at rest without touching is no farther from
/// the other body than this, since farther surface belongs to another contact. RegionProof checks the same
/// share with a constant of its own.
constexpr double closeShare = 0.02;

/// For surfaces apart at rest: whether `mesh` has a part inside the other body, its openings closed.
bool enters(const MeshQuery& surface, const TriangleMesh& mesh, const Solid& other, const Pose& toOther,
            double touching) {
    if (other.hollow()) return false;
    if (other.open() && other.boundary().distanceTo(surface, toOther, 2 * touching) <= touching) return true;
    const Eigen::AlignedBox3d box = bounds(other.mesh());
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vec3& vertex) {
        const Vec3 x = toOther * vertex;
        return box.contains(x) && other.inside(x);
    });
}

/// Half of the gap that spheres must have at rest: epsilon and a quarter of what is left of the clearance, of
/// no more than the tolerance.
double halfGapOf(double clearance, const RestPlanOptions& options) {
    const double more = std::min(clearance - options.epsilon, options.tolerance);
    return (options.epsilon + more / 4) / 2;
}

/// The patches of a mesh, halved so that each is either in the region or outside it.
std::vector<Patch> patchesWith(const TriangleMesh& mesh, const std::vector<SurfacePart>& region) {
    const std::vector<Patch> whole = patchesOf(mesh);
    if (region.empty()) return whole;
    PartSet parts;
    for (const SurfacePart& part : region) parts.insert(part);
    std::vector<Patch> patches;
    const auto add = [&](const auto& self, const Patch& patch, SurfacePart part) -> void {
        if (!parts.reaches(part) || parts.contains(part)) {
            patches.push_back(patch);
            patches.back().region = parts.contains(part);
            return;
        }
        const std::array<Patch, 2> both = halves(patch);
        for (int k = 0; k < 2; ++k) self(self, both[k], halves(part)[k]);
    };
    std::size_t next = 0; // triangles without an area have no patch
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (next < whole.size() && corners(mesh, {t, 1}) == whole[next].corners)
            add(add, whole[next++], {t, 1});
    return patches;
}

class Planner {
public:
    Planner(const Solid& a, const MeshQuery& surfaceA, const Solid& b, const MeshQuery& surfaceB,
            const Motion& motion, const RestPlanOptions& options, const Progress& progress)
        : a_(a), b_(b), surfaceA_(surfaceA), surfaceB_(surfaceB), motion_(motion), options_(options),
          progress_(progress), bToA_(pose(motion, restValues(motion))), aToB_(bToA_.inverse()) {}

    RestPlan run() {
        RestPlan plan;
        const double touching = touchingDistance(a_.mesh(), b_.mesh(), motion_);
        if (options_.atRest == AtRest::Collide)
            plan.contact.clearance = apartBy(touching);
        else
            plan.contact = findRestContact({a_, surfaceA_}, {b_, surfaceB_}, motion_, touching,
                                           {reach(), std::min(reach(), mostExemptDistance()),
                                            std::min(1.5 * options_.epsilon, mostExemptDistance()), step()},
                                           progress_);
        if (plan.contact.clearance > 0) {
            plan.entered = {enters(surfaceB_, b_.mesh(), a_, bToA_, touching),
                            enters(surfaceA_, a_.mesh(), b_, aToB_, touching)};
            if (plan.entered) return plan;
            // What closes the openings is body too.
            plan.contact.apart = a_.boundary().distanceTo(b_.boundary(), bToA_);
        }
        plan.a.patches = patchesWith(a_.mesh(), plan.contact.region.a);
        plan.b.patches = patchesWith(b_.mesh(), plan.contact.region.b);
        if (options_.clear && plan.contact.apart > 0 && leavesRoom(plan.contact.apart)) keepApart(plan);
        return plan;
    }

private:
    double reach() const { return 2.5 * options_.tolerance + options_.epsilon; }

    /// Spheres of both bodies stick out by two tolerances together and have a gap of epsilon. Of surfaces
    /// that come as near as that some are within reach() at a pose no more than half a step away.
    double step() const { return options_.tolerance; }

    double mostExemptDistance() const {
        return closeShare * std::min(diagonal(a_.mesh()), diagonal(b_.mesh()));
    }

    double apartBy(double touching) const {
        const double distance = surfaceA_.distanceTo(surfaceB_, bToA_);
        return distance > touching ? distance : 0;
    }

    /// Whether a table with epsilon can tell the bodies apart at rest. Throws where it must.
    bool leavesRoom(double apart) const {
        if (apart > options_.epsilon * (1 + 1e-6)) return true;
        if (options_.atRest == AtRest::Collide) return false;
        throw InputError(
            fmt::format("the meshes are {:.4g} apart at rest, and a table with --epsilon {:.4g}, both in "
                        "scene units, would report contact there: expected a smaller epsilon",
                        apart, options_.epsilon));
    }

    void keepApart(RestPlan& plan) const {
        const double halfGap = halfGapOf(plan.contact.apart, options_);
        const auto shared = [&](const MeshQuery& mesh) { return std::make_shared<const MeshQuery>(mesh); };
        RestNeighbour toB, toA;
        toB.toOther = aToB_;
        toA.toOther = bToA_;
        toB.halfGap = toA.halfGap = halfGap;
        toB.clearance = toA.clearance = plan.contact.apart;
        if (!plan.contact.region.empty()) {
            makeRegion(plan.a, a_, toB, plan.contact.region.a, plan.contact.nearB, halfGap);
            makeRegion(plan.b, b_, toA, plan.contact.region.b, plan.contact.nearA, halfGap);
            toB.spheres = std::make_shared<const SphereQuery>(plan.b.region.spheres);
            toA.spheres = std::make_shared<const SphereQuery>(plan.a.region.spheres);
        }
        toB.body = shared(b_.boundary());
        toA.body = shared(a_.boundary());
        plan.a.neighbour = std::make_shared<const RestNeighbour>(std::move(toB));
        plan.b.neighbour = std::make_shared<const RestNeighbour>(std::move(toA));
    }

    /// Fills the region of one body. near: the other body's surface that is near at rest and not in the
    /// region; the spheres keep clear of it.
    void makeRegion(RestSide& side, const Solid& solid, RestNeighbour neighbour,
                    const std::vector<SurfacePart>& parts, const TriangleMesh& near, double halfGap) const {
        side.protrusion = protrusionFor(options_.tolerance, magnitude(solid.mesh()));
        std::vector<Patch> region;
        for (const Patch& patch : side.patches)
            if (patch.region) region.push_back(patch);
        MedialOptions medial = options_.medial;
        if (!near.empty()) {
            neighbour.parts = std::make_shared<const MeshQuery>(near);
            // Sticking out by at most half of what is left of their distance.
            const double apart =
                neighbour.parts->distanceTo(MeshQuery(meshOf(solid.mesh(), parts)), neighbour.toOther);
            neighbour.partGap = halfGap + std::min(options_.tolerance, std::max(apart - halfGap, 0.0)) / 2;
            medial.neighbour = std::make_shared<const RestNeighbour>(std::move(neighbour));
        }
        side.region = medialSpheres(solid, region, side.protrusion, medial, progress_);
    }

    const Solid &a_, &b_;
    const MeshQuery &surfaceA_, &surfaceB_;
    const Motion& motion_;
    const RestPlanOptions& options_;
    const Progress& progress_;
    const Pose bToA_, aToB_;
};

} // namespace

RestPlan planRest(const Solid& a, const MeshQuery& surfaceA, const Solid& b, const MeshQuery& surfaceB,
                  const Motion& motion, const RestPlanOptions& options, const Progress& progress) {
    return Planner(a, surfaceA, b, surfaceB, motion, options, progress).run();
}

} // namespace tss
