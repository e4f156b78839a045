#include "bake/report/MethodSet.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <stdexcept>

namespace tss::reporting {

namespace {

using namespace compare;

constexpr std::string_view names =
    "tss tss-float tss-scalar tss-plain all-pairs all-pairs-simd tree-all tree-used octree medial-hubbard "
    "medial-adaptive orourke-badler angular-region mixed-region allowed-paths gap-grid fcl-obbrss fcl-obb "
    "fcl-aabb bullet-gimpact";

/// Adds methods to a set: those that are wanted by name, and notes of those that cannot be built.
class MethodAdder {
public:
    MethodAdder(MethodSet& methods, const std::vector<std::string>& only) : methods_(methods), only_(only) {}

    template <class Make>
    void add(const std::string& name, const Make& make) {
        if ((" " + std::string(names) + " ").find(" " + name + " ") == std::string::npos)
            throw std::logic_error(name + " is not among the names of the methods");
        if (!wanted(name)) return;
        try {
            if (auto method = make()) methods_.all.push_back(std::move(method));
        } catch (const InputError& error) {
            methods_.notRun.push_back({name, error.what()});
        }
    }
    void skip(const std::string& name, const std::string& reason) {
        if (wanted(name)) methods_.notRun.push_back({name, reason});
    }

private:
    bool wanted(const std::string& name) const {
        return only_.empty() || std::ranges::any_of(only_, [&](const std::string& part) {
                   return name.find(part) != std::string::npos;
               });
    }
    MethodSet& methods_;
    const std::vector<std::string>& only_;
};

void addTables(MethodAdder& adder, const ComparedPair& problem) {
    adder.add("tss", [&] { return makeKernelTable(problem); });
    adder.add("tss-float", [&] { return makeFloatTable(problem); });
    adder.add("tss-scalar", [&] { return makePairList(problem); });
}

void addTrees(MethodAdder& adder, const ComparedPair& problem) {
    for (const TreeOf of : {TreeOf::All, TreeOf::Used}) {
        const std::string name = of == TreeOf::All ? "tree-all" : "tree-used";
        for (const Enclosure how : {Enclosure::Balls, Enclosure::Points, Enclosure::CoreSet, Enclosure::Box})
            adder.add(name, [&] { return makeSphereTree(problem, of, 8, how); });
        adder.add(name, [&] { return makeSphereTree(problem, of, 2, Enclosure::Balls); });
    }
}

void addBodyTrees(MethodAdder& adder, const ComparedPair& problem, bool quick) {
    for (int levels = 4; levels <= (quick ? 6 : 8); levels += quick ? 2 : 1)
        adder.add("octree", [&] { return makeOctree(problem, levels); });
    for (int levels = 3; levels <= (quick ? 3 : 5); ++levels) {
        adder.add("medial-hubbard", [&] { return makeHubbard(problem, levels); });
        adder.add("medial-adaptive", [&] { return makeAdaptiveMedial(problem, levels); });
    }
    adder.add("orourke-badler", [&] { return makeOrourkeBadler(problem); });
}

/// The whole sphere model, spheres through trees, which the methods below sample when they are made.
struct SphereModel {
    explicit SphereModel(const ComparedPair& problem)
        : a(std::make_shared<EnclosingTree>(buildEnclosingTree(problem.a, 8, Enclosure::Balls))),
          b(std::make_shared<EnclosingTree>(buildEnclosingTree(problem.b, 8, Enclosure::Balls))) {}
    bool hit(const PoseQuery& query) const {
        IgnoreWork none;
        return treesTouch(*a, *b, query.pose, none);
    }
    double gap(const PoseQuery& query) const { return treesGap(*a, *b, query.pose); }

    std::shared_ptr<const EnclosingTree> a, b;
};

/// Values a DOF, coarse to fine.
std::vector<int> gridPoints(std::size_t dofs, bool quick) {
    std::vector<int> points{17, 65, 257};
    if (dofs == 1) points = {65, 1025, 16385};
    if (dofs == 3) points = {17, 33, 65};
    if (dofs == 4) points = {9, 17};
    if (quick) points.pop_back();
    return points;
}

void addGrid(MethodAdder& adder, const ComparedPair& problem, const SphereModel& spheres, int points) {
    adder.add("gap-grid", [&] {
        return makeGapGrid(
            problem, [spheres](const PoseQuery& query) { return spheres.gap(query); }, points,
            statedBySpheres(problem));
    });
}

/// Methods that store the motion rather than the shape.
void addMotionMethods(MethodAdder& adder, const ComparedPair& problem, bool quick, std::uint64_t seed) {
    const SphereModel spheres(problem);
    const Oracle hit = [spheres](const PoseQuery& query) { return spheres.hit(query); };
    const std::size_t dofs = problem.motion.dofCount();
    const int bins = 256, samples = dofs == 1 ? 9 : 128;
    adder.add("angular-region", [&] { return makeAngularRegion(problem, hit, bins, samples, seed); });
    adder.add("mixed-region",
              [&] { return makeMixedRegion(problem, hit, bins, samples, seed, makeKernelTable(problem)); });
    adder.add("mixed-region", [&] {
        return makeMixedRegion(problem, hit, bins, samples, seed,
                               makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls));
    });
    for (const int paths : quick ? std::vector{17} : std::vector{9, 33, 129}) {
        if (dofs > 2 && paths > 33) continue;
        adder.add("allowed-paths",
                  [&] { return makeAllowedPaths(problem, hit, dofs == 1 ? 1 : paths, 200); });
        if (dofs == 1) break;
    }
    for (const int points : gridPoints(dofs, quick)) addGrid(adder, problem, spheres, points);
}

void addMeshMethods(MethodAdder& adder, const ComparedPair& problem) {
    for (const std::string volume : {"obbrss", "obb", "aabb"})
        adder.add("fcl-" + volume, [&] { return makeFcl(problem, volume); });
    adder.add("bullet-gimpact", [&] { return makeGimpact(problem); });
}

} // namespace

std::string_view methodNames() {
    return names;
}

MethodSet makeMethods(const Model& model, MethodScope scope, bool quick, const std::vector<std::string>& only,
                      std::uint64_t seed) {
    MethodSet methods;
    MethodAdder adder(methods, only);
    const ComparedPair& problem = model.problem;
    addTables(adder, problem);
    if (scope == MethodScope::Table) return methods;
    if (scope == MethodScope::Spheres) {
        adder.add("tree-all", [&] { return makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls); });
        adder.add("tree-used", [&] { return makeSphereTree(problem, TreeOf::Used, 8, Enclosure::Balls); });
        adder.add("all-pairs-simd", [&] { return makeAllPairsSimd(problem); });
        if (problem.motion.dofCount() <= 2)
            addGrid(adder, problem, SphereModel(problem),
                    gridPoints(problem.motion.dofCount(), quick).back());
        return methods;
    }
    adder.add("tss-plain", [&] { return makePlainTable(problem); });
    adder.add("all-pairs", [&] { return makeAllPairs(problem); });
    adder.add("all-pairs-simd", [&] { return makeAllPairsSimd(problem); });
    addTrees(adder, problem);
    addBodyTrees(adder, problem, quick);
    addMotionMethods(adder, problem, quick, seed);
    addMeshMethods(adder, problem);
    adder.skip("bent ellipsoid", "stands for a muscle under a skin; a rigid pair of meshes has none");
    if (quick) adder.skip("finer octrees, medial trees, paths and grids", "left out by --quick");
    return methods;
}

} // namespace tss::reporting
