#include "bake/search/CertifiedSearch.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/motion/CellTools.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/NodePairs.h"
#include "bake/search/PairDistanceBounds.h"
#include "bake/search/SampledSearch.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace tss {

namespace {

/// What all parts of one search read.
struct SearchInput {
    const SphereSet &a, &b;
    const SphereTree &treeA, &treeB;
    const MotionRates& rates;
    const ContactRule& rule;
    double margin, tolerance;     ///< scene units
    const ConcurrentPairs& known; ///< pairs found before, by sampling
    bool firstOnly;               ///< stop at the first pair
    std::uint64_t effort;         ///< looks at pairs of nodes granted to each part; 0: no limit
    double rounding = coordinateRounding(rates.motion(), treeA.extent(), treeB.extent());
};

/// Parts that Q is cut into before the search.
constexpr std::size_t partCount = 64;

std::uint64_t effortOfPart(std::uint64_t effort) {
    return effort == 0 ? 0 : effort / partCount + 1;
}

/// The search through one part of Q. Which cells a pair is looked for in depends on the cell alone and not on
/// what else was found, so that the parts may run in any order.
class PartSearch {
public:
    PartSearch(const SearchInput& problem, Poll& poll)
        : p_(problem), poll_(poll), found_(problem.a.size(), problem.b.size()) {}

    void run(const Cell& cell, const std::vector<NodePair>& open) {
        Cell inside = cell;
        if (poll_.stopped() || done() || !shrinkToPlanes(p_.rates.motion(), inside)) return;
        ++cells_;
        const CellMotion motion(p_.rates, inside);
        std::vector<NodePair> left = classify(motion, open);
        if (left.empty()) return;
        const std::size_t k = widestDof(motion, p_.treeB[0].centre, p_.treeB[0].radius);
        if (!canSplit(inside, k)) {
            smallest_ = true;
            classify(motion, left);
            smallest_ = false;
            return;
        }
        const auto [lower, upper] = splitCell(p_.rates, inside, k);
        run(lower, left);
        run(upper, left);
    }

    const ConcurrentPairs& found() const { return found_; }
    bool any() const { return any_; }
    std::uint64_t cells() const { return cells_; }
    bool spent() const { return p_.effort > 0 && looks_ >= p_.effort; }

private:
    bool done() const { return (p_.firstOnly && any_) || spent(); }

    /// Lists the pairs of spheres that touch in the cell and returns the pairs of nodes that smaller cells
    /// have to decide.
    std::vector<NodePair> classify(const CellMotion& motion, const std::vector<NodePair>& open) {
        std::vector<NodePair> left, stack(open);
        descend(p_.treeA, p_.treeB, stack,
                [&](NodePair pair, const SphereTree::Node& na, const SphereTree::Node& nb) {
                    ++looks_;
                    const Vec3 x = motion.centrePose() * nb.centre;
                    const CellMotion::PointMotion moved = motion.pointMotion(x);
                    const double sum = na.radius + nb.radius;
                    if (na.leaf() && nb.leaf()) {
                        classifySpheres(motion, pair, x, moved, left);
                        return false;
                    }
                    if ((x - na.centre).norm() - moved.move > sum + p_.margin + p_.rounding) return false;
                    // Where the motion in the cell exceeds the balls, splitting the balls decides nothing.
                    const bool blurred = sum < moved.move && moved.move > p_.tolerance && !smallest_;
                    if (blurred) left.push_back(pair);
                    return !blurred;
                });
        return left;
    }

    void classifySpheres(const CellMotion& motion, NodePair nodes, const Vec3& x,
                         const CellMotion::PointMotion& moved, std::vector<NodePair>& left) {
        const SpherePair pair{p_.treeA[nodes.a].sphere, p_.treeB[nodes.b].sphere};
        const Sphere &sa = p_.a[pair.a], &sb = p_.b[pair.b];
        const double limit = sa.radius + sb.radius + p_.rule.threshold(pair) + p_.margin;
        if (limit < -p_.rounding || found_.contains(pair) || p_.known.contains(pair)) return;
        const PairDistanceBounds<> at(motion, x, moved, sa.centre);
        if (at.staysAbove(std::max(limit, 0.0), p_.rounding)) return;
        if (moved.move <= p_.tolerance || smallest_ ||
            (at.distance <= limit && withinLimits(p_.rates.motion(), motion.centre()))) {
            found_.insert(pair);
            any_ = true;
        } else {
            left.push_back(nodes);
        }
    }

