#include "bake/verify/KernelProofs.h"
#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <cmath>

namespace tss::verify {

PairErrors directErrors(const PreparedTable& prepared, const StoredRow& row, const Exact& test,
                        double farthest, double posed) {
    const bool single = prepared.precision() == KernelPrecision::Float;
    const double u = single ? 0x1p-24 : 0x1p-53;
    const Vec3 &originA = prepared.kernels().originA(), &originB = prepared.kernels().originB();
    const Vector a = test.a.cast<Real>() - originA.cast<Real>(),
                 b = test.b.cast<Real>() - originB.cast<Real>();
    const auto storedOff = [&](std::size_t column, const Vector& wanted, double size) {
        const Vector stored(row[column], row[column + 1], row[column + 2]);
        return double((stored - wanted).norm() + 4 * realRoundoff * size);
    };
    const double storedA = storedOff(3, a, test.a.norm() + originA.norm()),
                 storedB = storedOff(0, b, test.b.norm() + originB.norm());
    const double lengthA = double(a.norm()), lengthB = double(b.norm());
    const auto squareError = [&](double distance) {
        const double t = std::min(farthest, lengthA + lengthB + distance);
        // The numbers of R and t, each rounded; t - a; three products and their sums, each rounded.
        const double vector =
            storedA + storedB + posed + std::sqrt(3.0) * u * (5 * t + 4 * lengthA + 5 * lengthB);
        const double far = distance + vector;
        return 2 * distance * vector + vector * vector + 4 * u * far * far;
    };
    const double contactDistance2 = test.contactDistance * std::abs(test.contactDistance);
    const double off = contactDistance2 - row.fromEnd(3);
    const double error =
        squareError(std::abs(test.contactDistance) * (1 + 1e-6)) + 2 * u * std::abs(row.fromEnd(3));
    return {{off - error, off + error},
            squareError(std::max(0.0, test.contactDistance + prepared.kernels().margin()))};
}

namespace {

/// How far the twelve numbers that the direct kernel reads at some values are from those of the pose between
/// the two origins: points of B no farther than `reach` from its origin come out no farther off.
double poseOff(const PreparedTable& prepared, const ExactPose& at, const TableFeatures& f, double reach) {
    const bool single = prepared.precision() == KernelPrecision::Float;
    const Vector shift = at.at(prepared.kernels().originB()) - prepared.kernels().originA().cast<Real>();
    Real turned = 0, shifted = 0;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const int k = 1 + 4 * row + column;
            const Real stored = single ? Real(f.floats[k]) : Real(f.doubles[k]);
            const Real off = stored - (column < 3 ? at.turn(row, column) : shift[row]);
            (column < 3 ? turned : shifted) += off * off;
        }
    return double(std::sqrt(turned)) * reach + double(std::sqrt(shifted));
}

} // namespace

DirectPose::DirectPose(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests)
    : motion_(table.motion) {
    PrepareOptions options;
    options.target = prepared.target();
    options.form = KernelForm::Direct;
    options.precision = KernelPrecision::Double;
    options.cells = CellUse::Never;
    const PreparedTable plain(table, options);
    for (const Exact& t : tests) reach_ = std::max(reach_, (t.b - plain.kernels().originB()).norm());
    // The pose takes B's origin to its place, and turns what lies about it.
    const double size = coordinateBound(motion_, plain.kernels().originB().norm()) +
                        plain.kernels().originA().norm() + reach_;
    rounding_ = poseRounding(motion_, size, 0x1p-53);
    farRounding_ = turnRounding(motion_, size, 0x1p-53);
    const bool paths = std::any_of(motion_.dofs.begin(), motion_.dofs.end(),
                                   [](const Dof& dof) { return dof.kind == DofKind::Path; });
    std::size_t count = 1;
    if (!paths && motion_.dofCount() <= 4)
        for (std::size_t k = 0; k < motion_.dofCount(); ++k) count *= 3;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<double> q;
        for (std::size_t k = 0, rest = i; k < motion_.dofCount(); ++k, rest /= 3) {
            const Dof& dof = motion_.dofs[k];
            const double middle = dof.lower + 0.5 * (dof.upper - dof.lower);
            const double half = 0.5 * (dof.upper - dof.lower);
            const double node = dof.kind == DofKind::Rotation ? std::min(half, 1.25) : half;
            q.push_back(std::clamp(middle + (rest % 3 == 0   ? 0
                                             : rest % 3 == 1 ? node
                                                             : -node),
                                   dof.lower, dof.upper));
        }
        TableFeatures f;
        plain.features(q.data(), f);
        worst_ = std::max(worst_, poseOff(plain, exactPose(motion_, {q.begin(), q.end()}), f, reach_));
    }
}

bool DirectPose::agreesAt(const PreparedTable& prepared, const ExactPose& at, const TableFeatures& f) const {
    const double u = prepared.precision() == KernelPrecision::Float ? 0x1p-24 : 0;
    return poseOff(prepared, at, f, reach_) <=
           rounding_ + farRounding_ + 2 * u * (reach_ + prepared.kernels().farthestT()) * (1 + 1e-6) + 1e-300;
}

} // namespace tss::verify
