#include "bake/verify/Kernel.h"

#include "bake/verify/KernelCells.h"
#include "bake/verify/VerdictProof.h"
#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace tss {

namespace {

using Real = long double;
constexpr Real realRoundoff = std::numeric_limits<Real>::epsilon();
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

/// A rigid pose in extended precision.
struct ExactPose {
    Matrix turn = Matrix::Identity();
    Vector shift = Vector::Zero();
    ExactPose times(const ExactPose& inner) const { return {turn * inner.turn, turn * inner.shift + shift}; }
    Vector at(const Vec3& y) const { return turn * y.cast<Real>() + shift; }
};

Matrix cross(const Vector& v) {
    Matrix m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

ExactPose exactPose(const Motion& motion, const std::vector<Real>& q) {
    ExactPose pose;
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        ExactPose step;
        if (dof.kind == DofKind::Path) {
            const Pose at = dofPose(dof, static_cast<double>(q[k]));
            step = {at.linear().cast<Real>(), at.translation().cast<Real>()};
        } else if (dof.kind == DofKind::Translation) {
            step.shift = q[k] * dof.axis.cast<Real>();
        } else {
            const Matrix spin = cross(dof.axis.cast<Real>());
            const Real half = std::sin(q[k] / 2);
            step.turn += std::sin(q[k]) * spin + 2 * half * half * spin * spin;
            const Vector origin = dof.origin.cast<Real>();
            step.shift = origin - step.turn * origin;
        }
        pose = pose.times(step);
    }
    return pose.times({motion.base.linear().cast<Real>(), motion.base.translation().cast<Real>()});
}

/// How far a point may come out of T(q) from where it is, when that is worked out with roundoff u: `size`
/// bounds every coordinate on the way.
double poseRounding(const Motion& motion, double size, double u) {
    double off = 0;
    for (const Dof& dof : motion.dofs) {
        if (dof.kind == DofKind::Rotation) off += 4 * std::abs(dof.axis.norm() - 1);
        for (const PathRow& row : dof.path) off += std::abs(row.rotation.norm() - 1);
    }
    return (64 * double(motion.dofCount() + 2) * u + off) * size;
}

/// Whatever a DOF's polynomial in its factors 1, first, second is off by at three values, it is off anywhere
/// in the limits by no more than this times as much.
constexpr double betweenNodes = 7;

/// One test as it stands in the table.
struct Exact {
    Vec3 a, b;
    double reach;
};

std::vector<Exact> exactTests(const Table& table) {
    std::vector<Exact> all;
    for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i)
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
            const Sphere &a = table.a[i], &b = table.b[table.columns[k]];
            const double rest = table.restGaps.empty() ? 0 : table.restGaps[k];
            all.push_back({a.centre, b.centre, a.radius + b.radius + rest});
        }
    return all;
}

/// A bound for every coordinate that a test's centre meets on its way into A's frame.
double pathSize(const Motion& motion, const std::vector<Exact>& tests) {
    double a = 0, b = 0;
    for (const Exact& t : tests) {
        a = std::max(a, t.a.norm());
        b = std::max(b, t.b.norm());
    }
    return a + verify::coordinateBound(motion, b);
}

/// A row of numbers as a kernel reads it, float or double.
class StoredRow {
public:
    StoredRow(const PreparedTable& prepared, std::size_t row)
        : single_(prepared.precision() == KernelPrecision::Float), data_(prepared.rows().blocks) {
        const bool fold = prepared.form() == KernelForm::Fold;
        width_ = fold ? foldColumns(prepared.rows().columns) : directColumns;
        first_ = row * width_;
    }
    double operator[](std::size_t column) const {
        return single_ ? double(static_cast<const float*>(data_)[first_ + column])
                       : static_cast<const double*>(data_)[first_ + column];
    }
    double fromEnd(std::size_t column) const { return (*this)[width_ - column]; }

private:
    bool single_;
    const void* data_;
    std::size_t width_ = 0, first_ = 0;
};

/// What of the error of a squared distance does not depend on the pair's own numbers.
struct Bounds {
    double low, high; ///< how far a kernel's number may be below and above the exact one
};

/// The claim about one pair from the errors of its squared distance less its squared reach (`sign`, where
/// that is about 0) and of its squared distance (`square`, at gaps asked for).
struct PairErrors {
    Bounds sign;
    double square;
};

