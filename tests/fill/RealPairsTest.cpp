// The whole sphere sets of real pairs against FCL: what the meshes do at 10^5 random and 10^4 near-contact
// poses.
#include "tests/fill/RealPairs.h"
#include "bake/spheres/FitMetrics.h"

#include <chrono>

using namespace tss;
using namespace zone;

namespace {

struct Case {
    const char* set;
    double tolerance; ///< scene units
    std::size_t mostSpheres;
    std::size_t random, near;
};

void check(const Case& c) {
    REQUIRE_SHARED_MESHES();
    const Scene scene = realPair(c.set);
    ContactZoneOptions options;
    options.tolerance = c.tolerance;
    options.atRest = AtRest::Collide;
    const auto start = std::chrono::steady_clock::now();
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, options);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    CHECK(fit.a.fit.spheres.size() + fit.b.fit.spheres.size() <= c.mostSpheres);
    for (const auto& [mesh, body] : {std::pair(&scene.a, &fit.a), std::pair(&scene.b, &fit.b)}) {
        const FitMetrics metrics = measureFit(Solid(*mesh), roundToFloat(body->fit.spheres), body->zone);
        CHECK(metrics.coverage == 0);
        CHECK((fit.neverMeet || metrics.protrusion <= c.tolerance));
    }
    const GroundTruth truth(scene.a, scene.b);
    const Verdicts random =
        verdicts(truth, fit, scene.motion, tss::randomPoses(scene.motion, c.random, 1));
    const auto poses = nearContactPoses(truth, scene.motion, c.near, 1e-4, 2);
    const Verdicts near = verdicts(truth, fit, scene.motion, poses);
    WARN(c.set << " at " << c.tolerance << ": " << fit.a.fit.spheres.size() << " + "
               << fit.b.fit.spheres.size() << " spheres in " << took.count() << " s"
               << (fit.neverMeet ? ", never meet" : "") << "; " << c.random << " random poses: "
               << random.touching << " contacts, " << random.missed << " missed, " << random.early
               << " false positives; " << poses.size() << " near contact: " << near.touching << " contacts, "
               << near.missed << " missed, " << near.early << " false positives; the worst of them "
               << std::max(random.worst, near.worst) << " before contact");
    CHECK(random.missed + near.missed == 0);
    CHECK(std::max(random.worst, near.worst) <= 2 * c.tolerance);
    CHECK((!fit.neverMeet || random.touching == 0));
}

} // namespace

TEST_CASE("the dog's jaw at 0.2 mm against its meshes", "[.long]") {
    check({"dog_jaw", 2e-4, 5000, 100000, 10000});
}

TEST_CASE("the dog's jaw at 0.05 mm against its meshes", "[.long]") {
    check({"dog_jaw", 5e-5, 10000, 100000, 10000});
}

TEST_CASE("the human teeth at 0.2 mm against their meshes", "[.long]") {
    check({"human_jaw_ict", 0.02, 10000, 100000, 10000});
}

TEST_CASE("the dog's hip at 0.2 mm against its meshes", "[.long]") {
    check({"dog_hip", 2e-4, 10000, 100000, 10000});
}

TEST_CASE("the finger at 0.2 and at 0.05 mm against its meshes", "[.long]") {
    check({"human_finger", 2e-4, 10000, 100000, 10000});
    check({"human_finger", 5e-5, 10000, 100000, 10000});
}

TEST_CASE("two links of a robot at 0.2 mm against their meshes, CAD shells with open edges", "[.long]") {
    check({"franka_fer", 2e-4, 10000, 100000, 10000});
}
