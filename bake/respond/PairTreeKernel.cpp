// How a tree of pairs is gone through, in vectors of its spheres.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/respond/PairTreeKernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/respond/PairTree.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::uint32_t fan = PairTree::fan;
using Floats = hn::CappedTag<float, fan>;
using V = hn::Vec<Floats>;

HWY_INLINE V all(float value) {
    return hn::Set(Floats(), value);
}

struct Ball {
    float x, y, z, r;
};

HWY_INLINE Ball ballOf(const PairTree::Block& block, std::uint32_t lane) {
    return {block.x[lane], block.y[lane], block.z[lane], block.r[lane]};
}

/// A bit for each sphere of the block that is no farther from the ball than the ball's radius.
HWY_INLINE std::uint32_t nearOf(const PairTree::Block& block, const Ball& ball) {
    const Floats d;
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < fan; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        const V x = hn::Sub(hn::Load(d, block.x + i), all(ball.x));
        const V y = hn::Sub(hn::Load(d, block.y + i), all(ball.y));
        const V z = hn::Sub(hn::Load(d, block.z + i), all(ball.z));
        const V reach = hn::Add(hn::Load(d, block.r + i), all(ball.r));
        const V square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, hn::Le(square, hn::Mul(reach, hn::Abs(reach))), bytes);
        bits |= std::uint32_t(bytes[0]) << i;
    }
    return bits;
}

/// B's spheres in A's frame, each larger by the reach.
HWY_INLINE void move(const PairTree::Block& block, const PairTree::Question& question, PairTree::Block& out) {
    const Floats d;
    const float* p = question.pose;
    for (std::uint32_t i = 0; i < fan; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        const V x = hn::Load(d, block.x + i), y = hn::Load(d, block.y + i), z = hn::Load(d, block.z + i);
        const auto row = [&](const float* r) {
            return hn::MulAdd(all(r[0]), x, hn::MulAdd(all(r[1]), y, hn::MulAdd(all(r[2]), z, all(r[3]))));
        };
        hn::Store(row(p), d, out.x + i);
        hn::Store(row(p + 4), d, out.y + i);
        hn::Store(row(p + 8), d, out.z + i);
        hn::Store(hn::Add(hn::Load(d, block.r + i), all(question.reach)), d, out.r + i);
    }
}

struct Walk {
    const PairTree& tree;
    const PairTree::Question& question;
    std::uint32_t* out;
    std::uint32_t count = 0;

    /// Block a of A, which the ball bounds, against block b of B. Returns whether that is enough.
    bool visit(std::size_t level, std::uint32_t a, const Ball& boundA, std::uint32_t b) {
        const bool leaves = level + 1 == tree.a().levels.size();
        const PairTree::LeafTests* tests = leaves ? tree.leafTests(a, b) : nullptr;
        if (leaves && !tests) return false;
        const PairTree::Block& blockA = tree.a().levels[level][a];
        PairTree::Block moved;
        move(tree.b().levels[level][b], question, moved);
        for (std::uint32_t near = nearOf(moved, boundA); near != 0; near &= near - 1) {
            const std::uint32_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(near);
            for (std::uint32_t both = nearOf(blockA, ballOf(moved, lane)); both != 0; both &= both - 1) {
                const std::uint32_t other = hwy::Num0BitsBelowLS1Bit_Nonzero32(both);
                if (!leaves) {
                    if (visit(level + 1, fan * a + other, ballOf(blockA, other), fan * b + lane)) return true;
                } else if (const std::int32_t test = (*tests)[fan * lane + other]; test >= 0) {
                    out[count++] = static_cast<std::uint32_t>(test);
                }
            }
        }
        return count > question.enough;
    }
};

std::uint32_t ask(const PairTree& tree, const PairTree::Question& question, std::uint32_t* out) {
    Walk walk{tree, question, out};
    walk.visit(0, 0, ballOf(tree.a().root, 0), 0);
    return walk.count;
}

PairTree::Kernel kernel() {
    return ask;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

PairTree::Kernel pairTreeKernel(KernelTarget target) {
    TSS_TARGETS(kernel())
    return HWY_STATIC_DISPATCH(kernel)(); // what this build may always use
}

} // namespace tss
#endif