    const SearchInput& p_;
    Poll& poll_;
    ConcurrentPairs found_;
    bool any_ = false;
    bool smallest_ = false; ///< the cell cannot be split: pairs that may touch count as touching
    std::uint64_t cells_ = 0, looks_ = 0;
};

/// Q in about `count` cells of equal shape: each DOF of any width is halved in turn.
std::vector<Cell> cutEvenly(const MotionRates& rates, std::size_t count) {
    std::vector<Cell> cells{wholeBox(rates.motion())};
    std::vector<std::size_t> wide;
    for (std::size_t k = 0; k < rates.motion().dofCount(); ++k)
        if (cells[0].upper[k] > cells[0].lower[k]) wide.push_back(k);
    for (std::size_t turn = 0; !wide.empty() && cells.size() < count; ++turn) {
        std::vector<Cell> halves;
        for (const Cell& cell : cells) {
            const auto [lower, upper] = splitCell(rates, cell, wide[turn % wide.size()]);
            halves.push_back(lower);
            halves.push_back(upper);
        }
        cells = std::move(halves);
    }
    return cells;
}

struct Found {
    bool complete = true;
    std::uint64_t cells = 0;
    std::vector<SpherePair> pairs;
};

Found search(const SearchInput& problem, const Progress& progress) {
    Found result;
    const auto cells = cutEvenly(problem.rates, partCount);
    ConcurrentPairs all(problem.a.size(), problem.b.size());
    all.insertAll(problem.known);
    Poll poll(progress, "certified search");
    bool stop = false;
    constexpr std::size_t batch = 8;
    bool any = false, spent = false;
    for (std::size_t first = 0; first < cells.size() && !(problem.firstOnly && any) && !spent;
         first += batch) {
        if (!report(progress, "certified search", double(first) / double(cells.size()))) stop = true;
        std::vector<std::unique_ptr<PartSearch>> part(batch);
        parallelFor(batch, [&](std::size_t k) {
            part[k] = std::make_unique<PartSearch>(problem, poll);
            if (first + k < cells.size()) part[k]->run(cells[first + k], {{0, 0}});
        });
        for (const auto& p : part) {
            result.cells += p->cells();
            any |= p->any();
            spent |= p->spent();
            all.insertAll(p->found());
        }
    }
    result.complete = !stop && !poll.stopped() && !spent;
    result.pairs = all.sorted();
    return result;
}

/// A hundredth of the mean radius.
double usualTolerance(const SphereSet& a, const SphereSet& b) {
    double sum = 0;
    for (const SphereSet* set : {&a, &b})
        for (const Sphere& s : *set) sum += s.radius;
    return 0.01 * sum / double(a.size() + b.size());
}

/// Whether some pair touches, or gets within the margin, at one of a few hundred poses spread over Q.
bool meetAtSamples(const SphereTree& a, const SphereTree& b, const Motion& motion, const ContactRule& rule,
                   double margin) {
    constexpr std::size_t samples = 512;
    const std::vector<std::vector<double>> poses = exploredPoses(motion, samples, 1);
    return std::ranges::any_of(poses, [&](const std::vector<double>& q) {
        bool met = false;
        visitPairsWithin(a, b, pose(motion, q), margin, [&](std::uint32_t i, std::uint32_t j, double gap) {
            met = rule.touches({i, j}, gap - margin);
            return !met;
        });
        return met;
    });
}

/// The smallest gap at the explored poses, an upper bound of any clearance.
double smallestGapSeen(const SearchInput& problem) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& q : exploredPoses(problem.rates.motion(), 512, 1))
        best =
            std::min(best, smallestGap(problem.treeA, problem.treeB, pose(problem.rates.motion(), q), best));
    return best;
}

} // namespace

