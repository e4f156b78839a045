#pragma once
#include "bake/verify/MeshProof.h"

#include <span>

namespace tss::verify {

/// Bounds of the gaps of a table's tests over boxes of DOF values, by the verifier's own bounds of motion.
/// Rounding is inside. Keeps a reference to the table.
class GapBox {
public:
    explicit GapBox(const Table& table);

    std::size_t testCount() const { return tests_.size(); }

    /// Bounds the tests of the list over the box: low(p) of each from then on. Returns the most that the
    /// smallest of their gaps can be anywhere in the box.
    double bound(const Box& box, std::span<const std::uint32_t> list);
    /// Test p's gap is nowhere smaller in the last box whose list had it.
    double low(std::size_t p) const { return low_[p]; }

private:
    const Motion& motion_;
    std::vector<MeshTest> tests_;
    double size_ = 0;
    std::uint64_t stamp_ = 0;
    std::vector<MovingPoint> moving_;    ///< one per sphere of B
    std::vector<std::uint64_t> movedAt_; ///< the stamp for which each is right
    std::vector<double> low_;            ///< one per test
};

} // namespace tss::verify
