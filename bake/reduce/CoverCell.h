#pragma once
#include "bake/reduce/Domination.h"
#include "bake/search/NodePairs.h"

#include <memory>
#include <optional>

namespace tss {

/// What a cell inherits from its parent: the pairs not yet answered, and the members of the cover that may
/// answer them.
struct CellLists {
    std::vector<NodePair> nodes;        ///< pairs of nodes not yet descended into
    std::vector<ContactPair> open;      ///< sphere pairs not yet answered
    std::vector<std::uint32_t> members; ///< numbers of those below `membersSeen` that come near in the cell
    std::uint32_t membersSeen = 0;      ///< later members are to be looked at as well
};

/// A cell of Q for which it is still to be shown that the cover answers.
struct OpenCell {
    Cell box;
    std::shared_ptr<const CellLists> lists;
};

/// A pair that the cover lacks.
struct Counterexample {
    ContactPair pair;
    std::vector<double> pose; ///< at which the models touch by this pair and the cover does not answer;
                              ///< empty: none was found in a cell too small to split, and the pair is added
                              ///< all the same so that the search ends
};

/// What came of a cell: a pair that the cover lacks, or two halves that inherit what is left; neither where
/// the cover answers all over the cell.
struct CellVerdict {
    std::optional<Counterexample> lacking;
    std::vector<OpenCell> halves;
};

/// Decides cells against one cover. Holds scratch memory: each thread needs its own.
class CellExaminer {
public:
    /// members: the cover; inCover: the same as a set. Neither changes while this lives.
    CellExaminer(const CoverProblem& problem, const ErrorContract& contract,
                 const std::vector<ContactPair>& members, const ConcurrentPairs& inCover)
        : p_(problem), contract_(contract), members_(members), inCover_(inCover),
          moved_(problem.treeB.size()) {}

    CellVerdict examine(const OpenCell& cell);

    /// An epsilon with which the cover answers all over a cell, from bounds of the motion in the cell; no
    /// less than the one asked for. Infinite for an empty cover.
    double epsilonOver(const OpenCell& cell);

    /// Looks at pairs so far, in all cells: a measure of the work.
    std::uint64_t looks() const { return looks_; }

private:
    bool collectMembers(const CellMotion& motion, const CellLists& lists);
    void descendNodes(const CellMotion& motion, const std::vector<NodePair>& nodes);
    void addIfNear(const CellMotion& motion, const ContactPair& pair);
    void removeAnswered(const CellMotion& motion);
    std::optional<Counterexample> counterexampleAtCentre(const CellMotion& motion) const;
    std::optional<Counterexample> counterexampleElsewhere(const CellMotion& motion) const;
    std::optional<Counterexample> counterexampleAt(const CellMotion& motion,
                                                   const std::array<double, mostCoverDofs>& offset,
                                                   const PairInCell*& answering) const;
    void deepestBelow(const CellMotion& motion, ContactPair& best, double& gap) const;
    std::size_t widestDof(const CellMotion& motion) const;
    CellVerdict split(const OpenCell& cell, const CellMotion& motion, std::uint32_t seen) const;

    const CoverProblem& p_;
    const ErrorContract contract_;
    const std::vector<ContactPair>& members_;
    const ConcurrentPairs& inCover_;

    std::vector<PairInCell> near_; ///< members of the cover that come near in the cell
    std::vector<PairInCell> open_; ///< pairs that come near and are not yet answered
    std::vector<NodePair> nodes_, stack_;
    std::vector<std::pair<double, std::uint32_t>> ranks_; ///< of near_, the best first
    double bestMember_ = 0;                               ///< smallest gap of a member at the centre

    /// Where the centre of a node of B's tree is at the cell's centre pose and how far it moves in the cell,
    /// calculated once a cell.
    struct Moved {
        std::uint64_t cell = 0; ///< for which it was calculated
        Vec3 x;                 ///< in A's frame
        CellMotion::PointMotion motion{};
    };
    const Moved& moved(const CellMotion& motion, std::uint32_t node);
    std::vector<Moved> moved_;
    std::uint64_t cellNumber_ = 0;
    mutable std::uint64_t looks_ = 0;
};

/// The cell that a proof starts from: all of Q, with the roots of both trees.
OpenCell wholeProblem(const CoverProblem& problem);

} // namespace tss
