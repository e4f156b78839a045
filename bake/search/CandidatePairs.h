#pragma once
#include "bake/search/AtRest.h"
#include "bake/table/Table.h"

#include <atomic>

namespace tss {

/// Which sphere pairs can collide somewhere in Q: the paper's collision table Tc (METHOD 2).
struct CandidatePairs {
    std::vector<SpherePair> pairs; ///< sorted; indices into the whole sphere sets
    std::vector<double> restGaps;  ///< per pair: the gap at which contact begins, scene units: 0, or less
                                   ///< where it is excepted at rest (METHOD 2.4); empty: all 0

    bool certified = false;     ///< complete over all of Q, not over samples
    double clearance = 0;       ///< certified and no pairs: the sphere models stay farther apart than this
    std::uint64_t explored = 0; ///< poses (sampled) or cells of Q (certified) looked at
};

/// A set of sphere pairs that threads fill at once: one bit per pair, rows made when first touched.
class ConcurrentPairs {
public:
    ConcurrentPairs(std::size_t spheresA, std::size_t spheresB)
        : rows_(spheresA), words_((spheresB + 63) / 64) {}
    ~ConcurrentPairs();
    ConcurrentPairs(const ConcurrentPairs&) = delete;
    ConcurrentPairs& operator=(const ConcurrentPairs&) = delete;

    void insert(SpherePair pair);
    bool contains(SpherePair pair) const;
    void insertAll(const ConcurrentPairs& other);
    std::vector<SpherePair> sorted() const;

private:
    using Word = std::atomic<std::uint64_t>;
    Word* row(std::uint32_t i);

    std::vector<std::atomic<Word*>> rows_;
    std::size_t words_;
};

} // namespace tss
