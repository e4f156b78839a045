#include "bake/compare/EnclosingTree.h"
#include "bake/motion/Motion.h"
#include "bake/table/Query.h"
#include "tests/compare/Problems.h"

#include <cmath>

using namespace tss;
using namespace tss::compare;

namespace {

/// Poses over all of Q and where contact begins, with what the meshes say there.
struct Judged {
    std::vector<PoseQuery> queries;
    std::vector<char> hits;
    std::vector<double> distances;
    int free = 0, touching = 0;
};

Judged judge(const ComparedPair& problem, std::size_t count) {
    const MeshTruth truth(problem.meshA, problem.meshB);
    Judged judged;
    auto values = randomPoses(problem.motion, count, 11);
    for (auto& q : nearContactPoses(truth, problem.motion, count / 2, 1e-7, 12)) values.push_back(q);
    judged.queries = poseQueries(problem.motion, values);
    for (const PoseQuery& query : judged.queries) {
        judged.hits.push_back(truth.touches(query.pose));
        judged.distances.push_back(truth.distance(query.pose));
        (judged.hits.back() ? judged.touching : judged.free) += 1;
    }
    return judged;
}

/// The method's verdicts keep what it states. `slack`: of FCL's distance itself.
void checkStated(const CollisionMethod& method, const Judged& judged, double slack) {
    INFO(method.description.name << ": " << method.description.about);
    const StatedError stated = method.description.stated;
    std::size_t missed = 0, hits = 0;
    double earliest = 0;
    for (std::size_t i = 0; i < judged.queries.size(); ++i) {
        const bool hit = method.hit(judged.queries[i]);
        hits += hit;
        missed += judged.hits[i] && !hit;
        if (hit && !judged.hits[i]) earliest = std::max(earliest, judged.distances[i]);
    }
    CHECK(method.countHits(judged.queries) == hits);
    if (stated.miss == 0) CHECK(missed == 0);
    if (stated.early) CHECK(earliest <= *stated.early + slack);
    CHECK(hits > 0);
    CHECK(hits < judged.queries.size());
}

} // namespace

TEST_CASE("each method's verdicts agree with the meshes within its own stated error") {
    const ComparedPair problem = lidOverBall();
    const Judged judged = judge(problem, 300);
    REQUIRE(judged.free > 50);
    REQUIRE(judged.touching > 50);
    std::vector<std::unique_ptr<CollisionMethod>> methods;
    methods.push_back(makeAllPairs(problem));
    methods.push_back(makeAllPairsSimd(problem));
    methods.push_back(makePairList(problem));
    methods.push_back(makePlainTable(problem));
    methods.push_back(makeKernelTable(problem));
    if (auto inFloat = makeFloatTable(problem)) methods.push_back(std::move(inFloat));
    for (const TreeOf of : {TreeOf::All, TreeOf::Used})
        for (const Enclosure enclosure :
             {Enclosure::Box, Enclosure::Points, Enclosure::Balls, Enclosure::CoreSet})
            methods.push_back(makeSphereTree(problem, of, 8, enclosure));
    methods.push_back(makeSphereTree(problem, TreeOf::All, 2, Enclosure::Balls));
    methods.push_back(makeOctree(problem, 5));
    methods.push_back(makeHubbard(problem, 3));
    methods.push_back(makeAdaptiveMedial(problem, 3));
    methods.push_back(makeOrourkeBadler(problem));
    for (const char* volume : {"obbrss", "obb", "aabb"}) methods.push_back(makeFcl(problem, volume));
    methods.push_back(makeGimpact(problem));
    const EnclosingTree a = buildEnclosingTree(problem.a, 8, Enclosure::Balls),
                        b = buildEnclosingTree(problem.b, 8, Enclosure::Balls);
    methods.push_back(makeGapGrid(
        problem, [&](const PoseQuery& query) { return treesGap(a, b, query.pose); }, 65,
        statedBySpheres(problem)));
    for (const auto& method : methods) checkStated(*method, judged, 1e-9);
}

TEST_CASE("methods over the same spheres give one verdict and one gap") {
    const ComparedPair problem = lidOverBall();
    const auto queries = poseQueries(problem.motion, randomPoses(problem.motion, 200, 5));
    const auto reference = makeAllPairs(problem);
    std::vector<std::unique_ptr<CollisionMethod>> same;
    same.push_back(makePairList(problem));
    same.push_back(makePlainTable(problem));
    for (const int arity : {2, 4, 8})
        for (const Enclosure enclosure :
             {Enclosure::Box, Enclosure::Points, Enclosure::Balls, Enclosure::CoreSet})
            same.push_back(makeSphereTree(problem, TreeOf::All, arity, enclosure));
    const EnclosingTree a = buildEnclosingTree(problem.a, 8, Enclosure::Balls),
                        b = buildEnclosingTree(problem.b, 8, Enclosure::Balls);
    for (const PoseQuery& query : queries) {
        const double gap = queryAllPairs(problem.a, problem.b, query.pose).gap;
        CHECK(reference->hit(query) == (gap <= 0));
        CHECK(treesGap(a, b, query.pose) == Approx(gap).margin(1e-12));
        for (const auto& method : same) {
            INFO(method->description.name);
            CHECK(method->hit(query) == (gap <= 0));
        }
    }
}

