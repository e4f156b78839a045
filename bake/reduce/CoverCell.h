#pragma once
#include "bake/reduce/Domination.h"
#include "bake/search/NodePairs.h"

#include <memory>
#include <optional>

namespace tss {

/// What a cell inherits from its parent: what may still owe an answer in it, and who may give it.
struct CellLists {
    std::vector<NodePair> nodes;        ///< not yet opened
    std::vector<ContactPair> open;      ///< sphere pairs not yet answered
    std::vector<std::uint32_t> members; ///< members of the cover that are near
    std::uint32_t membersSeen = 0;      ///< members up to this number are in the list if they are near
};

/// A cell of Q still to be shown.
struct OpenCell {
    Cell box;
    std::shared_ptr<const CellLists> lists;
};

/// A pair that the cover lacks. With a pose it is a fact: there the models touch and the cover does not
/// answer. Without one the cell is too small to split further and the pair is taken to end the search.
struct Counterexample {
    ContactPair pair;
    std::vector<double> pose;
};

/// What looking at a cell gave: answered all over (neither member below is set), a pair that the cover lacks,
/// or two halves that inherit what is left.
struct CellVerdict {
    std::optional<Counterexample> lacking;
    std::vector<OpenCell> halves;
};

/// Looks at cells against one cover. Holds scratch memory: one for each thread.
class CellExaminer {
public:
    /// members: the cover; inCover: the same as a set. Neither changes while this lives.
    CellExaminer(const CoverProblem& problem, const ErrorContract& owed,
                 const std::vector<ContactPair>& members, const ConcurrentPairs& inCover)
        : p_(problem), owed_(owed), members_(members), inCover_(inCover), moved_(problem.treeB.size()) {}

    CellVerdict examine(const OpenCell& cell);

    /// An epsilon with which the cover answers all over a cell, however it compares with the one wanted: from
    /// the motion of the cell alone. Infinite for an empty cover.
    double epsilonOver(const OpenCell& cell);

    /// At pairs so far, in all cells: what the work grows with.
    std::uint64_t looks() const { return looks_; }

private:
    bool weighMembers(const CellMotion& motion, const CellLists& lists);
    void openNodes(const CellMotion& motion, const std::vector<NodePair>& nodes);
    void weigh(const CellMotion& motion, const ContactPair& pair);
    void dropAnswered(const CellMotion& motion);
    std::optional<Counterexample> counterexampleAtCentre(const CellMotion& motion) const;
    std::optional<Counterexample> counterexampleElsewhere(const CellMotion& motion) const;
    std::optional<Counterexample> counterexampleAt(const CellMotion& motion,
                                                   const std::array<double, maxDofs>& offset,
                                                   const PairInCell*& answering) const;
    void deepestBelow(const CellMotion& motion, ContactPair& best, double& gap) const;
    std::size_t widestDof(const CellMotion& motion) const;
    CellVerdict split(const OpenCell& cell, const CellMotion& motion, std::uint32_t seen) const;

    const CoverProblem& p_;
    const ErrorContract owed_;
    const std::vector<ContactPair>& members_;
    const ConcurrentPairs& inCover_;

    std::vector<PairInCell> near_; ///< members
    std::vector<PairInCell> here_; ///< open pairs
    std::vector<NodePair> nodes_, stack_;
    std::vector<std::pair<double, std::uint32_t>> ranks_; ///< of near_, the best first
    double bestMember_ = 0;                               ///< smallest gap of a member at the centre

    /// Where a node of B's tree is at the centre of the cell and how far it moves, worked out once a cell.
    struct Moved {
        std::uint64_t cell = 0;
        Vec3 x;
        CellMotion::PointMotion motion{};
    };
    const Moved& moved(const CellMotion& motion, std::uint32_t node);
    std::vector<Moved> moved_;
    std::uint64_t cellNumber_ = 0;
    mutable std::uint64_t looks_ = 0;
};

/// The cells that a cover of the whole problem starts from: all of Q, all of both trees.
OpenCell wholeProblem(const CoverProblem& problem);

} // namespace tss
