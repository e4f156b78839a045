#include "bake/verify/BallTree.h"

#include <algorithm>
#include <numeric>

namespace tss::verify {

BallTree::BallTree(const SphereSet& spheres) {
    std::vector<std::uint32_t> order(spheres.size());
    std::iota(order.begin(), order.end(), 0u);
    if (!spheres.empty()) join(spheres, order, 0, order.size());
}

std::int32_t BallTree::join(const SphereSet& spheres, std::vector<std::uint32_t>& order, std::size_t from,
                            std::size_t to) {
    Ball ball;
    if (to - from == 1) {
        ball.sphere = order[from];
        ball.centre = spheres[order[from]].centre;
        ball.radius = spheres[order[from]].radius;
        balls.push_back(ball);
        return root();
    }
    Vec3 mean = Vec3::Zero(), spread = Vec3::Zero();
    for (std::size_t k = from; k < to; ++k) mean += spheres[order[k]].centre;
    mean /= double(to - from);
    for (std::size_t k = from; k < to; ++k) spread += (spheres[order[k]].centre - mean).cwiseAbs2();
    Eigen::Index axis = 0;
    spread.maxCoeff(&axis);
    std::sort(order.begin() + from, order.begin() + to, [&](std::uint32_t x, std::uint32_t y) {
        const double cx = spheres[x].centre[axis], cy = spheres[y].centre[axis];
        return cx != cy ? cx < cy : x < y;
    });
    const std::size_t middle = from + (to - from) / 2;
    for (std::size_t k = from; k < to; ++k)
        ball.radius =
            std::max(ball.radius, (spheres[order[k]].centre - mean).norm() + spheres[order[k]].radius);
    ball.centre = mean;
    ball.radius *= 1 + 1e-13;
    ball.radius += 1e-15 * mean.norm();
    ball.first = join(spheres, order, from, middle);
    ball.second = join(spheres, order, middle, to);
    balls.push_back(ball);
    return root();
}

} // namespace tss::verify
