#include "bake/report/Timing.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::reporting;

namespace {

/// Takes note of how often it is asked, in which order.
class Noting : public compare::CollisionMethod {
public:
    Noting(std::string& order, char letter) : order_(order), letter_(letter) {}
    bool hit(const compare::PoseQuery&) const override { return false; }
    std::size_t countHits(std::span<const compare::PoseQuery> queries) const override {
        order_ += letter_;
        volatile double waste = 0;
        for (int k = 0; k < 20000; ++k) waste = waste + 1;
        return queries.size();
    }

private:
    std::string& order_;
    char letter_;
};

} // namespace

TEST_CASE("methods are warmed up, then take turns, and all get their rounds") {
    std::string order;
    const Noting a(order, 'a'), b(order, 'b');
    TimingOptions options;
    options.rounds = 4;
    options.secondsEach = 1e9;
    options.secondsRound = 1e-9;
    const auto times = timeMethods({&a, &b}, std::vector<compare::PoseQuery>(3), options);
    CHECK(order == "aabb"
                   "abababab");
    for (const Times& t : times) {
        CHECK(t.rounds == 4);
        CHECK(t.queries == 3);
        CHECK(t.low > 0);
        CHECK(t.low <= t.median);
        CHECK(t.median <= t.high);
    }
}

TEST_CASE("without poses there is nothing to time") {
    std::string order;
    const Noting a(order, 'a');
    CHECK(timeMethods({&a}, {}, {})[0].median == 0);
    CHECK(order.empty());
}