double gapError(double u, double error, double reach, double gap) {
    const double distance = std::max(0.0, reach + gap), squared = distance * distance;
    // The square is rounded once more and the square root once; the reach and the difference once each.
    const double whole = error + u * (squared + error);
    const double near = std::sqrt(std::max(0.0, squared - whole)), far = std::sqrt(squared + whole);
    return std::max(distance - near, far - distance) +
           u * (2 * far + 2 * std::abs(reach) + std::abs(gap) + distance);
}

/// Range of a DOF's factor about the middle of its limits: 1, sin d, 1 - cos d; or 1, d, d^2.
std::pair<Real, Real> factorRange(const Dof& dof, int which) {
    const Real half = (Real(dof.upper) - Real(dof.lower)) / 2;
    if (which == 0) return {1, 1};
    if (dof.kind == DofKind::Translation)
        return which == 1 ? std::pair(-half, half) : std::pair(Real(0), half * half);
    const Real quarter = std::numbers::pi_v<Real> / 2;
    if (which == 1) {
        const Real most = half < quarter ? std::sin(half) : Real(1);
        return {-most, most};
    }
    return {0, half < 2 * quarter ? 1 - std::cos(half) : Real(2)};
}

/// Which of the 3^#DOFs products of factors a feature is.
std::size_t productOf(const Fold::Feature& feature, std::size_t dofs) {
    std::size_t index = 0;
    for (std::size_t k = dofs; k-- > 0;) index = 3 * index + feature.factor[k];
    return index;
}

/// Squared distances of all tests as polynomials of the products of factors, by their values at three poses a
/// DOF. #tests by 3^#DOFs.
/// farthest: the largest of the values, one a test.
std::vector<std::vector<Real>> exactProducts(const Motion& motion, const std::vector<Exact>& tests,
                                             std::vector<Real>& farthest) {
    const std::size_t dofs = motion.dofCount();
    std::size_t count = 1;
    for (std::size_t k = 0; k < dofs; ++k) count *= 3;
    std::vector<Real> middle, node;
    for (const Dof& dof : motion.dofs) {
        const Real half = (Real(dof.upper) - Real(dof.lower)) / 2;
        middle.push_back(dof.lower + 0.5 * (dof.upper - dof.lower)); // as the factors have it, in double
        node.push_back(dof.kind == DofKind::Rotation ? std::min<Real>(half, 1.25) : half);
    }
    std::vector<std::vector<Real>> weights(tests.size(), std::vector<Real>(count));
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<Real> q;
        for (std::size_t k = 0, rest = i; k < dofs; ++k, rest /= 3)
            q.push_back(middle[k] + (rest % 3 == 0 ? Real(0) : rest % 3 == 1 ? node[k] : -node[k]));
        const ExactPose pose = exactPose(motion, q);
        for (std::size_t p = 0; p < tests.size(); ++p)
            weights[p][i] = (pose.at(tests[p].b) - tests[p].a.cast<Real>()).squaredNorm();
    }
    for (const std::vector<Real>& w : weights) farthest.push_back(*std::max_element(w.begin(), w.end()));
    for (std::size_t k = 0, stride = 1; k < dofs; ++k, stride *= 3) {
        const bool turn = motion.dofs[k].kind == DofKind::Rotation;
        const Real first = turn ? std::sin(node[k]) : node[k];
        const Real halfSine = std::sin(node[k] / 2);
        const Real second = turn ? 2 * halfSine * halfSine : node[k] * node[k];
        for (std::size_t i = 0; i < count; ++i) {
            if (i / stride % 3 != 0) continue;
            for (std::vector<Real>& w : weights) {
                Real &v0 = w[i], &v1 = w[i + stride], &v2 = w[i + 2 * stride];
                const Real odd = v1 - v2, even = v1 + v2 - 2 * v0;
                v1 = first > 0 ? odd / (2 * first) : 0;
                v2 = second > 0 ? even / (2 * second) : 0;
            }
        }
    }
    return weights;
}

