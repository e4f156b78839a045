#include "bake/table/TableKernels.h"

#include "bake/base/Error.h"
#include "bake/table/LikelyTests.h"
#include "bake/table/RoundingBand.h"
#include "bake/table/Table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace tss {

namespace {

/// What stands for a pair that is none: never under a margin, farther than any other.
constexpr double farOffset = 3e37, farContact = -1e18;

/// Cells pay for more blocks than this, where a query looks at this share of them on average, at most; of
/// more tests than that they would be too few.
constexpr std::uint32_t fewBlocks = 4;
/// Clusters, over more DOFs than cells are good for, pay for more blocks than this.
constexpr std::uint32_t fewClustered = 32;
constexpr std::size_t mostDofsOfCells = 3;
constexpr double mostLooked = 0.6;
constexpr std::size_t mostTests = 1 << 16;
/// Tests that are asked first, and poses that they are chosen by.
constexpr std::size_t mostLikely = 16;
constexpr int likelyPoses = 512;

/// Poses at which the bodies are nearest to touching, by some of very many pairs: a twentieth of a lattice
/// over the limits.
std::vector<std::vector<double>> nearContact(const Motion& motion, const std::vector<TablePair>& pairs) {
    const int count = std::clamp(static_cast<int>(1000000 / (pairs.size() + 1)), 64, 2000);
    const std::vector<std::vector<double>> poses = latticePoses(motion, count);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Pose at = pose(motion, poses[i]);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < pairs.size(); p += 1 + pairs.size() / mostTests)
            least = std::min(least, centreDistance(pairs[p], at) - pairs[p].contactDistance);
        order.push_back({std::abs(least), i});
    }
    std::sort(order.begin(), order.end());
    std::vector<std::vector<double>> contacts;
    for (std::size_t i = 0; i < order.size() / 20 + 1; ++i) contacts.push_back(poses[order[i].second]);
    return contacts;
}

/// Error of a squared distance as roundoffs of the squared contact distance.
double conditionOf(double u, double error, double contactDistance) {
    return contactDistance != 0 ? error / (u * contactDistance * contactDistance)
                                : std::numeric_limits<double>::infinity();
}

template <class T>
T* column(T* block, std::uint32_t lanes, std::uint32_t k) {
    return block + std::size_t(k) * lanes;
}

} // namespace

TableKernels::TableKernels(const Table& table, const PrepareOptions& options)
    : motion_(table.motion), tests_(table), epsilon_(table.epsilon), depth_(table.gapDepth),
      margin_(table.gapMargin), early_(earlyOfTable(table).value_or(0)) {
    if (!available(options.target))
        throw InputError("kernel '" + std::string(name(options.target)) +
                         "': expected one that this build and this processor have");
    target_ = options.target == KernelTarget::Best ? bestTarget() : options.target;
    if (motion_.dofCount() > maxDofs)
        throw InputError("table: expected at most " + std::to_string(maxDofs) + " DOFs");

    const std::vector<TablePair> pairs = tablePairs(table);
    const std::vector<std::vector<double>> contacts = nearContact(motion_, pairs);
    chooseOrigins(pairs, contacts);
    checkReach(pairs);
    recipe_ = PoseRecipe(motion_, originA_, originB_);
    double farthest = std::max(originA_.norm(), originB_.norm());
    for (const TablePair& p : pairs) farthest = std::max({farthest, p.a.norm(), p.b.norm()});
    for (const Sphere& b : table.b) turnError_ = std::max(turnError_, turnError(motion_, b.centre));
    poseError_ = std::max(poseError(motion_, doubleRoundoff, farthest) + turnError_, options.poseError);

    if (options.form != KernelForm::Direct) makeFold(pairs, contacts);
    const std::vector<double> widening = choose(options, pairs);
    const Widened tests{pairs, widening};
    if (float_)
        prepareKernels<float>(options.cells, tests);
    else
        prepareKernels<double>(options.cells, tests);
}

