#pragma once
#include "bake/fill/Witnesses.h"
#include "bake/motion/MotionBound.h"

#include <array>

namespace tss {

/// Shares of the reach. Surfaces nearer than `settledShare` of it may count as near: spheres on them touch,
/// even as protrusionFor() makes them. Surfaces farther than `apartShare` of it may count as apart. In the
/// overlap of both either verdict is right, so that every cell is decided once it is small enough.
constexpr double settledShare = 0.85, apartShare = 0.75;

/// Whether some part of the inner body's surface ever stands inside the outer body. Asked twice, with each
/// body as the outer one.
struct NestingQuestion {
    const Solid& outer;
    const MeshQuery& surface; ///< of the outer body, without what closes its openings
    bool outerMoves;          ///< the outer body is B
    bool enclosing = false;   ///< one closed part: what a part inside it encloses is inside it as well
    std::vector<PartWitnesses> parts = {}; ///< of the inner body, those that may fit inside
    std::vector<PartWitnesses> all = {};   ///< of the inner body, all
};

/// A part for which a cell is not yet decided.
struct NestingPart {
    std::uint32_t question, part;
    std::uint32_t witness; ///< the one that was outside in the cell or at the pose before, tried first
};

struct NestingCell {
    Cell cell;
    std::vector<NestingPart> parts;
};

struct NestingVerdict {
    std::vector<NestingCell> halves;
    std::array<bool, 2> inside{};    ///< per question: a part is inside with the surfaces apart
    std::array<bool, 2> undecided{}; ///< per question: the cell is too small to split
    std::uint64_t probes = 0;
};

/// Decides cells of Q. Used by many threads at once.
class NestingExaminer {
public:
    NestingExaminer(const Solid& a, const Solid& b, const MotionRates& rates, double reach);

    /// All of Q, with the parts that may fit inside.
    NestingCell whole() const;

    NestingVerdict examine(const NestingCell& given) const;

    /// Whether random steps from the centre of a cell, each farther in than the one before, lead to a pose at
    /// which the part stands inside with the surfaces apart. Steps become shorter where none leads farther
    /// in.
    bool leadsInside(const NestingCell& from, NestingPart part, std::uint64_t seed) const;

private:
    /// The largest signed distance of the part's vertices from the outer body, < 0: all are inside. No more
    /// than one that is `enough` or more. The part's witness becomes the one that has it.
    double sticksOut(NestingPart& part, const Pose& at, double enough) const;

    /// Whether the part fits nowhere in the outer body, however it moves: it is longer, or its largest ball
    /// does not fit.
    bool tooLarge(const NestingQuestion& question, const PartWitnesses& part) const;

    /// A vertex of a part in the frame of the outer body, at the centre of the cell.
    Vec3 placeIn(const NestingQuestion& question, const CellMotion& motion, const Pose& inverse,
                 const Vec3& vertex) const;

    /// How far a vertex may move against the outer body in the cell (for those of A as in findNearSurface()).
    double moveOf(const NestingQuestion& question, const CellMotion& motion, const Vec3& vertex) const;

    /// How far any point of B may move in the cell: no turn takes points farther apart than twice their
    /// radius.
    double moveOfB(const CellMotion& motion) const;

    /// Whether some witness shows that the part is not inside at any pose of the cell: its point stays
    /// outside the outer solid, or its ball reaches through the surface.
    bool outside(const CellMotion& motion, const Pose& inverse, NestingPart& part,
                 std::uint64_t& probes) const;

    /// Whether all witness vertices of the part are inside the outer solid at the cell's centre pose.
    bool inside(const CellMotion& motion, const Pose& inverse, const NestingPart& part,
                std::uint64_t& probes) const;

    /// Whether the surfaces are shown to cross at every pose of the cell: a connected part has one point that
    /// stays inside the other solid and one that stays outside.
    bool cross(const CellMotion& motion, const Pose& inverse, std::uint64_t& probes) const;

    /// Whether the distance of the surfaces decides the cell: they stay near each other all over it, or they
    /// are apart at its centre pose, where a part is inside.
    bool decidedBySurfaces(const CellMotion& motion, const std::array<bool, 2>& within,
                           NestingVerdict& result) const;

    std::size_t widest(const CellMotion& motion) const;

    MeshQuery surfaceA_, surfaceB_;
    const MotionRates& rates_;
    double reach_, rounding_;
    std::array<NestingQuestion, 2> questions_;
    Vec3 centreB_ = Vec3::Zero();
    double radiusB_ = 0;
};

} // namespace tss
