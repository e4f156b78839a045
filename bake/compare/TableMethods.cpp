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

/// The paper's loop: for each sphere of A the spheres of B in its row, through indices.
class PairList final : public CollisionMethodLoop<PairList> {
public:
    explicit PairList(const ComparedPair& problem) : table_(problem.table) {
        description() = {
            "tss-scalar", "TSS",
            "the table's tests through indices, scalar doubles, first hit out (the paper's loop)",
            statedOf(table_), tableBytes(table_)};
    }
    bool hit(const PoseQuery& query) const override {
        const Pose inverse = query.pose.inverse(Eigen::Isometry);
        for (std::uint32_t i = 0; i + 1 < table_.rowOffsets.size(); ++i) {
            const Vec3 centre = inverse * table_.a[i].centre;
            for (std::uint32_t k = table_.rowOffsets[i]; k < table_.rowOffsets[i + 1]; ++k) {
                const Sphere& b = table_.b[table_.columns[k]];
                const double rest = table_.restGaps.empty() ? 0 : table_.restGaps[k];
                const double sum = std::max(0.0, table_.a[i].radius + b.radius + rest);
                if ((b.centre - centre).squaredNorm() <= sum * sum) return true;
            }
        }
        return false;
    }
    /// A step of the paper makes every test of the table, whatever the outcome.
    std::optional<Work> work(const PoseQuery&) const override { return sphereTests(table_.testCount()); }

private:
    const Table& table_;
};

class PlainTable final : public CollisionMethodLoop<PlainTable> {
public:
    explicit PlainTable(const ComparedPair& problem) : table_(problem.table) {
        description() = {"tss-plain", "TSS",
                         "the table's plain query: every test, with gap, contact point and normal",
                         statedOf(table_), tableBytes(table_)};
    }
    bool hit(const PoseQuery& query) const override { return tss::query(table_, query.pose).hit(); }
    std::optional<double> gap(const PoseQuery& query) const override {
        return tss::query(table_, query.pose).gap;
    }
    std::optional<Work> work(const PoseQuery&) const override { return sphereTests(table_.testCount()); }

private:
    const Table& table_;
};

/// As applications run it: features of the DOF values, then the kernel that suits the table and the machine.
class KernelTable final : public CollisionMethodLoop<KernelTable> {
public:
    KernelTable(const Table& table, const std::string& name, const PrepareOptions& options)
        : prepared_(table, options) {
        const double band = prepared_.signBand();
        description() = {name, "TSS",
                         std::string("the prepared table, ") + tss::name(prepared_.form()) + " kernel in " +
                             tss::name(prepared_.precision()) +
                             (prepared_.kernels().cells().empty()
                                  ? ", features made from q each time"
                                  : ", asked from q: cell, features where it leaves tests, tests"),
                         statedOf(table).widened(0, band), // rounding misses nothing
                         prepared_.bytes()};
    }
    bool hit(const PoseQuery& query) const override { return prepared_.hit(query.q.data()); }
    std::optional<double> gap(const PoseQuery& query) const override {
        TableFeatures features;
        prepared_.features(query.q.data(), features);
        return prepared_.gap(features).gap;
    }
    std::optional<Work> work(const PoseQuery&) const override { return sphereTests(prepared_.testCount()); }

private:
    PreparedTable prepared_;
};

} // namespace

std::unique_ptr<CollisionMethod> makeKernelTable(const ComparedPair& problem) {
    return std::make_unique<KernelTable>(problem.table, "tss", PrepareOptions{});
}
std::unique_ptr<CollisionMethod> makeFloatTable(const ComparedPair& problem) {
    if (PreparedTable(problem.table).precision() == KernelPrecision::Float) return nullptr;
    PrepareOptions options;
    options.precision = KernelPrecision::Float;
    return std::make_unique<KernelTable>(problem.table, "tss-float", options);
}
std::unique_ptr<CollisionMethod> makePairList(const ComparedPair& problem) {
    return std::make_unique<PairList>(problem);
}
std::unique_ptr<CollisionMethod> makePlainTable(const ComparedPair& problem) {
    return std::make_unique<PlainTable>(problem);
}

} // namespace tss::compare
