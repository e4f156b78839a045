// The binned surface area heuristic of Wald, "On fast construction of SAH-based bounding volume hierarchies",
// 2007.
#include "bake/geometry/Bvh.h"

#include "bake/base/Order.h"

#include <algorithm>

namespace tss {

namespace {

using Box = Eigen::AlignedBox3d;

constexpr int binCount = 16;
constexpr int deepest =
    100; // below visitNearest's stack; splits in the middle from depth 60 on keep under it

double halfArea(const Box& box) {
    if (box.isEmpty()) return 0;
    const Vec3 s = box.sizes();
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

struct Split {
    int axis = -1;
    int bin = 0;
    double cost = infinity;
};

class Builder {
public:
    Builder(std::span<const Box> boxes, std::uint32_t leafSize, const std::function<bool()>& stop)
        : boxes_(boxes), leafSize_(leafSize), stop_(stop) {
        bvh_.items = indicesOf(boxes.size());
        bvh_.nodes.reserve(boxes.size());
    }

    Bvh build() {
        bvh_.nodes.emplace_back();
        subdivide(0, 0, static_cast<std::uint32_t>(boxes_.size()), 0);
        return std::move(bvh_);
    }

private:
    void subdivide(std::uint32_t index, std::uint32_t first, std::uint32_t count, int depth) {
        Box box, centres;
        for (std::uint32_t i = first; i < first + count; ++i) {
            box.extend(boxes_[bvh_.items[i]]);
            centres.extend(boxes_[bvh_.items[i]].center());
        }
        bvh_.nodes[index].lower = box.min();
        bvh_.nodes[index].upper = box.max();
        if (count <= leafSize_ || depth >= deepest || (stop_ && stop_())) {
            bvh_.nodes[index].first = first;
            bvh_.nodes[index].count = count;
            return;
        }
        const std::uint32_t middle = partition(first, count, centres, depth);
        const auto left = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes[index].first = left;
        bvh_.nodes.resize(bvh_.nodes.size() + 2);
        subdivide(left, first, middle - first, depth + 1);
        subdivide(left + 1, middle, first + count - middle, depth + 1);
    }

    int binOf(std::uint32_t item, const Box& centres, int axis) const {
        const double width = centres.sizes()[axis];
        const double t = (boxes_[item].center()[axis] - centres.min()[axis]) / width;
        return std::clamp(static_cast<int>(t * binCount), 0, binCount - 1);
    }

    Split bestSplit(std::uint32_t first, std::uint32_t count, const Box& centres) const {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centres.sizes()[axis] > 0)) continue;
            std::array<Box, binCount> bins;
            std::array<std::uint32_t, binCount> counts{};
            for (std::uint32_t i = first; i < first + count; ++i) {
                const int bin = binOf(bvh_.items[i], centres, axis);
                bins[bin].extend(boxes_[bvh_.items[i]]);
                ++counts[bin];
            }
            std::array<double, binCount> right{};
            Box box;
            std::uint32_t n = 0;
            for (int bin = binCount - 1; bin > 0; --bin) {
                box.extend(bins[bin]);
                n += counts[bin];
                right[bin] = halfArea(box) * n;
            }
            box.setEmpty();
            n = 0;
            for (int bin = 1; bin < binCount; ++bin) {
                box.extend(bins[bin - 1]);
                n += counts[bin - 1];
                const double cost = halfArea(box) * n + right[bin];
                if (n > 0 && n < count && cost < best.cost) best = {axis, bin, cost};
            }
        }
        return best;
    }

    std::uint32_t partition(std::uint32_t first, std::uint32_t count, const Box& centres, int depth) {
        const auto begin = bvh_.items.begin() + first, end = begin + count;
        const Split split = depth < 60 ? bestSplit(first, count, centres) : Split{};
        if (split.axis >= 0) {
            const auto middle = std::stable_partition(
                begin, end, [&](std::uint32_t item) { return binOf(item, centres, split.axis) < split.bin; });
            return static_cast<std::uint32_t>(middle - bvh_.items.begin());
        }
        partAlongLongest({begin, end}, count / 2, [&](std::uint32_t item) { return boxes_[item].center(); });
        return first + count / 2;
    }

    std::span<const Box> boxes_;
    std::uint32_t leafSize_;
    const std::function<bool()>& stop_;
    Bvh bvh_;
};

} // namespace

Bvh buildBvh(std::span<const Box> boxes, std::uint32_t leafSize, const std::function<bool()>& stop) {
    if (boxes.empty()) return {};
    return Builder(boxes, std::max(leafSize, 1u), stop).build();
}

Bvh buildBvh(const TriangleMesh& mesh, std::uint32_t leafSize) {
    std::vector<Box> boxes;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) boxes.push_back(bounds(mesh, t));
    return buildBvh(boxes, leafSize);
}

} // namespace tss
