#include "bake/search/CandidatePairs.h"

#include <bit>

namespace tss {

ConcurrentPairs::~ConcurrentPairs() {
    for (auto& row : rows_) delete[] row.load();
}

ConcurrentPairs::Word* ConcurrentPairs::row(std::uint32_t i) {
    Word* at = rows_[i].load(std::memory_order_acquire);
    if (at) return at;
    Word* fresh = new Word[words_]();
    if (rows_[i].compare_exchange_strong(at, fresh)) return fresh;
    delete[] fresh;
    return at;
}

void ConcurrentPairs::insert(SpherePair pair) {
    const std::uint64_t bit = std::uint64_t{1} << (pair.b % 64);
    Word& word = row(pair.a)[pair.b / 64];
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
}

bool ConcurrentPairs::contains(SpherePair pair) const {
    const Word* at = rows_[pair.a].load(std::memory_order_acquire);
    return at && (at[pair.b / 64].load(std::memory_order_relaxed) >> (pair.b % 64) & 1);
}

void ConcurrentPairs::insertAll(const ConcurrentPairs& other) {
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
        const Word* from = other.rows_[i].load();
        if (!from) continue;
        Word* to = row(i);
        for (std::size_t w = 0; w < words_; ++w) to[w].fetch_or(from[w].load());
    }
}

std::vector<SpherePair> ConcurrentPairs::sorted() const {
    std::vector<SpherePair> pairs;
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
        const Word* at = rows_[i].load();
        for (std::uint32_t w = 0; at && w < words_; ++w)
            for (std::uint64_t bits = at[w].load(); bits; bits &= bits - 1)
                pairs.push_back({i, 64 * w + static_cast<std::uint32_t>(std::countr_zero(bits))});
    }
    return pairs;
}

} // namespace tss
