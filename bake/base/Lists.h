#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// Lists of different lengths in one block of memory (compressed rows).
template <class T>
class Lists {
public:
    Lists() = default;
    template <class List>
    explicit Lists(const std::vector<List>& lists) {
        for (const List& list : lists) {
            items_.insert(items_.end(), list.begin(), list.end());
            endList();
        }
    }

    /// How many lists there are.
    std::size_t size() const { return start_.size() - 1; }
    std::span<const T> operator[](std::size_t list) const {
        return {items_.data() + start_[list], items_.data() + start_[list + 1]};
    }
    /// The items of all lists, one list after the other.
    const std::vector<T>& items() const { return items_; }
    std::size_t bytes() const { return start_.size() * sizeof(start_[0]) + items_.size() * sizeof(T); }

    /// Appends an item to the list that is being built; endList() completes it.
    void push_back(const T& item) { items_.push_back(item); }
    void endList() { start_.push_back(static_cast<std::uint32_t>(items_.size())); }

    void clear() {
        start_.assign(1, 0);
        items_.clear();
    }

private:
    std::vector<std::uint32_t> start_{0}; ///< #lists + 1: where each begins in items_, and the end
    std::vector<T> items_;
};

} // namespace tss
