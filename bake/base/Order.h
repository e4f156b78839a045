#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tss {

/// 0, 1, ... up to count - 1.
template <class Index = std::uint32_t>
std::vector<Index> indicesOf(std::size_t count) {
    std::vector<Index> all(count);
    std::iota(all.begin(), all.end(), Index{});
    return all;
}

/// Puts values into order and leaves out those that come again.
template <class T>
void sortOnce(std::vector<T>& values) {
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// The value that would stand at a place, from 0 on, if they were in order.
template <class T>
T valueAt(std::vector<T> values, std::size_t place) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(place));
    return values[place];
}

/// The one in the middle, of an even number the later one of two. There is some.
template <class T>
T median(std::vector<T> values) {
    const std::size_t middle = values.size() / 2;
    return valueAt(std::move(values), middle);
}

} // namespace tss