/// Both origins where the touching is, so that T(q) originB - originA and the centres are small there.
void TableKernels::chooseOrigins(std::span<const TablePair> pairs,
                                 std::span<const std::vector<double>> contacts) {
    for (const TablePair& p : pairs) originB_ += p.b / double(pairs.size());
    for (const std::vector<double>& q : contacts)
        originA_ += pose(motion_, q) * originB_ / double(contacts.size());
    MotionFrame middle;
    DofValues q{}, speeds{}, way{};
    for (std::size_t k = 0; k < motion_.dofCount(); ++k)
        q[k] = motion_.dofs[k].lower + 0.5 * (motion_.dofs[k].upper - motion_.dofs[k].lower);
    evaluateFrame(motion_, q.data(), way.data(), middle);
    speedBounds(motion_, originB_, speeds.data());
    farthestT_ = (middle.pose * originB_ - originA_).norm();
    for (std::size_t k = 0; k < motion_.dofCount(); ++k)
        farthestT_ += 0.5 * speeds[k] * (motion_.dofs[k].upper - motion_.dofs[k].lower);
}

/// The fold, where there is one that is right: features centred near contact round better, unless that leaves
/// their far end too far away.
void TableKernels::makeFold(std::span<const TablePair> pairs, std::span<const std::vector<double>> contacts) {
    fold_ = makeFeatureForm(motion_, pairs, contacts);
    if (!fold_ || pairs.empty()) return;
    const double centred = foldBands(floatRoundoff, pairs).sign;
    std::optional<FeatureForm> plain = makeFeatureForm(motion_, pairs, {});
    std::swap(fold_, plain);
    if (foldBands(floatRoundoff, pairs).sign >= centred) std::swap(fold_, plain);
    double largest = 0;
    const std::vector<std::vector<double>> poses = latticePoses(motion_, 50);
    for (const std::vector<double>& q : poses) {
        const Pose at = pose(motion_, q);
        for (const TablePair& p : pairs) largest = std::max(largest, (at * p.b - p.a).squaredNorm());
    }
    if (!(featureFormMismatch(*fold_, motion_, pairs, poses) <= 1e-11 * largest)) fold_.reset();
}

void TableKernels::checkReach(std::span<const TablePair> pairs) const {
    double reach = farthestT_;
    for (const TablePair& p : pairs)
        reach =
            std::max({reach, (p.a - originA_).norm(), (p.b - originB_).norm(), std::abs(p.contactDistance)});
    if (!(reach <= longestLength))
        throw InputError(
            fmt::format("table: expected spheres that stay within {:g} scene units of each other, "
                        "found {:g}; with larger units (metersPerUnit) numbers are smaller",
                        longestLength, reach));
}

void TableKernels::Bands::widen(double u, double error, double contactDistance) {
    // A little more, for the rounding of the widened constant itself.
    widening.push_back(1.001 * error);
    sign = std::max(sign, tss::signBand(2.002 * error, contactDistance));
    condition = std::max(condition, conditionOf(u, error, contactDistance));
}

TableKernels::Bands TableKernels::foldBands(double u, std::span<const TablePair> pairs) const {
    Bands bands;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const double contactDistance = pairs[p].contactDistance;
        const auto turned = [&](double distance) { return (2 * distance + turnError_) * turnError_; };
        const double sign = fold_->signError(u, Eigen::Index(p), contactDistance);
        bands.widen(u, sign + turned(std::abs(contactDistance)), contactDistance);
        for (double gap : {-depth_, 0.0, margin_}) {
            const double distance = std::max(0.0, contactDistance + gap);
            const double error = fold_->squareError(u, Eigen::Index(p), distance) + turned(distance);
            bands.gap = std::max(bands.gap, tss::gapBand(u, error, contactDistance, gap));
        }
    }
    return bands;
}

TableKernels::Bands TableKernels::directBands(double u, std::span<const TablePair> pairs) const {
    Bands bands;
    for (const TablePair& p : pairs) {
        const double a = (p.a - originA_).norm(), b = (p.b - originB_).norm();
        // The pose is worked out in double, whatever reads it.
        const auto posed = [&](double distance) {
            return (2 * (distance + poseError_) + poseError_) * poseError_;
        };
        const double sign = directError(u, a, b, farthestT_, std::abs(p.contactDistance), p.contactDistance) +
                            posed(std::abs(p.contactDistance));
        bands.widen(u, sign, p.contactDistance);
        for (double gap : {-depth_, 0.0, margin_}) {
            const double distance = std::max(0.0, p.contactDistance + gap);
            const double error =
                directError(u, a, b, farthestT_, distance, p.contactDistance) + posed(distance);
            bands.gap = std::max(bands.gap, tss::gapBand(u, error, p.contactDistance, gap));
        }
    }
    return bands;
}

