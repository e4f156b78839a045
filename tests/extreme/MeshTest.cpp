#include "tests/extreme/Served.h"

using namespace extreme;
using tss::Table;

namespace {

std::string notes(const std::string& name) {
    std::string all;
    for (const tss::PairReport& report : served(name).reports)
        for (const std::string& note : report.notes) all += note + "\n";
    return all;
}

} // namespace

TEST_CASE("zero-area and duplicate triangles and a mesh inside out leave the table as it is without them") {
    const Table& good = tableOf("mesh_good");
    for (const char* name : {"mesh_zero_area", "mesh_duplicates", "mesh_inverted"}) {
        INFO(name);
        const Table& table = tableOf(name);
        CHECK(table.columns == good.columns);
        REQUIRE(table.a.size() == good.a.size());
        for (std::size_t k = 0; k < good.a.size(); ++k) {
            CHECK((table.a[k].centre - good.a[k].centre).norm() < 1e-5);
            CHECK(table.a[k].radius == Approx(good.a[k].radius));
        }
        CHECK(table.boundEarly.value() == Approx(good.boundEarly.value()).epsilon(1e-6));
    }
}

TEST_CASE("what is assumed about a damaged mesh is said") {
    CHECK(notes("mesh_good").empty());
    CHECK(notes("mesh_inverted").find("inside out") != std::string::npos);
    CHECK(notes("mesh_holes").find("open or misoriented edges") != std::string::npos);
    CHECK(notes("mesh_mixed").find("open or misoriented edges") != std::string::npos);
    CHECK(notes("mesh_one_triangle").find("open or misoriented edges") != std::string::npos);
}
