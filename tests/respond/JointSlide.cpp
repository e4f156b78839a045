#include "tests/respond/Walk.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

TEST_CASE("what a small step slides to is a local optimum") {
    int slid = 0, short_ = 0;
    for (std::uint64_t seed = 1; seed <= 250; ++seed) {
        Random random(seed);
        const Table table = random_table::anyTable(random);
        std::vector<double> q = random_table::values(random, table.motion);
        if (query(table, q).hit()) continue;
        const JointResponder responder(table);
        JointWorkspace ws = responder.workspace();
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
            const double nearer = walk::nearerBy(table, responder, q, asked, random);
            if (nearer > 3e-4) ++short_;
        }
    }
    INFO(slid << " steps met something, " << short_ << " stopped short");
    CHECK(slid > 200);
    CHECK(short_ <= slid / 100);
}
