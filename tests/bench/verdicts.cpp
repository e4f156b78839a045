// A table's verdict from joint values against grids of its own gaps, in turns in one process, at random poses
// of the limits. usage: bench_verdicts BAKED.tss [PAIR]
#include "bake/compare/Methods.h"
#include "bake/report/Timing.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/PreparedTable.h"

#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <random>

using namespace tss;
using namespace tss::compare;

int main(int argc, char** argv) {
    if (argc < 2) return std::fputs("usage: bench_verdicts BAKED.tss [PAIR]\n", stderr), 2;
    const SceneModel scene = loadScene(argv[1]);
    for (const Pair& pair : scene.pairs) {
        if (!pair.table || (argc > 2 && pair.path != argv[2])) continue;
        ComparedPair problem;
        problem.table = *pair.table;
        problem.motion = pair.table->motion;
        const std::size_t dofs = problem.motion.dofCount();
        if (dofs < 1 || dofs > 3) continue;
        const auto start = std::chrono::steady_clock::now();
        const PreparedTable table(problem.table);
        const double prepared =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        PrepareOptions bare;
        bare.cells = CellUse::Never;
        const PreparedTable tests(problem.table, bare);

        std::mt19937_64 random(1);
        std::vector<std::vector<double>> values(2000, std::vector<double>(dofs));
        for (std::vector<double>& q : values)
            for (std::size_t k = 0; k < dofs; ++k)
                q[k] = std::uniform_real_distribution<double>(problem.motion.dofs[k].lower,
                                                              problem.motion.dofs[k].upper)(random);
        const std::vector<PoseQuery> queries = poseQueries(problem.motion, values);
        std::vector<std::unique_ptr<CollisionMethod>> rivals;
        rivals.push_back(makeKernelTable(problem));
        const GapOracle gap = [&](const PoseQuery& query) {
            TableFeatures f;
            tests.features(query.q.data(), f);
            return std::min(tests.gap(f).gap, 1e6);
        };
        const std::vector<std::vector<int>> points = {{65, 1025}, {17, 65, 257}, {17, 33, 65}};
        for (const int n : points[dofs - 1]) rivals.push_back(makeGapGrid(problem, gap, n, {}));
        std::vector<const CollisionMethod*> field;
        for (const auto& rival : rivals) field.push_back(rival.get());
        const std::vector<reporting::Times> times =
            reporting::timeMethods(field, queries, {31, 2.0, 2e-3, 0.05});
        std::size_t touching = 0, wrong = 0;
        for (const PoseQuery& query : queries) {
            const bool hit = tests.hit(query.q.data());
            touching += hit;
            wrong += hit != table.hit(query.q.data());
        }
        fmt::print(
            "{}: {} DOFs, {} tests, {} of {} touch, {:.2g} % asked, verdicts {} bytes, prepared in {:.3f} s, "
            "{} differ\n",
            pair.path, dofs, problem.table.testCount(), touching, queries.size(),
            100 * table.verdicts().asked(), table.verdicts().bytes(), prepared, wrong);
        for (std::size_t i = 0; i < field.size(); ++i)
            fmt::print("  {:14} {:6.2f} ns ({:.2f} to {:.2f}), {:.2f} times the table's\n",
                       field[i]->description.name, times[i].median, times[i].low, times[i].high,
                       times[i].median / times[0].median);
    }
}