std::vector<double> TableKernels::choose(const PrepareOptions& options, std::span<const TablePair> pairs) {
    if (options.form == KernelForm::Fold && !fold_)
        throw InputError("kernel: expected a motion that folds: no path, at most 3 DOFs, few features");
    // A lossless table has no epsilon to hide rounding in. Rounding misses nothing (Bands::widen), and
    // reports early by a band that is stated and kept far below what the spheres themselves are early by.
    double allowed = 0.1 * epsilon_;
    if (epsilon_ == 0) {
        allowed = std::numeric_limits<double>::infinity();
        for (const TablePair& p : pairs) allowed = std::min(allowed, 1e-4 * (p.radiusA + p.radiusB));
        allowed = std::max(allowed, 0.01 * early_);
    }
    struct Choice {
        KernelForm form;
        bool single;
    };
    const Choice order[] = {{KernelForm::Fold, true},
                            {KernelForm::Direct, true},
                            {KernelForm::Fold, false},
                            {KernelForm::Direct, false}};
    bool any = false;
    Bands bands;
    for (const Choice& choice : order) {
        if (choice.form == KernelForm::Fold && !fold_) continue;
        if (options.form && *options.form != choice.form) continue;
        if (options.precision && (*options.precision == KernelPrecision::Float) != choice.single) continue;
        // Features are made in double: rounded to float once, but some times over in double itself.
        const double u = choice.single ? floatRoundoff : 8 * doubleRoundoff;
        Bands here = choice.form == KernelForm::Fold ? foldBands(u, pairs) : directBands(u, pairs);
        if (any && !(here.sign < bands.sign)) continue;
        any = true;
        bands = std::move(here);
        form_ = choice.form;
        float_ = choice.single;
        if (std::max(bands.sign, bands.gap) <= allowed) break;
    }
    signBand_ = bands.sign;
    gapBand_ = bands.gap;
    condition_ = bands.condition;
    if (form_ == KernelForm::Direct) fold_.reset();
    return std::move(bands.widening);
}

template <class T>
void TableKernels::fill(const Widened& rows, std::uint32_t lanes, std::span<const std::uint32_t> order,
                        std::vector<Chunk>& store, KernelData& data) const {
    using Number = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    data.columns = fold_ ? std::uint32_t(fold_->features.size()) : 0;
    const std::uint32_t columns = fold_ ? foldColumns(data.columns) : directColumns;
    const std::size_t size = order.empty() ? rows.pairs.size() : order.size();
    const std::size_t count = std::max<std::size_t>(1, (size + lanes - 1) / lanes);
    const std::size_t step = std::size_t(columns) * lanes;
    store.assign((count * step * sizeof(T) + sizeof(Chunk) - 1) / sizeof(Chunk), Chunk{});
    T* blocks = reinterpret_cast<T*>(store.data());
    data.blocks = blocks;
    data.end = blocks + count * step;
    for (std::size_t place = 0; place < count * lanes; ++place) {
        T* block = blocks + place / lanes * step + place % lanes;
        const bool real = place < size;
        const std::size_t i = real && !order.empty() ? order[place] : place;
        const double contactDistance = real ? rows.pairs[i].contactDistance : farContact;
        *column(block, lanes, columns - 1) = std::bit_cast<T>(real ? Number(i) : Number(-1));
        *column(block, lanes, columns - 2) = T(contactDistance);
        if (fold_) {
            const double constant = real ? fold_->constants(Eigen::Index(i)) : 0;
            block[0] =
                T(real ? constant - contactDistance * std::abs(contactDistance) - rows.by[i] : farOffset);
            for (std::uint32_t k = 0; k < data.columns && real; ++k)
                *column(block, lanes, k + 1) = T(fold_->weights(Eigen::Index(i), k));
            *column(block, lanes, columns - 3) = T(constant);
            continue;
        }
        for (int k = 0; k < 3 && real; ++k) {
            *column(block, lanes, std::uint32_t(k)) = T(rows.pairs[i].b[k] - originB_[k]);
            *column(block, lanes, std::uint32_t(k) + 3) = T(rows.pairs[i].a[k] - originA_[k]);
        }
        *column(block, lanes, columns - 3) =
            T(real ? contactDistance * std::abs(contactDistance) + rows.by[i] : -farOffset);
    }
}

