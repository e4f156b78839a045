#include "bake/fill/ContactZoneFit.h"

#include "bake/base/Error.h"
#include "bake/fill/FittedBody.h"
#include "bake/fill/HollowBodies.h"
#include "bake/search/NearSurface.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace tss {

namespace {

double area(std::span<const Patch> patches) {
    double sum = 0;
    for (const Patch& patch : patches) sum += patch.area();
    return sum;
}

/// The tolerances of the levels, coarse to fine, each half of the one before, from about 1/400 of the
/// diagonal.
std::vector<double> levelTolerances(double finest, double diagonal) {
    std::vector<double> levels{finest};
    while (2 * levels.back() < diagonal / 300) levels.push_back(2 * levels.back());
    std::reverse(levels.begin(), levels.end());
    return levels;
}

class Refiner {
public:
    Refiner(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
            const ContactZoneOptions& options, const HollowBodies& hollow, bool clearAtRest,
            const Progress& progress)
        : a_(a, hollow.a), b_(b, hollow.b), motion_(motion), options_(options), progress_(progress),
          cells_(wholeQ(motion)), clearAtRest_(clearAtRest), whole_(options.whole) {
        if (!whole_) return;
        a_.kept = b_.kept = options.kept.get();
        a_.path = options.pathA;
        b_.path = options.pathB;
    }

    /// The result is not to be used where entered() says that a body is hollow after all.
    ContactZoneFit run() {
        const double smaller = std::min(a_.solid.diagonal(), b_.solid.diagonal());
        const double finest = options_.tolerance > 0 ? options_.tolerance : smaller / 500;
        if (!begin(finest)) return {};
        std::vector<double> levels = whole_ ? std::vector{finest} : levelTolerances(finest, smaller);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            if (!narrow(levels[i])) break;
            if (i == 0) levels = coarsened(std::move(levels));
            // Finer levels have no use: none is asked for, or no tolerance changes the number of spheres.
            if (whole_ || restDecides_) levels.resize(1);
            if (!fit(levels[i])) {
                if (i > 0 && note_.empty()) fitBetween(levels[i - 1], levels[i]);
                break;
            }
            if ((entered_ = entered(2 * levels[i]))) return {};
            if (!decide(levels[i], i + 1 == levels.size())) break;
        }
        if (!decided_ && note_.empty() && result_.levels.back().tolerance > finest * (1 + 1e-9))
            note_ = fmt::format("tolerance {:.4g} instead of {:.4g} scene units: {} spheres do not suffice",
                                result_.levels.back().tolerance, finest, options_.maxSpheres);
        result_.a = a_.result(options_);
        result_.b = b_.result(options_);
        noteMore(result_.a, a_);
        noteMore(result_.b, b_);
        for (ContactZoneBody* body : {&result_.a, &result_.b}) addNote(body->fit, note_);
        return std::move(result_);
    }

    const HollowBodies& entered() const { return entered_; }

private:
    /// Looks at the pose at rest. False: a body is hollow after all.
    bool begin(double tolerance) {
        RestPlan plan = planRest(
            a_.solid, a_.surface, b_.solid, b_.surface, motion_,
            {tolerance, options_.epsilon, options_.atRest, clearAtRest_, options_.medial}, progress_);
        if ((entered_ = plan.entered)) return false;
        a_.begin(std::move(plan.a));
        b_.begin(std::move(plan.b));
        result_.rest = std::move(plan.contact);
        return true;
    }

    HollowBodies entered(double reach) const {
        if (options_.solid || (!a_.solid.open() && !b_.solid.open())) return {};
        const SphereSet a = a_.allSpheres(), b = b_.allSpheres();
        return findHollow({a_.solid, a_.surface, a, a_.spheres.protrusion},
                          {b_.solid, b_.surface, b, b_.spheres.protrusion}, motion_, reach, progress_);
    }

    /// Reduces the zones to the surface within reach at the poses still undecided. False: there is none.
    bool narrow(double tolerance) {
        if (whole_) return true;
        std::vector<Patch> zoneA = findNearSurface(a_.zone, Side::A, b_.surface, motion_, cells_, tolerance,
                                                   options_.margin, options_.effort, progress_);
        std::vector<Patch> zoneB = findNearSurface(b_.zone, Side::B, a_.surface, motion_, cells_, tolerance,
                                                   options_.margin, options_.effort, progress_);
        const bool region = !result_.rest.region.empty(); // then either zone may meet the other's region
        if (region ? zoneA.empty() && zoneB.empty() : zoneA.empty() || zoneB.empty()) {
            // The poses left are free; what was decided before stays with the inscribed spheres.
            result_.neverMeet = !hits_;
            // Spheres of the level before may still touch there: this level's spheres of the same zones show
            // that nothing does.
            if (!hits_ && !result_.levels.empty()) return true;
            decided_ = true;
            finish(std::move(zoneA), std::move(zoneB));
            return false;
        }
        a_.zone = std::move(zoneA);
        b_.zone = std::move(zoneB);
        return true;
    }

