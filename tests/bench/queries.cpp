// N queries of one kind on one jaw-like table, for callgrind (instructions.sh):
// bench_queries MOTION PAIRS KERNEL WITH N, MOTION one of hinge, hinge-slide, two-hinges, general.
#include "bake/table/Bench.h"
#include "bake/table/TableKernels.h"
#include "tests/bench/JawLike.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

using namespace tss;

int main(int argc, char** argv) {
    const std::map<std::string, int> motions = {
        {"hinge", 1}, {"hinge-slide", 3}, {"two-hinges", 2}, {"general", 3}};
    PrepareOptions options;
    BenchWith with{};
    if (argc != 6 || !motions.contains(argv[1]) || !kernelTarget(argv[3], options.target) ||
        !benchWith(argv[4], with)) {
        std::fputs("usage: bench_queries hinge|hinge-slide|two-hinges|general PAIRS KERNEL "
                   "hit|gap|contact|features|pose N\n",
                   stderr);
        return 2;
    }
    Table table = jaw_like::table(motions.at(argv[1]), std::strtoul(argv[2], nullptr, 10), 0.1);
    if (std::string(argv[1]) == "hinge-slide") table.motion.dofs.erase(table.motion.dofs.begin() + 1);
    const PreparedTable prepared(table, options);
    const BenchResult result =
        benchQueries(prepared, table.motion, std::strtoull(argv[5], nullptr, 10), with);
    std::printf("%s %s %zu features, %llu hits\n", name(prepared.precision()), name(prepared.form()),
                prepared.kernels().featureCount(), static_cast<unsigned long long>(result.hits));
}
