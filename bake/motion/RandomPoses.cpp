#include "bake/motion/RandomPoses.h"

#include <random>

namespace tss {

std::vector<std::vector<double>> randomPoses(const Motion& motion, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::vector<double>> poses;
    poses.reserve(count);
    // Planes that leave less than a thousandth of the box would make this loop long: then take what came.
    for (std::size_t tries = 0; poses.size() < count && tries < 1000 * count; ++tries) {
        std::vector<double> q;
        for (const Dof& dof : motion.dofs)
            q.push_back(std::uniform_real_distribution<double>(dof.lower, dof.upper)(random));
        if (motion.planes.empty() || withinLimits(motion, q)) poses.push_back(std::move(q));
    }
    return poses;
}

} // namespace tss