    /// Leaves the inscribed balls alone.
    void finish(std::vector<Patch> zoneA, std::vector<Patch> zoneB) {
        for (FittedBody* body : {&a_, &b_}) {
            body->keepInscribed();
            body->spheres.fitted = {};
        }
        a_.zone = std::move(zoneA);
        b_.zone = std::move(zoneB);
    }

    /// Why there are more spheres than were asked for.
    void noteMore(ContactZoneBody& made, const FittedBody& body) const {
        const std::size_t region = body.rest.region.spheres.size(), asked = options_.maxSpheres;
        if (asked == 0 || made.fit.spheres.size() <= asked) return;
        if (2 * region > asked)
            addNote(made.fit,
                    fmt::format("what overlaps at rest takes {} spheres, and the rest as many: more "
                                "than the {} asked for",
                                region, asked));
        else if (body.rest.neighbour)
            addNote(made.fit,
                    fmt::format("the surfaces are {:.4g} scene units apart at rest: spheres that are "
                                "apart there too are more than the {} asked for",
                                body.rest.neighbour->clearance, asked));
    }

    /// How many spheres a body may take. The region that overlaps at rest takes the same spheres on every
    /// level; where these are more than half of the limit, the zone may take as many again.
    std::size_t mostSpheres(const FittedBody& body) const {
        return std::max(static_cast<std::size_t>(options_.maxSpheres), 2 * body.rest.region.spheres.size());
    }

    /// The number of spheres at a tolerance over the number allowed, of the body where that is larger;
    /// infinity where far too many patches would be needed.
    double excess(double tolerance) {
        try {
            for (FittedBody* body : {&a_, &b_})
                body->fit(tolerance, forTrial(options_.medial, mostSpheres(*body)), progress_);
        } catch (const RestTooClose& error) { // which no tolerance changes
            throw RestTooClose(
                fmt::format("{}, or no limit of {} spheres", error.message, options_.maxSpheres));
        } catch (const TooFine&) {
            return std::numeric_limits<double>::infinity();
        }
        const auto share = [&](const FittedBody& body) {
            return double(body.count()) / double(mostSpheres(body));
        };
        return std::max(share(a_), share(b_));
    }

    /// The levels with coarser ones put before them, until no body takes too many spheres on the first. Twice
    /// the tolerance usually takes half as many; where it does not, the bodies are near each other at rest
    /// and no tolerance helps.
    std::vector<double> coarsened(std::vector<double> levels) {
        if (options_.maxSpheres <= 0) return levels;
        const std::size_t planned = levels.size();
        const double widest = std::min(a_.solid.diagonal(), b_.solid.diagonal());
        double before = excess(levels[0]);
        while (before > 1 && levels[0] < widest && !restDecides_) {
            levels.insert(levels.begin(), 2 * levels[0]);
            const double now = excess(levels[0]);
            restDecides_ |= now > 1 && now > 0.75 * before && std::isfinite(before);
            before = now;
        }
        if (levels.size() == planned || restDecides_) return levels;
        double good = levels[0], bad = levels[1];
        for (int round = 0; round < 3; ++round) {
            const double middle = std::sqrt(good * bad);
            (excess(middle) <= 1 ? good : bad) = middle;
        }
        levels[0] = good;
        return levels;
    }

    /// Bisects between the level before (good) and one that took too many spheres (bad) for a finer tolerance
    /// that does not.
    void fitBetween(double good, double bad) {
        const FittedBody::Spheres beforeA = a_.spheres, beforeB = b_.spheres;
        const std::vector<ContactZoneLevel> levels = result_.levels;
        const auto refit = [&](double tolerance) {
            a_.spheres = beforeA;
            b_.spheres = beforeB;
            result_.levels = levels;
            return fit(tolerance);
        };
        for (int round = 0; round < 3; ++round) {
            const double middle = std::sqrt(good * bad);
            (refit(middle) ? good : bad) = middle;
        }
        if (result_.levels.back().tolerance != good) refit(good);
    }

