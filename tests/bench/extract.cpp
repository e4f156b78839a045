// How long finding the joints of a graph of 10,000 nodes takes, by the number of its joints.
#include "tests/osgTSS/LargeGraph.h"

#include <benchmark/benchmark.h>
#include <osgTSS/ConstraintVisitor>

namespace {

void extract(benchmark::State& state) {
    const osg::ref_ptr<osg::Group> root = largeGraph(10000, static_cast<unsigned int>(state.range(0)));
    const auto pairs = static_cast<osgTSS::ConstraintVisitor::Pairs>(state.range(1));
    std::size_t found = 0;
    for (auto _ : state) {
        osgTSS::ConstraintVisitor visitor(pairs);
        root->accept(visitor);
        found = visitor.getModel().pairs.size();
    }
    state.counters["pairs"] = static_cast<double>(found);
}

} // namespace

BENCHMARK(extract)
    ->ArgNames({"joints", "pairs"})
    ->Args({20, osgTSS::ConstraintVisitor::NEIGHBOURS})
    ->Args({200, osgTSS::ConstraintVisitor::NEIGHBOURS})
    ->Args({200, osgTSS::ConstraintVisitor::ALL})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
