#pragma once
#include "bake/table/Table.h"

#include <atomic>

namespace tss {

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
