#pragma once
#include "bake/base/Progress.h"
#include "bake/base/Stopwatch.h"
#include "bake/reduce/CoverCell.h"

namespace tss {

/// When to stop a search that is not done. 0: no limit.
struct CoverBudget {
    std::uint64_t looks = 0; ///< at pairs of spheres and of nodes, in all cells together; ended by these, the
                             ///< result is the same every time
    double seconds = 0;      ///< since `watch` was made; ended by these, results differ
    bool toTheEnd = false;   ///< a search that does not come to its end is of no use
    Progress progress;
    Stopwatch watch;

    bool late() const; ///< the seconds are over
    /// Whether to stop, where a share of Q is proven with so many looks. Of a search that is to come to its
    /// end also early, once a tenth of the looks or seconds shows that they will not suffice.
    bool spent(std::uint64_t looksUsed, double share) const;
};

/// The cover as it grows: its members in the order they were taken, and the poses that forced them in.
class GrowingCover {
public:
    explicit GrowingCover(const CoverProblem& problem)
        : problem_(&problem), set_(std::make_unique<ConcurrentPairs>(problem.a.size(), problem.b.size())) {}

    const std::vector<ContactPair>& members() const { return members_; }
    const ConcurrentPairs& set() const { return *set_; }
    void add(const ContactPair& pair) {
        members_.push_back(pair);
        set_->insert(pair.pair);
    }

    /// The smallest gap of the members from number `first` on, at a pose.
    double gap(const Pose& pose, std::size_t first = 0) const;

private:
    const CoverProblem* problem_;
    std::vector<ContactPair> members_;
    std::unique_ptr<ConcurrentPairs> set_;
};

/// How a proof went.
struct CoverProof {
    bool complete = false;      ///< every cell is answered
    std::vector<OpenCell> left; ///< cells not yet shown, when it was stopped
    std::uint64_t cells = 0;    ///< cells looked at
    std::uint64_t looks = 0;    ///< at pairs in them
    std::uint64_t forced = 0;   ///< members taken in cells too small to split, without a pose that needs them
    std::vector<std::vector<double>>
        counterexamples; ///< DOF values of poses where the cover lacked an answer
};

/// Shows, cell by cell, that the cover keeps the contract, adding what it lacks (METHOD 3.3). Rounds of
/// many cells in parallel against a cover that stands still, then what they lack is added one by one in a
/// fixed order: the same bits for any number of threads.
CoverProof proveCover(const CoverProblem& problem, const ErrorContract& contract, GrowingCover& cover,
                      std::vector<OpenCell> cells, const CoverBudget& budget);

} // namespace tss
