#pragma once
#include "bake/table/ContactTest.h"
#include "bake/table/Kernels.h"
#include "bake/table/PoseLanes.h"
#include "bake/table/PosePlan.h"
#include "bake/table/PreparedTable.h"
#include "bake/table/TableCells.h"
#include "bake/table/TableClusters.h"

#include <optional>

namespace tss {

/// What a PreparedTable asks where the values of the DOFs alone do not tell: the tests as the kernels read
/// them, how rounding was answered for, and what leaves tests out. Its queries are those of PreparedTable,
/// which says what they promise.
class TableKernels {
public:
    TableKernels(const Table& table, const PrepareOptions& options);
    TableKernels(const TableKernels&) = delete;
    TableKernels& operator=(const TableKernels&) = delete;

    void features(const double* q, TableFeatures& out) const;
    void features(const PoseRecipe::Matrix& pose, TableFeatures& out) const;

    bool hit(const TableFeatures& f) const {
        if (cells_.empty()) return clusters_.empty() ? kernels_.hit(data_, f.doubles) : hitInClusters(f);
        if (cells_.allTouch(f.cell)) return true;
        return kernels_.hitNear(data_, f.doubles, cells_.nearBlocks(f.cell, TableCells::contactCode));
    }

    /// Where the verdict cells do not tell.
    bool hit(const double* q) const;

    TableGap gap(const TableFeatures& f) const {
        const KernelGap g = nearest(f);
        return {g.gap, g.test};
    }

    /// For an empty table only gap (infinity) and test (-1) mean anything.
    void contact(const TableFeatures& f, const MotionFrame& frame, TableContact& out) const;
    void frame(const double* q, MotionFrame& out) const;
    std::uint32_t testsWithin(const TableFeatures& f, double margin, std::uint32_t* out) const;
    std::uint32_t testsWithin(const double* q, double margin, std::uint32_t* out) const;

    void instanceFeatures(const double* q, std::uint32_t count, InstanceFeatures& out) const;
    void hits(const InstanceFeatures& f, std::uint8_t* hit) const;

    /// B to A in as many configurations from where their bodies are: of the direct form without cells only,
    /// as the next.
    void features(const BodyLanes& a, const BodyLanes& b, PoseLanes& out) const {
        laneKernels_.between(a, originA_, b, originB_, float_, out);
    }
    /// A bit for each pose at which some test touches, of those that have one in `asked`.
    std::uint32_t hits(const PoseLanes& poses, std::uint32_t asked) const;

    /// What tests are compared with where gaps up to the margin are asked for.
    double reachOf(double margin) const;

    std::size_t testCount() const { return tests_.size(); }
    std::size_t testRoom() const { return room_; }
    std::size_t dofCount() const { return motion_.dofCount(); }
    const Motion& motion() const { return motion_; }
    TablePair test(std::size_t number) const { return tests_[number]; }
    const TableCells& cells() const { return cells_; } ///< empty where they do not pay
    const TableClusters& clusters() const {
        return clusters_;
    } ///< empty for few tests and where there are cells

    KernelForm form() const { return form_; }
    KernelPrecision precision() const { return float_ ? KernelPrecision::Float : KernelPrecision::Double; }
    KernelTarget target() const { return target_; }
    /// Features a pose has: columns without the constant and the shared term; 12 for direct.
    std::size_t featureCount() const { return fold_ ? fold_->features.size() : 12; }
    std::size_t bytes() const;

    double signBand() const { return signBand_; }
    double gapBand() const { return gapBand_; }
    /// Condition of the worst test with this form of kernel: by how many roundoffs of its squared contact
    /// distance the squared distance may be off near contact. Infinite where a contact distance is 0.
    double condition() const { return condition_; }

    /// For those who check it (verify): the band in which gaps are right, and what the kernels read.
    double depth() const { return depth_; }
    double margin() const { return margin_; }
    const std::optional<FeatureForm>& fold() const { return fold_; } ///< nothing for the direct form
    const KernelData& blocks() const { return data_; }               ///< all tests in blocks of lanes()
    const KernelData& rows() const { return rows_; } ///< one after the other; none where there are clusters
    /// Some rows, one after the other and in blocks of lanes().
    struct BoundRows {
        const KernelData &rows, &blocks;
    };
    /// Bounds of a level of clusters().
    BoundRows boundsOf(std::size_t level) const { return {bounds_[level].rows, bounds_[level].blocks}; }
    /// Tests that a table in clusters asks first (LikelyTests.h), and their rows.
    const std::vector<std::uint32_t>& likely() const { return likely_; }
    BoundRows likelyTests() const { return {likelyRows_, likelyData_}; }
    const LaneKernels& laneKernels() const { return laneKernels_; }
    std::uint32_t lanes() const { return kernels_.lanes; }
    const Vec3& originA() const { return originA_; }
    const Vec3& originB() const { return originB_; }
    double farthestT() const { return farthestT_; } ///< bound of |T(q) originB - originA|

private:
    struct alignas(64) Chunk {
        std::array<std::byte, 64> bytes;
    };
    struct Bands {
        double sign = 0, gap = 0, condition = 0;
        std::vector<double>
            widening; ///< per test: what its squared contact distance gains, so that rounding misses nothing
        void widen(double u, double error, double contactDistance);
    };

