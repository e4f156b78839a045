#include "bake/search/RestContact.h"

#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/motion/MotionBound.h"
#include "bake/search/PoseGrid.h"
#include "bake/search/SampledSearch.h"

#include <algorithm>
#include <limits>

namespace tss {

namespace {

using Parts = std::vector<SurfacePart>;

/// One body and the part of its surface that is exempt, while that grows.
struct GrowingRegion {
    GrowingRegion(const ContactSurface& own) : own(own), region(TriangleMesh{}) {}

    const ContactSurface& own;
    PartSet parts;      ///< the region
    MeshQuery region;   ///< the same for queries, as of the last renew()
    bool grown = false; ///< since the last renew()

    void join(const Parts& more) {
        for (const SurfacePart& part : more) parts.insert(part);
        grown |= !more.empty();
    }
    void renew() {
        if (std::exchange(grown, false)) region = MeshQuery(meshOf(own.mesh(), parts.merged()));
    }
    MeshQuery queryOf(const Parts& set) const { return MeshQuery(meshOf(own.mesh(), set)); }
    /// Whether a set of parts is connected with the region on the surface.
    bool touches(const MeshQuery& set) const {
        return !region.apart(set, Pose::Identity(), 1e-9 * own.solid().diagonal());
    }
};

/// What one pose adds to the regions.
struct Growth {
    bool free = true; ///< no other contact; else the joint is stopped there and the pose adds nothing
    Parts a, b;
};

class Finder {
public:
    Finder(const ContactSurface& a, const ContactSurface& b, const Motion& motion, double touching,
           const RestContactOptions& options, const Progress& progress)
        : a_(a), b_(b), motion_(motion), touching_(touching), options_(options), progress_(progress),
          poll_(progress, "contact at rest"), rest_(pose(motion, restValues(motion))) {}

    RestContact run() {
        RestContact result;
        const double distance = a_.own.surface().distanceTo(b_.own.surface(), rest_);
        if (distance > touching_) {
            result.clearance = result.apart = distance;
            return result;
        }
        seedAtRest();
        growOverGrid();
        if (!grid_.fine()) growBetweenGridPoses();
        addCloseParts();
        result.region.a = a_.parts.merged();
        result.region.b = b_.parts.merged();
        result.apart = options_.reach;
        result.nearA = leftOver(a_, b_, nearA_, rest_.inverse(), result.apart);
        result.nearB = leftOver(b_, a_, nearB_, rest_, result.apart);
        return result;
    }

private:
    Parts meeting(const GrowingRegion& side, const GrowingRegion& other, const Pose& toOther) const {
        return side.own.meeting(other.own, toOther, options_.reach,
                                options_.size > 0 ? options_.size : options_.reach / 2, side.parts, poll_);
    }

    void seedAtRest() {
        const Parts meetA = meeting(a_, b_, rest_.inverse()), meetB = meeting(b_, a_, rest_);
        nearA_ = seed(a_, b_, meetA, rest_.inverse());
        nearB_ = seed(b_, a_, meetB, rest_);
        addCloseParts();
    }

    /// Begins the region with the connected sets that touch the other body or are inside it. Returns the
    /// parts of all other sets.
    Parts seed(GrowingRegion& side, const GrowingRegion& other, const Parts& met, const Pose& toOther) const {
        Parts rest;
        for (const Parts& set : connected(side.own.mesh(), met)) {
            const MeshQuery query = side.queryOf(set);
            const bool touches = other.own.solid().boundary().apart(
                                     query, toOther, std::max({touching_, options_.near, 1e-300})) == false ||
                                 other.own.solid().inside(toOther * corners(side.own.mesh(), set[0])[0]);
            if (touches)
                side.join(set);
            else
                rest.insert(rest.end(), set.begin(), set.end());
        }
        return rest;
    }

    /// Adds the parts that are near at rest and close to the other body's region there, since spheres of the
    /// region stick out; again and again, as the regions grow by that.
    void addCloseParts() {
        for (bool more = true; more && !poll_.stopped();) {
            a_.renew();
            b_.renew();
            const Parts toA = closeTo(b_, a_, nearA_, rest_.inverse()), toB = closeTo(a_, b_, nearB_, rest_);
            a_.join(toA);
            b_.join(toB);
            more = !toA.empty() || !toB.empty();
        }
    }

    Parts closeTo(const GrowingRegion& other, const GrowingRegion& side, const Parts& near,
                  const Pose& toOther) const {
        std::vector<char> close(near.size(), 0);
        if (other.region.triangleCount() > 0)
            parallelFor(near.size(), [&](std::size_t i) {
                close[i] = !poll_.stopped() && !side.parts.contains(near[i]) &&
                           !other.region.apart(side.queryOf({near[i]}), toOther, options_.close);
            });
        Parts found;
        for (std::size_t i = 0; i < near.size(); ++i)
            if (close[i]) found.push_back(near[i]);
        return found;
    }

