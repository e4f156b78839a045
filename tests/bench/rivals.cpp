// A table beside FCL on meshes, a grid of gaps, trees and lists of the same spheres: one process, the same
// poses. The bodies are two studded plates that close like jaws.
#include "bake/compare/Methods.h"
#include "bake/table/Query.h"
#include "bake/table/TablePairs.h"
#include "tests/Shapes.h"
#include "tests/bench/JawLike.h"

#include <benchmark/benchmark.h>

#include <set>

using namespace tss;
using namespace tss::compare;

namespace {

void append(TriangleMesh& mesh, const TriangleMesh& part) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Tri& t : part.triangles) mesh.triangles.push_back(t + Tri::Constant(first));
}

/// Balls as meshes, so that spheres and triangles are the same bodies.
TriangleMesh meshOf(const SphereSet& spheres) {
    TriangleMesh mesh;
    for (const Sphere& s : spheres) append(mesh, ballMesh(s.centre, s.radius, 2));
    return mesh;
}

/// The pairs that are the nearest at some pose of a fine lattice: a table with the same answers there.
Table nearestPairs(const SphereSet& a, const SphereSet& b, const Motion& motion) {
    std::set<SpherePair> pairs;
    for (const std::vector<double>& q : latticePoses(motion, 3000)) {
        const QueryResult r = queryAllPairs(a, b, pose(motion, q));
        pairs.insert({std::uint32_t(r.test) / std::uint32_t(b.size()),
                      std::uint32_t(r.test) % std::uint32_t(b.size())});
    }
    return makeTable(a, b, {pairs.begin(), pairs.end()}, {}, motion);
}

Problem problem() {
    Problem p;
    p.motion = jaw_like::motion(2);
    const Table whole = jaw_like::table(2, 200 * 200, 0);
    p.a = whole.a;
    p.b = whole.b;
    p.meshA = meshOf(p.a);
    p.meshB = meshOf(p.b);
    p.table = nearestPairs(p.a, p.b, p.motion);
    p.table.epsilon = 0.01;
    return p;
}

} // namespace

int main(int argc, char** argv) {
    const Problem p = problem();
    const std::vector<PoseQuery> poses = poseQueries(p.motion, latticePoses(p.motion, 2000));
    const GapOracle gaps = [&](const PoseQuery& q) { return queryAllPairs(p.a, p.b, q.pose).gap; };
    std::vector<std::unique_ptr<Rival>> rivals;
    rivals.push_back(makeKernelTable(p));
    rivals.push_back(makePairList(p));
    rivals.push_back(makePlainTable(p));
    rivals.push_back(makeGapGrid(p, gaps, 64, {}));
    rivals.push_back(makeSphereTree(p, TreeOf::All, 8, Enclosure::Balls));
    rivals.push_back(makeAllPairsSimd(p));
    rivals.push_back(makeAllPairs(p));
    rivals.push_back(makeFcl(p, FclTree::Obbrss));
    for (const std::unique_ptr<Rival>& rival : rivals)
        benchmark::RegisterBenchmark(rival->description().name.c_str(), [&](auto& state) {
            std::size_t hits = 0;
            for (auto _ : state) benchmark::DoNotOptimize(hits = rival->countHits(poses));
            state.counters["hits"] = double(hits);
            state.counters["bytes"] = double(rival->description().bytes);
            state.counters["per query"] =
                benchmark::Counter(double(poses.size()), benchmark::Counter::kIsIterationInvariantRate |
                                                             benchmark::Counter::kInvert);
        });
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