    KernelGap nearest(const TableFeatures& f) const {
        if (cells_.empty()) return clusters_.empty() ? kernels_.gap(data_, f.doubles) : nearestInClusters(f);
        const std::uint8_t reached = cells_.reachedCode(f.cell);
        return reached == TableCells::farCode
                   ? kernels_.gap(data_, f.doubles)
                   : kernels_.gapNear(data_, f.doubles, cells_.nearBlocks(f.cell, reached));
    }
    /// Some whole blocks of rows.
    KernelData blocksOf(const KernelData& data, std::size_t rowsEach, std::uint32_t part) const;
    /// Bounds of the level below that number `group` of a level of clusters bounds.
    KernelData boundsIn(std::size_t level, std::uint32_t group) const;
    KernelData testsOf(std::uint32_t cluster) const;
    /// Calls take(cluster) for each that may have a test under the margin, until it returns true. The margin
    /// may become smaller in between.
    template <class Take>
    void eachNearCluster(const TableFeatures& f, const double& margin, const Take& take) const;
    /// The same of these bounds of a level. Returns whether it ended early.
    template <class Take>
    bool eachNear(std::size_t level, const KernelData& bounds, const TableFeatures& f, const double& margin,
                  const Take& take) const;
    bool hitInClusters(const TableFeatures& f) const;
    bool hitBeyondLikely(const TableFeatures& f) const;
    std::uint32_t hitsOf(const KernelData& rows, const PoseLanes& poses) const;
    KernelGap nearestInClusters(const TableFeatures& f) const;
    std::uint32_t testsInClusters(const TableFeatures& f, double margin, double wide,
                                  std::uint32_t* out) const;
    /// What the bounds of clusters are compared with where gaps of tests up to the margin are asked for.
    double clusterReachOf(double margin) const;
    void poseFeatures(const double* q, TableFeatures& out) const;
    void storePose(const PoseRecipe::Matrix& pose, TableFeatures& out) const;
    void chooseOrigins(std::span<const TablePair> pairs, std::span<const std::vector<double>> contacts);
    void makeFold(std::span<const TablePair> pairs, std::span<const std::vector<double>> contacts);
    /// Throws InputError where squares of lengths would not be numbers.
    void checkReach(std::span<const TablePair> pairs) const;
    Bands foldBands(double u, std::span<const TablePair> pairs) const;
    Bands directBands(double u, std::span<const TablePair> pairs) const;
    /// Form and precision. Returns by how much each test's squared contact distance is widened.
    std::vector<double> choose(const PrepareOptions& options, std::span<const TablePair> pairs);
    /// Pairs and by how much their squared reaches are widened.
    struct Widened {
        std::span<const TablePair> pairs;
        std::span<const double> by;
    };
    /// Lays rows out in blocks of `lanes` as the kernels read them (KernelData); the last block is filled up
    /// with rows that are far away. order: of the rows; empty: all as they come.
    template <class T>
    void fill(const Widened& rows, std::uint32_t lanes, std::span<const std::uint32_t> order,
              std::vector<Chunk>& store, KernelData& data) const;
    template <class T>
    void prepareKernels(CellUse use, const Widened& tests);
    void makeCells(CellUse use, std::span<const TablePair> pairs);
    template <class T>
    void fillClusters();
    template <class T>
    void fillLikely(const Widened& tests);

    Motion motion_;
    TableTests tests_;
    std::vector<ContactTest>
        contactTests_; ///< none where there are clusters: they would take most of the memory
    double epsilon_ = 0, depth_ = 0, margin_ = 0, early_ = 0;
    Vec3 originA_ = Vec3::Zero(), originB_ = Vec3::Zero();
    double farthestT_ = 0; ///< bound of |T(q) originB - originA|
    double turnError_ = 0; ///< of turns of many radians
    double poseError_ =
        0; ///< what rounding, or whoever gives the pose, may do to T(q) y on its way to the direct kernel
    std::optional<FeatureForm> fold_;
    PoseRecipe recipe_;
    PosePlan plan_; ///< of the form that was chosen; empty for the direct one of a path or of no DOF

    KernelForm form_ = KernelForm::Direct;
    KernelTarget target_ = KernelTarget::Scalar;
    bool float_ = true;
    double signBand_ = 0, gapBand_ = 0, condition_ = 0;
    std::size_t room_ = 0;

    /// Rows as vectors of poses read them, and in blocks.
    struct StoredRows {
        std::vector<Chunk> store, rowStore;
        KernelData blocks, rows;
    };

    std::vector<Chunk> blocks_, rowStore_, likelyStore_, likelyRowStore_;
    std::vector<StoredRows> bounds_; ///< a level of clusters each
    KernelSet kernels_;
    LaneKernels laneKernels_;
    KernelData data_, rows_, likelyData_, likelyRows_;
    std::vector<std::uint32_t> likely_;
    TableCells cells_;
    TableClusters clusters_;
    double clusterBand_ = 0; ///< what rounding may do to the gap of a cluster's bound
};

} // namespace tss
