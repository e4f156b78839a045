#include "bake/base/Stopwatch.h"
#include "bake/compare/MeshTree.h"

namespace tss::compare {

std::unique_ptr<CollisionMethod> makeSphereTree(const ComparedPair& problem, TreeOf of, int arity,
                                                Enclosure enclosure) {
    const Stopwatch watch;
    const bool all = of == TreeOf::All;
    BodyTrees trees{buildEnclosingTree(all ? problem.a : problem.table.a, arity, enclosure),
                    buildEnclosingTree(all ? problem.b : problem.table.b, arity, enclosure)};
    const double seconds = watch.seconds();
    constexpr const char* names[] = {"box", "points", "balls", "coreset"}; // in the order of Enclosure
    const std::string how = names[static_cast<std::size_t>(enclosure)];
    const Table& table = problem.table;
    // The spheres that a table uses are some of the model's: their contacts are among the model's, so that
    // they are no earlier; and all tests of the table are among their pairs, so that they miss no more than
    // the table.
    StatedError stated = statedBySpheres(problem);
    // A table's tests report from epsilon on, the spheres by themselves from 0 on.
    if (!all) stated.miss.reset();
    if (!all && table.certified && table.boundMiss) stated.miss = *table.boundMiss + table.epsilon;
    Description description{std::string(all ? "tree-all-" : "tree-used-") + std::to_string(arity) + "-" + how,
                            all ? "sphere tree, all spheres" : "sphere tree, used spheres",
                            std::to_string(arity) + "-ary tree of " +
                                (all ? "all spheres (case 1)" : "the table's spheres (case 2)") +
                                ", median split, inner balls: " + how,
                            stated,
                            trees.bytes(),
                            seconds};
    return makeTreeMethod(std::move(trees), std::move(description));
}

} // namespace tss::compare
