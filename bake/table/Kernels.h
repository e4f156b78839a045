#pragma once
#include "bake/table/KernelTarget.h"

#include <cstddef>
#include <cstdint>

namespace tss {

struct ContactTest;
struct MotionFrame;
struct PosePlan;
struct TableContact;

/// Pairs as the kernels read them, floats or doubles. Blocks of `lanes` pairs, each column of a block
/// contiguous; D is the distance of the centres at contact:
///   fold:   [constant - D|D|] [weights of feature 0] ... [constant] [D] [number of the test]
///   direct: [b.x] [b.y] [b.z] [a.x] [a.y] [a.z] [D|D|] [D] [number of the test]
/// The number is an integer of the same width. At least one block; lanes beyond the last pair are far away
/// from everything.
struct KernelData {
    const void* blocks = nullptr;
    const void* end = nullptr;
    std::uint32_t columns = 0; ///< features of the fold
};

/// Which blocks a query looks at (TableCells.h): those whose code is at most `limit`, below 255.
struct NearBlocks {
    static constexpr std::uint32_t codesPerGroup = 16; ///< as many are compared at once
    static constexpr std::uint32_t headerCodes = 2;    ///< that mean something else

    const std::uint8_t* codes = nullptr; ///< the header, then one per block, 255 to the end of the last group
    std::uint32_t groups = 0;
    std::uint8_t limit = 0;
};

struct KernelGap {
    double gap = 0;
    std::int32_t test = -1;
};

/// The queries of one target, form, precision and number of features; plain function pointers, fetched once
/// per table. pose: floats or doubles, first less the fold's shared term (0 for direct), then the features,
/// or the 12 numbers of R and t, row-major.
struct KernelSet {
    std::uint32_t lanes = 1;

    bool (*hit)(const KernelData& data, const void* pose) = nullptr;
    KernelGap (*gap)(const KernelData& data, const void* pose) = nullptr;

    /// Numbers of the tests whose gap is at most `margin` >= 0, in the order of the blocks, into `out` (room
    /// for all lanes of all blocks). Returns how many; lanes beyond the last pair never qualify.
    std::uint32_t (*testsWithin)(const KernelData& data, const void* pose, double margin,
                                 std::uint32_t* out) = nullptr;

    /// The same queries of some blocks only.
    bool (*hitNear)(const KernelData& data, const void* pose, const NearBlocks& near) = nullptr;
    KernelGap (*gapNear)(const KernelData& data, const void* pose, const NearBlocks& near) = nullptr;
    std::uint32_t (*testsWithinNear)(const KernelData& data, const void* pose, const NearBlocks& near,
                                     double margin, std::uint32_t* out) = nullptr;

    /// Many poses at once against data of lanes 1: value k of pose i at poses[k * stride + i], i up to count
    /// rounded up to 16; so much is written, too. hit: 1 or 0.
    void (*hits)(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count,
                 std::uint8_t* hit) = nullptr;

    /// What FeatureForm::evaluate (PoseRecipe::evaluate after a 0, for direct) makes of a plan for it
    /// (PosePlan.h). q: one value per DOF. pose: room for TableFeatures::room values. Null in the scalar
    /// kernels and where vectors are too short for it.
    void (*pose)(const PosePlan& plan, const double* q, void* pose) = nullptr;
    /// The same of many poses at once. q: count rows of one value per DOF; value k of pose i goes to
    /// poses[k * stride + i], stride count rounded up to 16. Null in the scalar kernels.
    void (*poses)(const PosePlan& plan, const double* q, std::uint32_t count, std::uint32_t stride,
                  void* poses) = nullptr;

    /// Everything about one test (Contact.h).
    void (*contact)(const ContactTest& test, const MotionFrame& frame, std::size_t dofs,
                    TableContact& out) = nullptr;
};

inline constexpr std::uint32_t directColumns = 9;
inline constexpr std::uint32_t maxFoldFeatures = 10;
inline constexpr std::uint32_t foldColumns(std::uint32_t features) {
    return features + 4;
}

/// What kernels are made for: a fold of the motion, or direct.
struct KernelShape {
    bool folds = false;
    std::uint32_t features = 0; ///< of the fold, up to maxFoldFeatures
    std::size_t dofs = 0;       ///< of the motion that is folded, up to 3
};

/// The kernels of a target that is available, for T float or double.
template <class T>
KernelSet makeKernels(KernelTarget target, const KernelShape& shape = {});

// Each puts some kernels of a target into the set; what the target or the build has none of is left.

/// lanes, and the queries of one pose and of many.
template <class T>
void addQueries(KernelTarget target, const KernelShape& shape, KernelSet& set);
/// pose and poses.
template <class T>
void addPoses(KernelTarget target, const KernelShape& shape, KernelSet& set);
void addContact(KernelTarget target, KernelSet& set);

} // namespace tss
