#include "bake/respond/JointResponder.h"
#include "bake/table/Query.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::between;
using random_table::Random;

namespace {

double distance(const JointResponder& responder, std::span<const double> x, std::span<const double> y) {
    double sum = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double d = responder.weights()[k] * (x[k] - y[k]);
        sum += d * d;
    }
    return std::sqrt(sum);
}

/// By how much a free pose within a thousandth of the range of q is nearer to the asked one, as a share of
/// the range: 0 at a local optimum. Searched at random.
double nearerBy(const Table& table, const JointResponder& responder, std::span<const double> q,
                std::span<const double> asked, Random& random) {
    const std::size_t n = q.size();
    std::vector<double> low, high;
    for (const Dof& d : table.motion.dofs) {
        low.push_back(d.lower);
        high.push_back(d.upper);
    }
    const double range = distance(responder, low, high);
    double nearest = distance(responder, q, asked);
    const double start = nearest;
    for (int i = 0; i < 3000; ++i) {
        std::vector<double> p(q.begin(), q.end());
        for (std::size_t k = 0; k < n; ++k)
            p[k] += 1e-3 * range / responder.weights()[k] * between(random, -1, 1);
        p = clampToLimits(table.motion, p);
        if (query(table, p).gap >= 1.2 * responder.keptGap())
            nearest = std::min(nearest, distance(responder, p, asked));
    }
    return (start - nearest) / range;
}

} // namespace

TEST_CASE("what a small step slides to is a local optimum") {
    int slid = 0, short_ = 0;
    for (std::uint64_t seed = 1; seed <= 250; ++seed) {
        Random random(seed);
        const Table table = random_table::anyTable(random);
        const JointResponder responder(table, JointResponder::Preparation::Once);
        JointWorkspace ws = responder.workspace();
        std::vector<double> q = random_table::values(random, table.motion);
        if (query(table, q).hit()) continue;
        // Pulled in small steps towards one pose after another, as a hand would.
        std::vector<double> hand = q;
        for (int step = 0; step < 60; ++step) {
            if (step % 20 == 0) hand = random_table::values(random, table.motion);
            std::vector<double> asked = q;
            for (std::size_t k = 0; k < q.size(); ++k) asked[k] += 0.05 * (hand[k] - q[k]);
            const JointAnswer answer = responder.respond(q.data(), asked.data(), ws);
            std::copy_n(answer.q.begin(), q.size(), q.begin());
            if (answer.status == JointStatus::Free) continue;
            ++slid;
            const double nearer = nearerBy(table, responder, q, asked, random);
            if (nearer > 3e-4) ++short_;
        }
    }
    INFO(slid << " steps met something, " << short_ << " stopped short");
    CHECK(slid > 200);
    CHECK(short_ <= slid / 100);
}
