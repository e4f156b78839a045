#include "bake/search/SampledSearch.h"

#include "bake/base/Parallel.h"
#include "bake/search/ExploredPoses.h"
#include "bake/search/TreePair.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>

namespace tss {

namespace {

/// A set of sphere pairs that threads fill at once: one bit a pair, rows made when first touched.
class PairBits {
public:
    PairBits(std::size_t rows, std::size_t columns) : rows_(rows), words_((columns + 63) / 64) {}

    ~PairBits() {
        for (auto& row : rows_) delete[] row.load();
    }

    void insert(std::uint32_t i, std::uint32_t j) {
        Word* row = rows_[i].load(std::memory_order_acquire);
        if (!row) row = make(rows_[i]);
        const std::uint64_t bit = std::uint64_t{1} << (j % 64);
        Word& word = row[j / 64];
        if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
    }

    std::vector<SpherePair> sorted() const {
        std::vector<SpherePair> pairs;
        for (std::uint32_t i = 0; i < rows_.size(); ++i) {
            const Word* row = rows_[i].load();
            for (std::uint32_t w = 0; row && w < words_; ++w)
                for (std::uint64_t bits = row[w].load(); bits; bits &= bits - 1)
                    pairs.push_back({i, 64 * w + static_cast<std::uint32_t>(std::countr_zero(bits))});
        }
        return pairs;
    }

private:
    using Word = std::atomic<std::uint64_t>;

    Word* make(std::atomic<Word*>& slot) {
        Word* fresh = new Word[words_]();
        Word* expected = nullptr;
        if (slot.compare_exchange_strong(expected, fresh)) return fresh;
        delete[] fresh;
        return expected;
    }

    std::vector<std::atomic<Word*>> rows_;
    std::size_t words_;
};

} // namespace

CandidatePairs searchSampled(const SphereSet& a, const SphereSet& b, const Motion& motion,
                             const SampledSearchOptions& options, const Progress& progress) {
    CandidatePairs result;
    const ContactRule rule(a, b, motion, options.atRest);
    result.atRest = rule.atRest();

    const SphereTree treeA(a), treeB(b);
    const auto poses = exploredPoses(motion, options.samples, options.seed);
    std::vector<char> hit(poses.size(), 0);
    PairBits found(a.size(), b.size());
    constexpr std::size_t batch = 256;
    for (std::size_t first = 0; first < poses.size(); first += batch) {
        if (!report(progress, "sampled search", double(first) / double(poses.size()))) break;
        const std::size_t count = std::min(batch, poses.size() - first);
        parallelFor(count, [&](std::size_t k) {
            visitPairsWithin(treeA, treeB, pose(motion, poses[first + k]), 0,
                             [&](std::uint32_t i, std::uint32_t j, double gap) {
                                 if (!rule.touches({i, j}, gap)) return;
                                 found.insert(i, j);
                                 hit[first + k] = 1;
                             });
        });
        result.explored += count;
    }
    report(progress, "sampled search", 1);

    result.colliding = static_cast<std::uint64_t>(std::count(hit.begin(), hit.end(), 1));
    result.pairs = found.sorted();
    result.restGaps = rule.thresholds(result.pairs);
    countSpheres(result);
    return result;
}

} // namespace tss
