#include "bake/motion/Motion.h"
#include "bake/respond/JointResponder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace tss;

namespace {

/// Two balls far apart; B slides along X, Y and Z, by up to these ways either way.
Table farBalls(const std::vector<double>& ways) {
    Table table;
    table.a = {{Vec3::Zero(), 1}};
    table.b = {{{20, 0, 0}, 1}};
    table.rowOffsets = {0, 1};
    table.columns = {0};
    for (std::size_t k = 0; k < ways.size(); ++k) {
        Dof slide;
        slide.kind = DofKind::Translation;
        slide.axis = Vec3::Unit(Eigen::Index(k));
        slide.lower = -ways[k];
        slide.upper = ways[k];
        table.motion.dofs.push_back(slide);
    }
    return table;
}

/// Where the joint goes that is asked for the corner of its limits, so many times.
std::vector<double> atCorner(const Table& table, const std::vector<double>& signs, int times = 1) {
    const JointResponder responder(table);
    JointWorkspace workspace = responder.workspace();
    std::vector<double> q = restValues(table.motion);
    std::vector<double> asked;
    for (std::size_t k = 0; k < signs.size(); ++k) asked.push_back(signs[k] * table.motion.dofs[k].upper);
    for (int k = 0; k < times; ++k) {
        const JointAnswer answer = responder.respond(q.data(), asked.data(), workspace);
        std::copy_n(answer.q.begin(), q.size(), q.begin());
    }
    return q;
}

/// The sum of the values in units of their ranges.
double shares(const Table& table, const std::vector<double>& q) {
    double sum = 0;
    for (std::size_t k = 0; k < q.size(); ++k) sum += q[k] / table.motion.dofs[k].upper;
    return sum;
}

} // namespace

TEST_CASE("a coupling of values whose ranges differ by many orders of magnitude is kept") {
    for (const double narrow : {1e-3, 1e-6, 1e-9, 1e-12})
        for (const double narrower : {1e-3, 1e-6, 1e-9, 1e-12}) {
            CAPTURE(narrow, narrower);
            Table table = farBalls({2, 2 * narrow, 2 * narrower});
            // In units of their ranges they add up to -0.1 to 0.1.
            const LimitPlane sum{{0.5, 0.5 / narrow, 0.5 / narrower}, 0.1};
            LimitPlane other = sum;
            for (double& c : other.coefficients) c = -c;
            table.motion.planes = {sum, other};
            for (const double x : {-1., 1.})
                for (const double y : {-1., 1.})
                    for (const double z : {-1., 1.})
                        CHECK(std::abs(shares(table, atCorner(table, {x, y, z}))) < 0.1 + 1e-6);
        }
}

TEST_CASE("what slides along contact keeps a coupling with a value of hardly any range") {
    for (const double narrow : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
        Table table = farBalls({20, narrow, 0.5});
        const LimitPlane sum{{1. / 20, 1 / narrow, 0}, 0.05}, other{{-1. / 20, -1 / narrow, 0}, 0.05};
        table.motion.planes = {sum, other};
        // The first two at their ends add up to 0, but the balls meet a tenth before, and slide on along Z.
        const std::vector<double> q = atCorner(table, {-1, 1, 1}, 5);
        CAPTURE(narrow, q[0], q[1] / narrow, q[2]);
        CHECK(q[0] == Approx(-18).epsilon(1e-2));
        CHECK(q[2] == Approx(0.5));
        CHECK(std::abs(q[0] / 20 + q[1] / narrow) < 0.05 + 1e-3);
    }
}

TEST_CASE("a plane of very large or very small coefficients is kept") {
    for (const double size : {1e-300, 1e-170, 1., 1e170, 1e300}) {
        CAPTURE(size);
        Table table = farBalls({2, 2});
        table.motion.planes = {{{size, size}, size}};
        const std::vector<double> q = atCorner(table, {1, 1});
        CHECK(q[0] + q[1] == Approx(1));
        CHECK(q[0] > 0);
        CHECK(q[1] > 0);
    }
}