CandidatePairs searchCertified(const SphereSet& a, const SphereSet& b, const Motion& motion,
                               const CertifiedSearchOptions& options, const Progress& progress) {
    const MotionRates rates(motion);
    wholeBox(motion); // refuses chains that are too long
    CandidatePairs result;
    result.certified = true;
    if (a.empty() || b.empty()) {
        result.clearance = std::numeric_limits<double>::infinity();
        return result;
    }
    const ContactRule& rule = options.rule;
    Poll poll(progress, "certified search");
    const auto stop = [&] { return poll.stopped(); };
    const SphereTree treeA(a, stop), treeB(b, stop);
    if (poll.stopped()) {
        result.certified = false;
        return result;
    }
    ConcurrentPairs known(a.size(), b.size());
    SampledSearchOptions sampling; // pairs that touch at sampled poses need no search
    sampling.samples = 1024;
    sampling.rule = rule;
    const Progress asked = [&](std::string_view, double) { return report(progress, "certified search", 0); };
    for (const SpherePair& pair : searchSampled(a, b, motion, sampling, asked).pairs) known.insert(pair);
    const double tolerance = std::max(options.tolerance >= 0 ? options.tolerance : usualTolerance(a, b),
                                      1e-9 * (treeA[0].radius + treeB[0].radius));
    const std::uint64_t effort = effortOfPart(options.effort);
    const SearchInput problem{a,         b,     treeA, treeB, rates, rule, options.margin,
                              tolerance, known, false, effort};
    Found found = search(problem, progress);
    result.certified = found.complete;
    result.explored = found.cells;
    result.pairs = std::move(found.pairs);
    result.restGaps = rule.thresholds(result.pairs);
    if (result.pairs.empty() && result.certified) {
        result.clearance = options.margin;
        if (options.measureClearance && rule.empty())
            result.clearance = std::max(
                result.clearance, provenClearance(a, b, motion, &result.explored, progress, options.effort));
    }
    return result;
}

bool neverCollide(const SphereSet& a, const SphereSet& b, const Motion& motion, const ContactRule& rule,
                  double margin, const Progress& progress) {
    const MotionRates rates(motion);
    wholeBox(motion); // refuses chains that are too long
    if (a.empty() || b.empty()) return true;
    Poll poll(progress, "certified search");
    const auto stop = [&] { return poll.stopped(); };
    const SphereTree treeA(a, stop), treeB(b, stop);
    if (poll.stopped() || meetAtSamples(treeA, treeB, motion, rule, margin)) return false;
    const ConcurrentPairs none(a.size(), b.size());
    constexpr std::uint64_t effort = 5'000'000;
    const SearchInput problem{
        a, b, treeA, treeB, rates, rule, margin, usualTolerance(a, b), none, true, effortOfPart(effort)};
    const Found found = search(problem, progress);
    return found.complete && found.pairs.empty();
}

double provenClearance(const SphereSet& a, const SphereSet& b, const Motion& motion, std::uint64_t* cells,
                       const Progress& progress, std::uint64_t effort) {
    if (a.empty() || b.empty()) return std::numeric_limits<double>::infinity();
    const MotionRates rates(motion);
    const ContactRule rule;
    Poll poll(progress, "proven clearance");
    const auto stop = [&] { return poll.stopped(); };
    const SphereTree treeA(a, stop), treeB(b, stop);
    if (poll.stopped()) return 0;
    const ConcurrentPairs none(a.size(), b.size());
    SearchInput problem{a, b, treeA, treeB, rates, rule, 0, 0, none, true, effortOfPart(effort)};
    const double seen = smallestGapSeen(problem);
    if (!(seen > 0) || !std::isfinite(seen)) return 0;
    for (double share : {0.9, 0.7, 0.5, 0.25, 0.1, 0.01}) {
        problem.margin = share * seen;
        problem.tolerance = 0.05 * problem.margin;
        const Found found = search(problem, progress);
        if (cells) *cells += found.cells;
        if (!found.complete && effort == 0) return 0; // stopped
        if (found.complete && found.pairs.empty()) return problem.margin;
    }
    return 0;
}

} // namespace tss
