#include "bake/fill/WholeFits.h"

#include "bake/base/Error.h"
#include "bake/spheres/FitMetrics.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

/// Counts how often balls are found for patches, and spheres chosen.
struct Counts {
    int patches = 0, chosen = 0;
    Progress progress() {
        return [this](std::string_view step, double done) {
            patches += step == "patches" && done == 1;
            chosen += step == "spheres that cover" && done == 1;
            return true;
        };
    }
};

} // namespace

TEST_CASE("spheres of whole bodies are made once, coarse ones of balls found once for an octave") {
    std::mt19937_64 random(2);
    const Solid solid(lumpyMesh(random, 3, 0.3)), hollow(solid.mesh(), Interior::Hollow);
    WholeFits fits;
    Counts counts;
    const auto sphereCount = [&](const char* body, const Solid& of, double protrusion) {
        return fits.spheres(body, of, protrusion, {}, counts.progress()).spheres.size();
    };
    const std::size_t coarse = sphereCount("/A", solid, 0.2), finer = sphereCount("/A", solid, 0.12);
    CHECK(coarse < finer);
    CHECK(counts.patches == 1);
    CHECK(counts.chosen == 2);
    CHECK(sphereCount("/A", solid, 0.2) == coarse);
    CHECK(counts.chosen == 2);
    sphereCount("/A", solid, 0.1);  // of the octave below
    sphereCount("/A", solid, 0.01); // below a hundredth of the size: by itself
    sphereCount("/A", hollow, 0.2); // other spheres than those of the solid
    sphereCount("/B", solid, 0.2);
    CHECK(counts.patches == 5);
    CHECK(counts.chosen == 6);
}

TEST_CASE("grown spheres of whole bodies contain the surface and stick out no farther than asked") {
    std::mt19937_64 random(3);
    const Solid solid(lumpyMesh(random, 3, 0.3));
    WholeFits fits;
    for (const double protrusion : {0.3, 0.125, 0.0884, 0.04}) {
        const SphereSet& spheres = fits.spheres("/A", solid, protrusion, {}, {}).spheres;
        const FitMetrics metrics = measureFit(solid, spheres);
        CHECK(metrics.coverage == 0);
        CHECK(metrics.protrusion <= protrusion * (1 + 1e-9));
    }
}

TEST_CASE("spheres of a whole body whose making was stopped are not kept") {
    std::mt19937_64 random(4);
    const Solid solid(lumpyMesh(random, 3, 0.3));
    WholeFits fits, others;
    const auto stop = [](std::string_view, double) { return false; };
    for (const double protrusion : {0.1, 0.01}) {
        CHECK_THROWS_AS(fits.spheres("/A", solid, protrusion, {}, stop), InputError);
        CHECK(fits.spheres("/A", solid, protrusion, {}, {}).spheres.size() ==
              others.spheres("/A", solid, protrusion, {}, {}).spheres.size());
    }
}
