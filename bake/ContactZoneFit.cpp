#include "bake/ContactZoneFit.h"

#include "bake/HollowBodies.h"
#include "bake/NestedBodies.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/search/Reach.h"
#include "bake/spheres/MedialSpheres.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace tss {

namespace {

double area(std::span<const Patch> patches) {
    double sum = 0;
    for (const Patch& patch : patches) sum += patch.area();
    return sum;
}

/// One body while the levels go by.
struct Body {
    Body(const TriangleMesh& mesh, bool hollow)
        : solid(cleaned(mesh), hollow ? Interior::Hollow : Interior::Filled), surface(solid.mesh()),
          magnitude(tss::magnitude(solid.mesh())) {}

    Solid solid;
    MeshQuery surface; ///< without closing fans: contact is of the mesh itself
    double magnitude;
    std::vector<Patch> zone;
    LevelSpheres level;
    SphereSet coarse; ///< inscribed spheres of the levels before

    void fit(double tolerance, const MedialOptions& medial, const Progress& progress) {
        level.protrusion = protrusionFor(tolerance, magnitude);
        level.spheres = medialSpheres(solid, zone, level.protrusion, medial, progress);
    }
    /// All spheres so far.
    SphereSet spheres() const {
        SphereSet all = level.spheres;
        all.insert(all.end(), coarse.begin(), coarse.end());
        return all;
    }
    ContactZoneBody result(const ContactZoneOptions& options) const {
        ContactZoneBody body;
        body.fit.spheres = options.conservative ? level.spheres : inscribed(level.spheres, level.protrusion);
        body.fit.protrusion = options.conservative ? level.protrusion : 0;
        body.fit.coverage = options.conservative ? 0 : level.protrusion;
        body.fit.note = solid.assumptions();
        body.fit.hollow = solid.hollow();
        body.fine = body.fit.spheres.size();
        body.zone = zone;
        if (options.keepCoarse) body.fit.spheres.insert(body.fit.spheres.end(), coarse.begin(), coarse.end());
        return body;
    }
};

/// The tolerances of the levels, each half of the one before, from about 1/400 of the body's size.
std::vector<double> levelTolerances(double finest, double diagonal) {
    std::vector<double> levels{finest};
    while (2 * levels.back() < diagonal / 300) levels.push_back(2 * levels.back());
    std::reverse(levels.begin(), levels.end());
    return levels;
}

class Refiner {
public:
    Refiner(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
            const ContactZoneOptions& options, const HollowBodies& hollow, const Progress& progress)
        : a_(a, hollow.a), b_(b, hollow.b), motion_(motion), options_(options), progress_(progress),
          cells_(wholeQ(motion)) {
        a_.zone = patchesOf(a_.solid.mesh());
        b_.zone = patchesOf(b_.solid.mesh());
    }

    /// Of no use where entered() says that a body is hollow after all.
    ContactZoneFit run() {
        const double smaller = std::min(a_.solid.diagonal(), b_.solid.diagonal());
        const double finest = options_.tolerance > 0 ? options_.tolerance : smaller / 500;
        std::vector<double> levels = levelTolerances(finest, smaller);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            if (!narrow(levels[i])) break;
            if (i == 0) levels = coarsened(std::move(levels));
            if (!fit(levels[i])) {
                if (i > 0 && note_.empty()) fitBetween(levels[i - 1], levels[i]);
                break;
            }
            if ((entered_ = entered(2 * levels[i]))) return {};
            if (!decide(levels[i], levels[i] <= finest)) break;
        }
        if (!decided_ && note_.empty() && result_.levels.back().tolerance > finest * (1 + 1e-9))
            note_ = fmt::format("tolerance {:.4g} instead of {:.4g}: {} spheres do not suffice",
                                result_.levels.back().tolerance, finest, options_.maxSpheres);
        result_.a = a_.result(options_);
        result_.b = b_.result(options_);
        for (ContactZoneBody* body : {&result_.a, &result_.b})
            if (!note_.empty()) body->fit.note += (body->fit.note.empty() ? "" : "; ") + note_;
        return std::move(result_);
    }

    const HollowBodies& entered() const { return entered_; }

private:
    HollowBodies entered(double reach) const {
        if (!a_.solid.open() && !b_.solid.open()) return {};
        const SphereSet a = a_.spheres(), b = b_.spheres();
        return findHollow({a_.solid, a_.surface, a, a_.level.protrusion},
                          {b_.solid, b_.surface, b, b_.level.protrusion}, motion_, reach, progress_);
    }

    /// The zones within reach over what is left of Q. False: there are none.
    bool narrow(double tolerance) {
        std::vector<Patch> zoneA =
            findReach(a_.zone, Side::A, b_.surface, motion_, cells_, tolerance, options_.margin, progress_);
        std::vector<Patch> zoneB =
            findReach(b_.zone, Side::B, a_.surface, motion_, cells_, tolerance, options_.margin, progress_);
        if (zoneA.empty() || zoneB.empty()) {
            // The poses left are free; what was decided before stays with the inscribed spheres.
            result_.neverMeet = !hits_;
            // Spheres of the last level may touch there yet: finer ones of the last zone show that nothing
            // does.
            if (!hits_ && !result_.levels.empty()) return true;
            decided_ = true;
            finish(std::move(zoneA), std::move(zoneB));
            return false;
        }
        a_.zone = std::move(zoneA);
        b_.zone = std::move(zoneB);
        return true;
    }

    void finish(std::vector<Patch> zoneA, std::vector<Patch> zoneB) {
        keepInner();
        a_.level = b_.level = {};
        a_.zone = std::move(zoneA);
        b_.zone = std::move(zoneB);
    }