/// Errors of the fold, pair by pair.
class FoldErrors {
public:
    FoldErrors(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests)
        : prepared_(prepared), fold_(*prepared.fold()),
          u_(prepared.precision() == KernelPrecision::Float ? 0x1p-24 : 0x1p-53),
          exact_(exactProducts(table.motion, tests, farthest_)) {
        const std::size_t dofs = table.motion.dofCount();
        rounding_ = poseRounding(table.motion, pathSize(table.motion, tests), double(realRoundoff));
        const std::size_t count = exact_.empty() ? 0 : exact_[0].size();
        for (std::size_t i = 0; i < count; ++i) {
            std::pair<Real, Real> range{1, 1};
            for (std::size_t k = 0, rest = i; k < dofs; ++k, rest /= 3) {
                const auto [low, high] = factorRange(table.motion.dofs[k], int(rest % 3));
                const Real p[] = {range.first * low, range.first * high, range.second * low,
                                  range.second * high};
                range = {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
            }
            ranges_.push_back(range);
        }
        for (const Fold::Feature& f : fold_.features) columns_.push_back(productOf(f, dofs));
        for (const Fold::Feature& f : fold_.sharedFeatures) sharedColumns_.push_back(productOf(f, dofs));
    }

    PairErrors of(std::size_t pair, const Exact& test) const {
        const StoredRow row(prepared_, pair);
        std::vector<Real> left = exact_[pair]; // the exact weights less what is stored
        Real constant = left[0];               // the exact constant where features count from their centres
        std::vector<double> products;          // |w_k| max |feature_k|
        Real away = 0;                         // what the differences of weights amount to at most
        // Features are made in double from factors good to a few units in the last place.
        constexpr Real make = 16 * 0x1p-53L;
        Real making = 0;
        const auto use = [&](const Fold::Feature& f, std::size_t column, double weight) {
            const Real centre = f.centre;
            const Real range = std::max(ranges_[column].second - centre, centre - ranges_[column].first);
            constant += left[column] * centre;
            away += std::abs(left[column] - weight) * range;
            making += make * std::abs(Real(weight)) * (range + 2 * std::abs(centre) + 1e-300L);
            left[column] = 0;
            return double(std::abs(Real(weight)) * range);
        };
        for (std::size_t k = 0; k < columns_.size(); ++k)
            products.push_back(use(fold_.features[k], columns_[k], row[k + 1]));
        double shared = 0;
        for (std::size_t k = 0; k < sharedColumns_.size(); ++k)
            shared += use(fold_.sharedFeatures[k], sharedColumns_[k], fold_.sharedWeights[k]);
        for (std::size_t i = 1; i < left.size(); ++i)
            away += std::abs(left[i]) * std::max(std::abs(ranges_[i].first), std::abs(ranges_[i].second));
        // Rounding of the extended precision itself.
        for (std::size_t i = 0; i < exact_[pair].size(); ++i)
            away += 0x1p-60L * std::abs(exact_[pair][i]) *
                    std::max(std::abs(ranges_[i].first), std::abs(ranges_[i].second));
        const double distance = std::sqrt(double(farthest_[pair]));
        away += Real(std::pow(betweenNodes, double(prepared_.dofCount()))) * (2 * distance + rounding_) *
                rounding_;

        const Real reach2 = Real(test.reach) * std::abs(Real(test.reach));
        const double off = double(Real(row[0]) - (constant - reach2)); // the widening, less than 0
        const double fixed = double((away + making) * (1 + 1e-9L));
        double sum = rounding(row[0], products, shared, 0);
        sum = rounding(row[0], products, shared, 2 * (sum + std::abs(off) + fixed));
        const double farthest = test.reach + prepared_margin();
        const double whole = std::abs(double(Real(row.fromEnd(3)) - constant)) + fixed +
                             rounding(row.fromEnd(3), products, shared, farthest * farthest);
        return {{off - fixed - sum, off + fixed + sum}, whole};
    }

private:
    double prepared_margin() const { return prepared_.margin(); }

    /// Rounding of constant + sum of products, compared with the shared term, where the exact result is at
    /// most `result`: each feature rounds once, each product once, each sum once; no partial sum is larger
    /// than what was added before, nor than the result and what is still to come.
    double rounding(double constant, const std::vector<double>& products, double shared,
                    double result) const {
        double after = shared;
        for (double p : products) after += p;
        double error = 0, before = std::abs(constant);
        for (double p : products) {
            before += p;
            after -= p;
            error += 2 * p + std::min(before, result + after);
        }
        error += 2 * shared + std::min(before + shared, result);
        return u_ * error * (1 + 1e-6);
    }

    const PreparedTable& prepared_;
    const Fold& fold_;
    double u_;
    std::vector<Real> farthest_; ///< of the squared distances that `exact_` was made from, one a test
    std::vector<std::vector<Real>> exact_;
    double rounding_ = 0;                       ///< of the poses that they come from
    std::vector<std::pair<Real, Real>> ranges_; ///< of the products of factors
    std::vector<std::size_t> columns_, sharedColumns_;
};

/// Errors of the direct kernel: x = R b + t - a by axes, |x|^2 - reach^2.
/// posed: how far a point may come out of the pose that the kernel is given.
PairErrors directErrors(const PreparedTable& prepared, std::size_t pair, const Exact& test, double farthest,
                        double posed) {
    const bool single = prepared.precision() == KernelPrecision::Float;
    const double u = single ? 0x1p-24 : 0x1p-53;
    const StoredRow row(prepared, pair);
    const Vec3 b = test.b - prepared.originB(), a = test.a - prepared.originA();
    const double storedA =
        (Vec3(row[3], row[4], row[5]) - a).norm() + 0x1p-52 * (test.a.norm() + prepared.originA().norm());
    const double storedB =
        (Vec3(row[0], row[1], row[2]) - b).norm() + 0x1p-52 * (test.b.norm() + prepared.originB().norm());
    const auto squareError = [&](double distance) {
        const double t = std::min(farthest, a.norm() + b.norm() + distance);
        // The numbers of R and t, each rounded; t - a; three products and their sums, each rounded.
        const double vector =
            storedA + storedB + posed + std::sqrt(3.0) * u * (4 * (t + a.norm()) + 6 * b.norm());
        const double far = distance + vector;
        return 2 * distance * vector + vector * vector + 4 * u * far * far;
    };
    const double reach2 = test.reach * std::abs(test.reach);
    const double off = reach2 - row.fromEnd(3);
    const double error = squareError(std::abs(test.reach) * (1 + 1e-6)) + 2 * u * std::abs(row.fromEnd(3));
    return {{off - error, off + error}, squareError(std::max(0.0, test.reach + prepared.margin()))};
}

/// How far the twelve numbers that the direct kernel reads at some values are from those of the pose between
/// the two origins: points of B no farther than `reach` from its origin come out no farther off.
double poseOff(const PreparedTable& prepared, const ExactPose& at, const TableFeatures& f, double reach) {
    const bool single = prepared.precision() == KernelPrecision::Float;
    const Vector shift = at.at(prepared.originB()) - prepared.originA().cast<Real>();
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

/// The direct kernel's pose at values where every DOF's polynomial is known by them: in double, because
/// rounding to float is counted where the kernel reads. Of more DOFs, and of paths, nothing follows between
/// the values, and what was tried has to do.
class DirectPose {
public:
    DirectPose(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests)
        : motion_(table.motion) {
        PrepareOptions options;
        options.target = prepared.target();
        options.form = KernelForm::Direct;
        options.precision = KernelPrecision::Double;
        options.cells = CellUse::Never;
        const PreparedTable plain(table, options);
        for (const Exact& t : tests) reach_ = std::max(reach_, (t.b - plain.originB()).norm());
        const double size = pathSize(motion_, tests) + plain.originA().norm() + 2 * plain.originB().norm();
        rounding_ = poseRounding(motion_, size, 0x1p-53);
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

    /// What rounding may do to a point on its way, at any values.
    double rounding() const { return rounding_; }
    /// What the kernel does is no more than rounding.
    bool agrees() const { return worst_ <= rounding_; }
    /// The same of what it is given at some values, rounded once more to float.
    bool agreesAt(const PreparedTable& prepared, const ExactPose& at, const TableFeatures& f) const {
        const double u = prepared.precision() == KernelPrecision::Float ? 0x1p-24 : 0;
        return poseOff(prepared, at, f, reach_) <=
               rounding_ + 2 * u * (reach_ + prepared.farthestT()) * (1 + 1e-6) + 1e-300;
    }

private:
    const Motion& motion_;
    double reach_ = 0, rounding_ = 0, worst_ = 0;
};

double tried(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests,
             const std::optional<DirectPose>& direct, std::string& reason) {
    constexpr int poses = 500;
    double worst = 0;
    std::vector<double> share(table.motion.dofCount(), 0.5);
    for (int n = 0; n < poses && reason.empty(); ++n) {
        std::vector<double> q;
        for (std::size_t k = 0; k < share.size(); ++k) {
            share[k] = std::fmod(share[k] + 1 / std::sqrt(double(k) + 2.3), 1.0);
            const Dof& dof = table.motion.dofs[k];
            q.push_back(dof.lower + share[k] * (dof.upper - dof.lower));
        }
        const ExactPose at = exactPose(table.motion, {q.begin(), q.end()});
        Real gap = std::numeric_limits<Real>::infinity();
        for (const Exact& t : tests)
            gap = std::min(gap, (at.at(t.b) - t.a.cast<Real>()).norm() - Real(t.reach));
        TableFeatures f;
        prepared.features(q.data(), f);
        if (direct && !direct->agreesAt(prepared, at, f))
            reason = "at a pose the kernel's rotation or translation is another than the motion's";
        const double own = double(gap), answer = prepared.gap(f).gap;
        if ((own <= 0 && !prepared.hit(f)) || (own > prepared.signBand() && prepared.hit(f)))
            reason = fmt::format("at a pose the gap is {:.6g} and the kernel's verdict is wrong", own);
        if (own > prepared.margin() || own < -prepared.depth()) continue;
        worst = std::max(worst, std::abs(answer - own));
    }
    return worst;
}

} // namespace

KernelVerdict verifyKernel(const Table& table, const PreparedTable& prepared) {
    KernelVerdict verdict;
    const std::vector<Exact> tests = exactTests(table);
    if (tests.size() != prepared.testCount()) {
        verdict.reason = "the kernel has another number of tests than the table";
        return verdict;
    }
    if (tests.empty()) {
        verdict.proven = true;
        return verdict;
    }
    const bool fold = prepared.form() == KernelForm::Fold;
    const double u = prepared.precision() == KernelPrecision::Float ? 0x1p-24 : 0x1p-53;
    std::optional<FoldErrors> foldErrors;
    std::optional<DirectPose> direct;
    if (fold)
        foldErrors.emplace(table, prepared, tests);
    else
        direct.emplace(table, prepared, tests);
    if (direct && !direct->agrees())
        verdict.reason = "the kernel's rotation or translation is another than the motion's";
    for (std::size_t p = 0; p < tests.size() && verdict.reason.empty(); ++p) {
        const Exact& test = tests[p];
        const PairErrors errors =
            fold ? foldErrors->of(p, test)
                 : directErrors(prepared, p, test, prepared.farthestT(), direct->rounding());
        if (errors.sign.high > 0 && test.reach >= 0)
            verdict.reason =
                fmt::format("test {} may miss a touch: its squared distance may be {:.3g} too large", p,
                            errors.sign.high);
        // d^2 - reach^2 <= -low means d <= sqrt(reach^2 - low).
        const double reach = std::max(0.0, test.reach);
        verdict.early =
            std::max(verdict.early, std::sqrt(reach * reach - std::min(0.0, errors.sign.low)) - reach);
        for (double gap : {-prepared.depth(), 0.0, prepared.margin()})
            verdict.gapOff = std::max(verdict.gapOff, gapError(u, errors.square, test.reach, gap));
    }
    if (verdict.reason.empty() && verdict.early > prepared.signBand() * (1 + 1e-6))
        verdict.reason =
            fmt::format("it may report contact {:.3g} before the table does, more than its band of {:.3g}",
                        verdict.early, prepared.signBand());
    if (verdict.reason.empty()) verdict.seen = tried(table, prepared, tests, direct, verdict.reason);
    if (verdict.reason.empty() && verdict.seen > verdict.gapOff)
        verdict.reason = fmt::format("its gap was off by {:.3g} at a pose, more than {:.3g}", verdict.seen,
                                     verdict.gapOff);
    if (verdict.reason.empty()) verdict.reason = verify::refuteCells(table, prepared);
    if (verdict.reason.empty()) verdict.reason = verify::refuteVerdicts(table, prepared);
    verdict.proven = verdict.reason.empty();
    return verdict;
}

} // namespace tss
