#include "bake/compare/Methods.h"

namespace tss::compare {

std::unique_ptr<CollisionMethod> makeAllPairs(const ComparedPair& problem) {
    Description about{"all-pairs", "all pairs",
                      "every sphere of A against every sphere of B, scalar doubles, first hit out",
                      statedBySpheres(problem), (problem.a.size() + problem.b.size()) * sizeof(Sphere)};
    about.slow = true;
    return makeCountedMethod(std::move(about), [&problem](const PoseQuery& query, auto& counter) {
        const Pose inverse = query.pose.inverse(Eigen::Isometry);
        for (const Sphere& a : problem.a) {
            const Vec3 centre = inverse * a.centre;
            for (const Sphere& b : problem.b) {
                counter.sphereTest();
                const double sum = a.radius + b.radius;
                if ((b.centre - centre).squaredNorm() <= sum * sum) return true;
            }
        }
        return false;
    });
}

} // namespace tss::compare