    /// The parts near at rest that did not become part of the region. apart: lowered to their distance from
    /// the other body.
    TriangleMesh leftOver(const GrowingRegion& side, const GrowingRegion& other, const Parts& near,
                          const Pose& toOther, double& apart) const {
        Parts left;
        for (const SurfacePart& part : near)
            if (!side.parts.contains(part)) left.push_back(part);
        const TriangleMesh mesh = meshOf(side.own.mesh(), left);
        if (!left.empty())
            apart = std::min(apart, other.own.solid().boundary().distanceTo(MeshQuery(mesh), toOther));
        return mesh;
    }

    Growth growthAt(const std::vector<double>& q) const {
        Growth growth;
        const Pose bToA = pose(motion_, q);
        growth.a = continued(a_, b_, bToA.inverse(), growth.free);
        if (growth.free) growth.b = continued(b_, a_, bToA, growth.free);
        return growth;
    }

    /// The new contact that is connected with the region. free: becomes false where there is other contact.
    Parts continued(const GrowingRegion& side, const GrowingRegion& other, const Pose& toOther,
                    bool& free) const {
        Parts joining;
        for (const Parts& set : connected(side.own.mesh(), meeting(side, other, toOther))) {
            const MeshQuery query = side.queryOf(set);
            if (side.touches(query)) {
                joining.insert(joining.end(), set.begin(), set.end());
            } else if (!other.own.surface().apart(query, toOther, touching_)) {
                free = false;
                return {};
            }
        }
        return joining;
    }

    /// Looks at poses in parallel, each against the regions as they are, then adds what they found in order.
    /// Returns for each pose whether it is free.
    std::vector<char> grow(const std::vector<std::vector<double>>& poses) {
        std::vector<Growth> grown(poses.size());
        std::vector<char> free(poses.size(), 0);
        a_.renew();
        b_.renew();
        parallelFor(poses.size(), [&](std::size_t i) { grown[i] = growthAt(poses[i]); });
        for (std::size_t i = 0; i < poses.size(); ++i) {
            free[i] = grown[i].free;
            if (!free[i]) continue;
            a_.join(grown[i].a);
            b_.join(grown[i].b);
        }
        return free;
    }

    /// From pose to pose over the grid, outwards from rest through free poses (breadth first).
    void growOverGrid() {
        grid_ = PoseGrid(motion_, b_.own.mesh(), options_.step, options_.poses);
        grow({grid_.pose(grid_.rest())});
        grid_.setFree(grid_.rest());
        std::vector<std::size_t> next = grid_.neighbours(grid_.rest());
        for (int looked = 0; !next.empty() && looked < 4 * options_.poses;) {
            if (!report(progress_, "contact at rest", grid_.share())) return;
            std::vector<std::vector<double>> poses;
            for (const std::size_t at : next) poses.push_back(grid_.pose(at));
            const std::vector<char> free = grow(poses);
            looked += static_cast<int>(poses.size());
            std::vector<std::size_t> after;
            for (std::size_t i = 0; i < next.size(); ++i)
                if (free[i]) grid_.setFree(next[i]);
            for (std::size_t i = 0; i < next.size(); ++i)
                if (free[i])
                    for (const std::size_t near : grid_.neighbours(next[i]))
                        if (!grid_.free(near)) after.push_back(near);
            sortOnce(after);
            next = std::move(after);
        }
    }

    /// At poses between those of the grid whose nearest grid pose is free.
    void growBetweenGridPoses() {
        constexpr std::size_t batch = 32; // of fixed size, so that the outcome does not depend on threads
        std::vector<std::vector<double>> poses;
        for (std::vector<double>& q : exploredPoses(motion_, static_cast<std::size_t>(options_.poses), 2))
            if (grid_.freeAround(q)) poses.push_back(std::move(q));
        for (std::size_t first = 0; first < poses.size(); first += batch) {
            if (!report(progress_, "contact at rest", double(first) / double(poses.size()))) return;
            const std::size_t end = std::min(first + batch, poses.size());
            grow({poses.begin() + first, poses.begin() + end});
        }
    }

    GrowingRegion a_, b_;
    const Motion& motion_;
    const double touching_;
    const RestContactOptions& options_;
    const Progress& progress_;
    mutable Poll poll_;
    const Pose rest_;
    PoseGrid grid_;
    Parts nearA_, nearB_; ///< near the other body at rest without touching it
};

} // namespace

RestContact findRestContact(const ContactSurface& a, const ContactSurface& b, const Motion& motion,
                            double touching, const RestContactOptions& options, const Progress& progress) {
    return Finder(a, b, motion, touching, options, progress).run();
}

double touchingDistance(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion) {
    const std::vector<double> rest = restValues(motion);
    const Pose bToA = pose(motion, rest);
    double size = bToA.translation().norm(), smaller = std::numeric_limits<double>::infinity();
    for (const TriangleMesh* mesh : {&a, &b}) {
        const Eigen::AlignedBox3d box = bounds(*mesh);
        size += box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
        smaller = std::min(smaller, box.diagonal().norm());
    }
    // Doubles round the placement; files hold points as floats.
    return 1e-12 * size + 0x1p-22 * smaller;
}

} // namespace tss
