#pragma once
#include "bake/verify/MeshProof.h"
#include "bake/verify/TestTree.h"

#include <algorithm>

namespace tss::verify {

/// Weighs boxes of Q one at a time. Holds what can be used again between them, so one per thread; what it
/// says of a box depends on that box alone.
class MeshBox {
public:
    MeshBox(const SurfaceTree& a, const SurfaceTree& b, const Motion& motion, double size,
            const MeshClaim& claim, const TestTree& tests);

    /// Split: `left` is what is still open in the box and `cut` the DOF to halve it along, at `at`. Broken,
    /// Undecided: the pose goes into `broken`.
    Outcome judge(const Box& box, const std::vector<PiecePair>& open, std::vector<PiecePair>& left,
                  std::size_t& cut, double& at, MeshProofResult& broken);

    std::uint64_t work() const { return work_; }

    /// The claim is broken at a pose: the surfaces, exempt pairs excepted, come as near as that and no test
    /// answers.
    bool breaksAt(const std::vector<double>& q, const std::vector<PiecePair>& pairs,
                  MeshProofResult& broken) {
        const double near = claim_.tests.empty() ? std::max(0.0, claim_.near - claim_.band) : claim_.near;
        return unanswered(q, pairs, near, broken);
    }

private:
    /// At a pose no test answers, and the surfaces are no farther apart than `near`.
    bool unanswered(const std::vector<double>& q, const std::vector<PiecePair>& pairs, double near,
                    MeshProofResult& broken);
    /// At a pose two pieces of some pair, unless both are exempt, are no farther apart than `near`.
    bool anyWithin(double near, const Pose& at, std::vector<PiecePair> stack);

    struct Moved : MovingPoint {
        std::uint64_t stamp = 0;
    };
    /// A test over the box: gap = gap + sum_l slope_l (q_l - middle_l), never more than `rest` above it.
    struct Near {
        std::uint32_t test = 0;
        double gap = 0, rest = 0;
        Vec3 normal;
        std::array<double, maxDofs> slope;
    };
    /// What to do about a pair of pieces in the box: nothing more, halve a piece, or halve the box.
    enum class Verdict { Done, SplitPair, SplitBox };

    // Where the middle of a piece of B is over the box: `at` below.
    const Moved& moved(std::int32_t node);

    bool weighTest(std::uint32_t test);
    bool weighTests();
    Verdict weigh(const PiecePair& pair);
    /// The pieces stay farther apart than the claim allows, all over the box.
    bool apart(const Shape& a, const Shape& b, const MovingPoint& at) const;
    /// Some test fires wherever in the box the pieces meet. If not, `blur` is what loosens the bounds most.
    bool answered(const Shape& a, const Shape& b, const MovingPoint& at, Verdict& blur);
    Eigen::Matrix3d spread(const Shape& a, const Shape& b, const MovingPoint& at) const;
    /// patches: receives the part of the bound that smaller pieces would lower.
    double bound(const Near& test, const Vec3& lambda, const Shape& a, const Shape& b, const MovingPoint& at,
                 double& patches) const;
    void halve(const PiecePair& pair, std::vector<PiecePair>& stack);
    void chooseCut(const std::vector<PiecePair>& left, std::size_t& cut);

    const SurfaceTree &a_, &b_;
    const Motion& motion_;
    const MeshClaim& claim_;
    const TestTree& tests_; ///< of the claim
    double size_, smallest_, largestContact_ = 0;

    const PoseBox* box_ = nullptr;
    std::uint64_t stamp_ = 0, work_ = 0;
    PieceShapes shapesA_, shapesB_;
    std::vector<Moved> moved_; ///< one per node of B
    std::vector<Near> near_;
    double scale_ = 0; ///< reach of the pair that was weighed last
    std::vector<PiecePair> stack_;
};

} // namespace tss::verify
