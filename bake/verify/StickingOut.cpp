#include "bake/verify/StickingOut.h"

#include "bake/base/Parallel.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::verify {

namespace {

constexpr double slack = 1e-6; ///< relative: both sides are measured in doubles

double most(const std::vector<double>& values) {
    return values.empty() ? 0 : *std::ranges::max_element(values);
}

std::string ofProtrusion(const char* body, const std::optional<double>& stated, const StickingOut& out,
                         double band) {
    const double shown = most(out.body);
    if (!stated || shown <= *stated * (1 + slack) + band) return {};
    return fmt::format("a sphere of {} sticks out by {:.6g}, and its tss:protrusion is {:.6g}", body, shown,
                       *stated);
}

/// Each test counts as contact from epsilon on, and no sooner.
std::string ofEpsilon(const Table& table) {
    const double highest = most(table.restGaps);
    if (highest <= table.epsilon * (1 + slack)) return {};
    return fmt::format("a test counts as contact from a gap of {:.6g} on, and its tss:epsilon is {:.6g}",
                       highest, table.epsilon);
}

/// Tests are chosen among the pairs that come as near as both coverages together, which is then boundMiss.
std::string ofCoverage(const Table& table) {
    const std::optional<double> a = table.record.fitA.coverage, b = table.record.fitB.coverage;
    if (!table.boundMiss || !a || !b || *a + *b >= *table.boundMiss * (1 - slack)) return {};
    return fmt::format("its tss:coverage, {:.6g} and {:.6g}, is less than its tss:boundMiss, {:.6g}", *a, *b,
                       *table.boundMiss);
}

std::string ofCounts(const Table& table) {
    const BakeRecord& record = table.record;
    if (record.lowerBound > table.testCount())
        return fmt::format("its tss:lowerBound is {}, and it has {} tests", record.lowerBound,
                           table.testCount());
    if (record.candidatePairs > 0 && record.candidatePairs < table.testCount())
        return fmt::format("its tss:candidatePairs is {}, and it has {} tests", record.candidatePairs,
                           table.testCount());
    const bool counted = record.spheresA > 0 || record.spheresB > 0;
    if (counted && (record.spheresA < table.a.size() || record.spheresB < table.b.size()))
        return fmt::format("its tss:generatedSpheres are {} and {}, and it has {} and {}", record.spheresA,
                           record.spheresB, table.a.size(), table.b.size());
    return {};
}

} // namespace

StickingOut stickingOut(const VerifiedBody& body, const std::vector<Sphere>& spheres) {
    StickingOut out{std::vector<double>(spheres.size()), std::vector<double>(spheres.size())};
    parallelFor(spheres.size(), [&](std::size_t i) {
        const Sphere& sphere = spheres[i];
        const double toSurface = body.surface.distance(sphere.centre);
        out.surface[i] = sphere.radius + toSurface;
        out.body[i] = out.surface[i];
        if (!body.solid) return;
        const double toBoundary = body.solid->boundary().distance(sphere.centre);
        const bool inside = toBoundary > 1e-9 * sphere.radius && body.solid->inside(sphere.centre);
        out.body[i] = inside ? std::max(0.0, sphere.radius - toBoundary)
                             : sphere.radius + std::min(toBoundary, toSurface);
    });
    return out;
}

double mostTogether(const std::vector<MeshTest>& tests, const std::vector<double>& a,
                    const std::vector<double>& b) {
    double most = 0;
    for (const MeshTest& t : tests) {
        // A negative threshold keeps the test silent until its spheres are as deep in each other.
        const double beyond = std::max(t.threshold, 0.0);
        most = std::max(most, a[t.sphereA] + b[t.sphereB] + beyond);
    }
    return most;
}

std::string contradiction(const Table& table, const StickingOut& a, const StickingOut& b, double band) {
    if (std::string why = ofProtrusion("A", table.record.fitA.protrusion, a, band); !why.empty()) return why;
    if (std::string why = ofProtrusion("B", table.record.fitB.protrusion, b, band); !why.empty()) return why;
    if (std::string why = ofEpsilon(table); !why.empty()) return why;
    if (std::string why = ofCoverage(table); !why.empty()) return why;
    return ofCounts(table);
}

} // namespace tss::verify
