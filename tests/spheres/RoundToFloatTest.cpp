#include "bake/spheres/RoundToFloat.h"

#include <catch2/catch.hpp>

#include <random>

using namespace tss;

TEST_CASE("a sphere rounded to float contains what it was, and grows by no more than rounding") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int round = 0; round < 20000; ++round) {
        const double size = std::pow(10.0, 6 * any(random));
        const Sphere sphere{Vec3(any(random), any(random), any(random)) * size,
                            std::abs(any(random)) * std::pow(10.0, 4 * any(random))};
        const Sphere rounded = roundToFloat(sphere);
        INFO("round " << round << " of seed 11");
        REQUIRE((isFloat(rounded.centre.x()) && isFloat(rounded.centre.y()) && isFloat(rounded.centre.z())));
        REQUIRE(isFloat(2 * rounded.radius));
        const long double shift =
            std::sqrt((long double)(rounded.centre - sphere.centre).cast<long double>().squaredNorm());
        REQUIRE((long double)rounded.radius >= (long double)sphere.radius + shift);
        REQUIRE(rounded.radius <= (sphere.radius + size * 1.1e-7) * (1 + 2.5e-7) + 1e-40);
        const Sphere again = roundToFloat(rounded);
        REQUIRE(again.centre == rounded.centre);
        REQUIRE(again.radius == rounded.radius);
    }
}