    void keepInner() {
        for (Body* body : {&a_, &b_}) {
            const SphereSet inner = inscribed(body->level.spheres, body->level.protrusion);
            body->coarse.insert(body->coarse.end(), inner.begin(), inner.end());
        }
    }

    bool few(double tolerance) {
        const auto limit = static_cast<std::size_t>(options_.maxSpheres);
        const MedialOptions trial = forTrial(options_.medial, limit);
        try {
            a_.fit(tolerance, trial, progress_);
            b_.fit(tolerance, trial, progress_);
        } catch (const TooFine&) {
            return false;
        }
        return std::max(a_.level.spheres.size(), b_.level.spheres.size()) <= limit;
    }

    /// The levels from the finest tolerance on with which no body takes too many spheres.
    std::vector<double> coarsened(std::vector<double> levels) {
        if (options_.maxSpheres <= 0) return levels;
        int doubled = 0;
        for (; doubled < 20 && !few(levels[0]); ++doubled) levels.insert(levels.begin(), 2 * levels[0]);
        if (doubled == 0) return levels;
        double good = levels[0], bad = levels[1];
        for (int round = 0; round < 3; ++round) {
            const double middle = std::sqrt(good * bad);
            (few(middle) ? good : bad) = middle;
        }
        levels[0] = good;
        return levels;
    }

    /// After a level that took too many spheres: the finest one between it and the one before that does not.
    void fitBetween(double good, double bad) {
        const std::array<LevelSpheres, 2> before{a_.level, b_.level};
        const std::array<SphereSet, 2> coarse{a_.coarse, b_.coarse};
        const std::vector<ContactZoneLevel> levels = result_.levels;
        const auto refit = [&](double tolerance) {
            a_.level = before[0], a_.coarse = coarse[0];
            b_.level = before[1], b_.coarse = coarse[1];
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
        const Body* bodies[] = {&a_, &b_};
        std::array<LevelSpheres, 2> before{a_.level, b_.level};
        std::array<SphereSet, 2> coarse{a_.coarse, b_.coarse};
        if (!result_.levels.empty()) keepInner();
        const auto backToLast = [&] {
            a_.level = before[0], a_.coarse = coarse[0];
            b_.level = before[1], b_.coarse = coarse[1];
            return false;
        };
        const auto fitBoth = [&](const MedialOptions& medial, const Progress& progress) {
            a_.fit(tolerance, medial, progress);
            b_.fit(tolerance, medial, progress);
        };
        try {
            fitBoth(options_.medial, progress_);
        } catch (const InputError& error) { // too fine, or stopped
            if (!result_.levels.empty()) {
                note_ = fmt::format("tolerance {:.4g} instead of {:.4g}: {}", result_.levels.back().tolerance,
                                    tolerance, error.message);
                return backToLast();
            }
            try { // some level there must be, if it can be had soon
                fitBoth(forTrial(options_.medial, 0), {});
            } catch (const TooFine&) {
                throw InputError(error.message);
            }
        }
        const auto limit = static_cast<std::size_t>(options_.maxSpheres);
        for (const Body* body : bodies)
            if (limit > 0 && !result_.levels.empty() &&
                body->level.spheres.size() + body->coarse.size() > limit)
                return backToLast();
        result_.levels.push_back(
            {tolerance, a_.level.spheres.size(), b_.level.spheres.size(), area(a_.zone), area(b_.zone), 0});
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
        note_ = fmt::format("stopped at tolerance {:.4g}", tolerance);
        return false;
    }

    /// Drops the cells that the level's spheres decide, from large cells on and as small as pays: with many
    /// DOFs their number explodes. False: none is left.
    bool dropDecided(double tolerance) {
        constexpr double mostCells = 2e5;
        const double growth = std::pow(2.0, static_cast<double>(motion_.dofCount()));
        UndecidedOptions how;
        how.margin = options_.margin;
        how.depth = options_.depth;
        how.atRest = options_.atRest;
        for (how.resolution = 8 * tolerance;; how.resolution /= 2) {
            Undecided left = undecidedCells(a_.level, b_.level, motion_, cells_, how, progress_);
            hits_ |= left.hits;
            if (!left.cells) return false;
            cells_ = std::move(*left.cells);
            if (how.resolution <= tolerance / 2 || static_cast<double>(cells_.leaves()) * growth > mostCells)
                return true;
        }
    }

    Body a_, b_;
    const Motion& motion_;
    const ContactZoneOptions& options_;
    const Progress& progress_;
    CellTree cells_;
    ContactZoneFit result_;
    HollowBodies entered_;
    bool hits_ = false;
    bool decided_ = false; ///< no pose is left whose verdict the spheres do not know
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
    need(std::isfinite(options.depth) && options.depth >= 0, "the depth must be a number >= 0");
    checkMotion(motion);
    const Solid solidA(cleaned(a)), solidB(cleaned(b));
    const double finest =
        options.tolerance > 0 ? options.tolerance : std::min(solidA.diagonal(), solidB.diagonal()) / 500;
    const Nesting nesting = findNested(solidA, solidB, motion, 2 * finest, progress);
    HollowBodies hollow = nesting.outer;
    for (;;) {
        Refiner refiner(a, b, motion, options, hollow, progress);
        ContactZoneFit fit = refiner.run();
        fit.a.fit.mayEnclose = nesting.undecided.a;
        fit.b.fit.mayEnclose = nesting.undecided.b;
        const HollowBodies& more = refiner.entered();
        if (!more) return fit;
        hollow = {hollow.a || more.a, hollow.b || more.b};
    }
}

} // namespace tss