    /// False: it took too many spheres and the level before stands.
    bool fit(double tolerance) {
        const FittedBody::Spheres beforeA = a_.spheres, beforeB = b_.spheres;
        const auto backToLast = [&] {
            a_.spheres = beforeA;
            b_.spheres = beforeB;
            return false;
        };
        if (!result_.levels.empty())
            for (FittedBody* body : {&a_, &b_}) body->keepInscribed();
        const auto fitBoth = [&](const MedialOptions& medial, const Progress& progress) {
            a_.fit(tolerance, medial, progress);
            b_.fit(tolerance, medial, progress);
        };
        try {
            fitBoth(options_.medial, progress_);
        } catch (const RestTooClose&) { // which does not depend on the level
            throw;
        } catch (const InputError& error) { // too fine, or stopped
            if (!result_.levels.empty()) {
                note_ = fmt::format("tolerance {:.4g} instead of {:.4g} scene units: {}",
                                    result_.levels.back().tolerance, tolerance, error.message);
                return backToLast();
            }
            if (!report(progress_, "patches", 0)) throw; // stopped before there is anything
            try {                                        // some level there must be, if it can be had soon
                fitBoth(forTrial(options_.medial, 0), {});
            } catch (const TooFine&) {
                throw InputError(error.message);
            }
        }
        for (const FittedBody* body : {&a_, &b_})
            if (options_.maxSpheres > 0 && !result_.levels.empty() &&
                body->count() + body->spheres.coarse.size() > mostSpheres(*body))
                return backToLast();
        result_.levels.push_back({tolerance, a_.count(), b_.count(), area(a_.zone), area(b_.zone), 0});
        return true;
    }

    /// False: nothing is left to refine.
    bool decide(double tolerance, bool last) {
        if (last) return false;
        if (!dropDecided(tolerance)) {
            decided_ = true;
            result_.neverMeet = !hits_;
            if (hits_) finish({}, {}); // inscribed spheres answer everywhere, nothing is claimed beyond them
            return false;
        }
        result_.levels.back().undecided = cells_.leaves();
        if (report(progress_, "contact zone", 0.5)) return true;
        note_ = fmt::format("stopped at tolerance {:.4g} scene units", tolerance);
        return false;
    }

    /// Drops the cells of Q that the level's spheres decide, from large cells to small ones, as far as their
    /// number allows: it grows with the power of the DOFs. False: no cell is left.
    bool dropDecided(double tolerance) {
        constexpr double mostCells = 2e5;
        const double growth = std::pow(2.0, static_cast<double>(motion_.dofCount()));
        UndecidedOptions how;
        how.margin = options_.margin;
        how.depth = options_.depth;
        const LevelSpheres a = a_.level(), b = b_.level();
        for (how.resolution = 8 * tolerance;; how.resolution /= 2) {
            Undecided left = undecidedCells(a, b, motion_, cells_, how, progress_);
            hits_ |= left.hits;
            if (!left.cells) return false;
            cells_ = std::move(*left.cells);
            if (how.resolution <= tolerance / 2 || static_cast<double>(cells_.leaves()) * growth > mostCells)
                return true;
        }
    }

    FittedBody a_, b_;
    const Motion& motion_;
    const ContactZoneOptions& options_;
    const Progress& progress_;
    CellTree cells_;
    ContactZoneFit result_;
    HollowBodies entered_;
    const bool clearAtRest_;
    const bool whole_;         ///< no part of the surfaces is left out as out of reach
    bool restDecides_ = false; ///< clearance at rest decides how many spheres there are, not the tolerance
    bool hits_ = false;        ///< some cells of Q were dropped since there is contact all over them
    bool decided_ = false;     ///< the spheres decide at every pose whether there is contact
    std::string note_;
};

} // namespace

ContactZoneFit fitContactZone(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                              const ContactZoneOptions& options, const Progress& progress) {
    const auto need = [](bool good, const char* what) {
        if (!good) throw InputError(fmt::format("contact zone: {}", what));
    };
    need(std::isfinite(options.tolerance) && options.tolerance >= 0, "the tolerance must be a number >= 0");
    need(std::isfinite(options.margin) && options.margin >= 0, "the margin must be a number >= 0");
    need(std::isfinite(options.epsilon) && options.epsilon >= 0, "epsilon must be a number >= 0");
    need(std::isfinite(options.depth) && options.depth >= 0, "the depth must be a number >= 0");
    checkMotion(motion);
    const Solid solidA(cleaned(a)), solidB(cleaned(b));
    const double finest =
        options.tolerance > 0 ? options.tolerance : std::min(solidA.diagonal(), solidB.diagonal()) / 500;
    const Nesting nesting =
        options.nesting ? *options.nesting : findNested(solidA, solidB, motion, 2 * finest, progress);
    HollowBodies hollow = nesting.outer;
    bool clearAtRest = true;
    for (;;) {
        Refiner refiner(a, b, motion, options, hollow, clearAtRest, progress);
        try {
            ContactZoneFit fit = refiner.run();
            fit.a.fit.enclosed = nesting.apart();
            fit.b.fit.enclosed = nesting.apart();
            const HollowBodies& more = refiner.entered();
            if (!more) return fit;
            hollow = {hollow.a || more.a, hollow.b || more.b};
        } catch (const RestTooClose&) {
            if (options.atRest != AtRest::Collide) throw;
            clearAtRest = false; // contact at rest is then what the spheres say
        }
    }
}

} // namespace tss