TEST_CASE("a tree tests fewer spheres than all pairs and counts four products each") {
    const ComparedPair problem = lidOverBall();
    const auto all = makeAllPairs(problem);
    const auto tree = makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls);
    std::uint64_t ofAll = 0, ofTree = 0;
    for (const PoseQuery& query : poseQueries(problem.motion, randomPoses(problem.motion, 100, 6))) {
        const Work work = tree->work(query);
        CHECK(work.products == 4 * work.tests);
        ofAll += all->work(query).tests;
        ofTree += work.tests;
    }
    CHECK(ofTree < ofAll);
}

TEST_CASE("a method that only knows the leading DOF is right for a hinge but for one slice") {
    const ComparedPair problem = lidHinged();
    const auto model = makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls);
    const Oracle oracle = [&](const PoseQuery& query) { return model->hit(query); };
    const int bins = 128;
    const auto region = makeAngularRegion(problem, oracle, bins, 9, 3);
    const auto mixed = makeMixedRegion(problem, oracle, bins, 9, 3,
                                       std::shared_ptr<const CollisionMethod>(makePairList(problem)));
    const auto paths = makeAllowedPaths(problem, oracle, 1, 200);
    const double slice = (problem.motion.dofs[0].upper - problem.motion.dofs[0].lower) / bins;
    int judged = 0;
    for (const PoseQuery& query : poseQueries(problem.motion, randomPoses(problem.motion, 500, 8))) {
        const auto at = [&](double q) { return oracle({{q}, pose(problem.motion, std::vector<double>{q})}); };
        const bool hit = oracle(query);
        CHECK(mixed->hit(query) == hit);
        if (at(query.q[0] - slice) != hit || at(query.q[0] + slice) != hit) continue;
        ++judged;
        CHECK(region->hit(query) == hit);
        CHECK(paths->hit(query) == hit);
    }
    CHECK(judged > 400);
}

TEST_CASE("mixed regions ask for spheres only where the leading DOF leaves it open") {
    const ComparedPair problem = lidOverBall();
    const auto model = makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls);
    const Oracle oracle = [&](const PoseQuery& query) { return model->hit(query); };
    const auto mixed = makeMixedRegion(problem, oracle, 64, 40, 3,
                                       std::shared_ptr<const CollisionMethod>(makePairList(problem)));
    int asked = 0, wrong = 0;
    const auto queries = poseQueries(problem.motion, randomPoses(problem.motion, 400, 9));
    for (const PoseQuery& query : queries) {
        asked += mixed->work(query).tests > 0;
        wrong += mixed->hit(query) != oracle(query);
    }
    CHECK(asked > 0);
    CHECK(asked < 400);
    CHECK(wrong <= 8); // slices of 40 samples can be wrong at their edges
}

TEST_CASE("a grid of gaps errs less near contact as it gets finer, never farther from it than its bound") {
    const ComparedPair problem = lidOverBall();
    const EnclosingTree a = buildEnclosingTree(problem.a, 8, Enclosure::Balls),
                        b = buildEnclosingTree(problem.b, 8, Enclosure::Balls);
    const GapOracle oracle = [&](const PoseQuery& query) { return treesGap(a, b, query.pose); };
    const auto touches = [&](const Pose& pose) { return treesGap(a, b, pose) <= 0; };
    const auto queries =
        poseQueries(problem.motion, nearContactPoses(touches, problem.motion, 600, 1e-3, 10));
    std::size_t before = queries.size();
    for (const int points : {9, 17, 65}) {
        const auto grid = makeGapGrid(problem, oracle, points, {0, 0});
        std::size_t wrong = 0;
        for (const PoseQuery& query : queries) {
            const double gap = oracle(query);
            if (grid->hit(query) == (gap <= 0)) continue;
            ++wrong;
            CHECK(std::abs(gap) <= grid->description.stated.miss.value());
        }
        INFO(points << " points: " << wrong << " wrong, before " << before);
        CHECK(wrong < before);
        before = wrong;
    }
}