void TableKernels::makeCells(CellUse use, std::span<const TablePair> pairs) {
    if (use == CellUse::Never || pairs.empty()) return;
    const std::size_t blocks = (pairs.size() + kernels_.lanes - 1) / kernels_.lanes;
    const auto inClusters = [&] {
        if (use == CellUse::Auto && !fold_ && blocks > fewClustered)
            clusters_ = TableClusters(pairs, kernels_.lanes);
        return !clusters_.empty();
    };
    const bool many = motion_.dofCount() > mostDofsOfCells || pairs.size() > mostTests;
    if (many && inClusters()) return;
    // To look up a cell costs as much as a few blocks.
    const std::size_t least = std::size_t(fewBlocks) * kernels_.lanes;
    if (use == CellUse::Auto && (pairs.size() <= least || pairs.size() > mostTests)) return;
    TableCells cells(motion_, pairs, kernels_.lanes);
    if (use == CellUse::Always || cells.looked() <= mostLooked)
        cells_ = std::move(cells);
    else
        inClusters();
}

template <class T>
void TableKernels::fillClusters() {
    const double u = float_ ? floatRoundoff : 8 * doubleRoundoff;
    for (const std::vector<TablePair>& pairs : clusters_.levels()) {
        const Bands bands = directBands(u, pairs);
        clusterBand_ = std::max({clusterBand_, bands.sign, bands.gap});
        StoredRows& level = bounds_.emplace_back();
        fill<T>({pairs, bands.widening}, kernels_.lanes, {}, level.store, level.blocks);
        fill<T>({pairs, bands.widening}, 1, {}, level.rowStore, level.rows);
    }
}

template <class T>
void TableKernels::fillLikely(const Widened& tests) {
    std::vector<TouchingPose> touching;
    TableFeatures f;
    for (const std::vector<double>& q : latticePoses(motion_, likelyPoses)) {
        poseFeatures(q.data(), f);
        if (!hitBeyondLikely(f)) continue;
        touching.push_back({pose(motion_, q), static_cast<std::uint32_t>(nearestInClusters(f).test)});
    }
    likely_ = tss::likelyTests(tests.pairs, touching, mostLikely);
    if (likely_.empty()) likely_ = {0}; // any
    fill<T>(tests, kernels_.lanes, likely_, likelyStore_, likelyData_);
    fill<T>(tests, 1, likely_, likelyRowStore_, likelyRows_);
}

template <class T>
void TableKernels::prepareKernels(CellUse use, const Widened& tests) {
    KernelShape shape;
    if (fold_) shape = {true, std::uint32_t(fold_->features.size()), motion_.dofCount()};
    kernels_ = makeKernels<T>(target_, shape);
    if (fold_)
        plan_ = PosePlan(*fold_);
    else if (recipe_.affine())
        plan_ = PosePlan(recipe_);
    else
        kernels_.pose = nullptr, kernels_.poses = nullptr;
    makeCells(use, tests.pairs);
    fill<T>(tests, kernels_.lanes, clusters_.empty() ? cells_.order() : clusters_.order(), blocks_, data_);
    laneKernels_ = tss::laneKernels(target_);
    if (clusters_.empty()) {
        fill<T>(tests, 1, {}, rowStore_, rows_);
        std::ranges::transform(tests.pairs, std::back_inserter(contactTests_), contactTest);
    } else {
        fillClusters<T>();
        fillLikely<T>(tests);
    }
    room_ = std::max<std::size_t>(1, (tests_.size() + kernels_.lanes - 1) / kernels_.lanes) * kernels_.lanes;
}

std::size_t TableKernels::bytes() const {
    std::size_t chunks = blocks_.size() + likelyStore_.size();
    for (const StoredRows& level : bounds_) chunks += level.store.size();
    return chunks * sizeof(Chunk) + cells_.bytes();
}

} // namespace tss
