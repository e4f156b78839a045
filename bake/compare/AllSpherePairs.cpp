#include "bake/compare/Methods.h"

#include "bake/table/Query.h"

namespace tss::compare {

namespace {

class AllSpherePairs final : public CollisionMethodLoop<AllSpherePairs> {
public:
    explicit AllSpherePairs(const ComparedPair& problem) : problem_(problem) {
        description() = {"all-pairs", "all pairs",
                         "every sphere of A against every sphere of B, scalar doubles, first hit out",
                         statedBySpheres(problem), (problem.a.size() + problem.b.size()) * sizeof(Sphere)};
        description().slow = true;
    }

    bool hit(const PoseQuery& query) const override {
        IgnoreWork none;
        return test(query, none);
    }
    std::optional<double> gap(const PoseQuery& query) const override {
        return queryAllPairs(problem_.a, problem_.b, query.pose).gap;
    }
    std::optional<Work> work(const PoseQuery& query) const override {
        CountWork counter;
        test(query, counter);
        return counter.work;
    }

private:
    template <class Counter>
    bool test(const PoseQuery& query, Counter& counter) const {
        const Pose inverse = query.pose.inverse(Eigen::Isometry);
        for (const Sphere& a : problem_.a) {
            const Vec3 centre = inverse * a.centre;
            for (const Sphere& b : problem_.b) {
                counter.sphereTest();
                const double sum = a.radius + b.radius;
                if ((b.centre - centre).squaredNorm() <= sum * sum) return true;
            }
        }
        return false;
    }

    const ComparedPair& problem_;
};

} // namespace

std::unique_ptr<CollisionMethod> makeAllPairs(const ComparedPair& problem) {
    return std::make_unique<AllSpherePairs>(problem);
}

} // namespace tss::compare
