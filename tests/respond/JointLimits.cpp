#include "bake/motion/Motion.h"
#include "bake/respond/JointResponder.h"

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

/// Where the joint goes that is asked for the corner of its limits.
std::vector<double> atCorner(const Table& table, const std::vector<double>& signs) {
    const JointResponder responder(table);
    JointWorkspace workspace = responder.workspace();
    const std::vector<double> last = restValues(table.motion);
    std::vector<double> asked;
    for (std::size_t k = 0; k < signs.size(); ++k) asked.push_back(signs[k] * table.motion.dofs[k].upper);
    const JointAnswer answer = responder.respond(last.data(), asked.data(), workspace);
    return {answer.q.begin(), answer.q.begin() + std::ptrdiff_t(signs.size())};
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
