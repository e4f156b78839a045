#include "bake/fill/RestPlan.h"

#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/spheres/GenerateSpheres.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss {

namespace {

/// Of the smaller body's size: what is exempt at rest without touching is no farther from the other body, for
/// then contact of it would be of another feature. RegionProof has the same share and goes by its own.
constexpr double closeShare = 0.02;

/// Surfaces apart at rest: whether one has a part inside of what the other would be filled with.
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

/// Half of what spheres are kept apart by at rest: more than epsilon, and a part of what is left of the
/// clearance.
double spareOf(double clearance, const RestPlanOptions& options) {
    const double more = std::min(clearance - options.epsilon, options.tolerance);
    return (options.epsilon + more / 4) / 2;
}

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
            plan.contact = findRestContact(
                {a_, surfaceA_}, {b_, surfaceB_}, motion_, touching,
                {reach(), std::min(reach(), closest()), std::min(1.5 * options_.epsilon, closest()), 1000},
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
        if (options_.clear && plan.contact.apart > 0 && room(plan.contact.apart)) keepApart(plan);
        return plan;
    }

private:
    double reach() const { return 2.5 * options_.tolerance + options_.epsilon; }

    double closest() const { return closeShare * std::min(diagonal(a_.mesh()), diagonal(b_.mesh())); }

    double apartBy(double touching) const {
        const double distance = surfaceA_.distanceTo(surfaceB_, bToA_);
        return distance > touching ? distance : 0;
    }

    bool room(double apart) const {
        if (apart > options_.epsilon * (1 + 1e-6)) return true;
        if (options_.atRest == AtRest::Collide) return false;
        throw InputError(
            fmt::format("the meshes are {:.4g} apart at rest, and a table with --epsilon {:.4g}, both in "
                        "scene units, would report contact there: expected a smaller epsilon",
                        apart, options_.epsilon));
    }

    void keepApart(RestPlan& plan) const {
        const double spare = spareOf(plan.contact.apart, options_);
        const auto shared = [&](const MeshQuery& mesh) { return std::make_shared<const MeshQuery>(mesh); };
        RestNeighbour toB, toA;
        toB.toOther = aToB_;
        toA.toOther = bToA_;
        toB.spare = toA.spare = spare;
        toB.clearance = toA.clearance = plan.contact.apart;
        if (!plan.contact.region.empty()) {
            makeRegion(plan.a, a_, toB, plan.contact.region.a, plan.contact.nearB, spare);
            makeRegion(plan.b, b_, toA, plan.contact.region.b, plan.contact.nearA, spare);
            toB.spheres = std::make_shared<const SphereQuery>(plan.b.region.spheres);
            toA.spheres = std::make_shared<const SphereQuery>(plan.a.region.spheres);
        }
        toB.body = shared(b_.boundary());
        toA.body = shared(a_.boundary());
        plan.a.neighbour = std::make_shared<const RestNeighbour>(std::move(toB));
        plan.b.neighbour = std::make_shared<const RestNeighbour>(std::move(toA));
    }

    /// near: what of the other is not of the region and near at rest. The spheres leave it room.
    void makeRegion(RestSide& side, const Solid& solid, RestNeighbour neighbour,
                    const std::vector<SurfacePart>& parts, const TriangleMesh& near, double spare) const {
        side.protrusion = protrusionFor(options_.tolerance, magnitude(solid.mesh()));
        std::vector<Patch> region;
        for (const Patch& patch : side.patches)
            if (patch.region) region.push_back(patch);
        MedialOptions medial = options_.medial;
        if (!near.empty()) {
            neighbour.parts = std::make_shared<const MeshQuery>(near);
            // Half of what is left of their distance, where that is less.
            const double apart =
                neighbour.parts->distanceTo(MeshQuery(meshOf(solid.mesh(), parts)), neighbour.toOther);
            neighbour.beside = spare + std::min(options_.tolerance, std::max(apart - spare, 0.0)) / 2;
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
