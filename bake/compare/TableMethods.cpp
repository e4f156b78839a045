#include "bake/compare/Methods.h"

#include "bake/table/Query.h"
#include "bake/table/TableKernels.h"

namespace tss::compare {

namespace {

/// What a table promises; of misses nothing where it has an exempt region, whose contact it does not report.
StatedError statedOf(const Table& table) {
    if (!table.certified) return {};
    return {table.restRegion.empty() ? table.boundMiss : std::nullopt, table.boundEarly};
}

/// A step of the paper makes every test of the table, whatever the outcome.
std::function<Work(const PoseQuery&)> everyTest(const Table& table) {
    return [&table](const PoseQuery&) { return sphereTests(table.testCount()); };
}

/// As applications run it: features of the DOF values, then the kernel that suits the table and the machine.
std::unique_ptr<CollisionMethod> makeKernels(const Table& table, const std::string& name,
                                             PreparedTable prepared) {
    Description about{name, "TSS",
                      std::string("the prepared table, ") + tss::name(prepared.form()) + " kernel in " +
                          tss::name(prepared.precision()) +
                          (prepared.kernels().cells().empty()
                               ? ", features made from q each time"
                               : ", asked from q: cell, features where it leaves tests, tests"),
                      statedOf(table).widened(0, prepared.signBand()), // rounding misses nothing
                      prepared.bytes()};
    return makeMethod(
        std::move(about),
        [prepared = std::move(prepared)](const PoseQuery& query) { return prepared.hit(query.q.data()); },
        everyTest(table));
}

} // namespace

std::unique_ptr<CollisionMethod> makeKernelTable(const ComparedPair& problem) {
    return makeKernels(problem.table, "tss", PreparedTable(problem.table));
}

std::unique_ptr<CollisionMethod> makeFloatTable(const ComparedPair& problem) {
    if (PreparedTable(problem.table).precision() == KernelPrecision::Float) return nullptr;
    PrepareOptions options;
    options.precision = KernelPrecision::Float;
    return makeKernels(problem.table, "tss-float", PreparedTable(problem.table, options));
}

std::unique_ptr<CollisionMethod> makePairList(const ComparedPair& problem) {
    const Table& table = problem.table;
    // For each sphere of A the spheres of B in its row, through indices.
    const auto hit = [&table](const PoseQuery& query) {
        const Pose inverse = query.pose.inverse(Eigen::Isometry);
        for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i) {
            const Vec3 centre = inverse * table.a[i].centre;
            for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
                const Sphere& b = table.b[table.columns[k]];
                const double rest = table.restGaps.empty() ? 0 : table.restGaps[k];
                const double sum = std::max(0.0, table.a[i].radius + b.radius + rest);
                if ((b.centre - centre).squaredNorm() <= sum * sum) return true;
            }
        }
        return false;
    };
    return makeMethod({"tss-scalar", "TSS",
                       "the table's tests through indices, scalar doubles, first hit out (the paper's loop)",
                       statedOf(table), tableBytes(table)},
                      hit, everyTest(table));
}

std::unique_ptr<CollisionMethod> makePlainTable(const ComparedPair& problem) {
    const Table& table = problem.table;
    return makeMethod(
        {"tss-plain", "TSS", "the table's plain query: every test, with gap, contact point and normal",
         statedOf(table), tableBytes(table)},
        [&table](const PoseQuery& query) { return tss::query(table, query.pose).hit(); }, everyTest(table));
}

} // namespace tss::compare
