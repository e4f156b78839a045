// Which vertices are surely an influence's, and how firmly others are claimed.
#include "bake/bind/SkinClaims.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

using Vertices = std::vector<std::uint32_t>;

/// Two influences of size 1, and how far from each a vertex is.
struct Two {
    std::vector<SkinInfluence> influences = std::vector<SkinInfluence>(2);

    explicit Two(const std::vector<std::pair<double, double>>& distances) {
        for (SkinInfluence& influence : influences) influence.size = 1;
        for (const auto& [first, second] : distances) {
            influences[0].distance.push_back(first);
            influences[1].distance.push_back(second);
        }
    }
};

} // namespace

TEST_CASE("seeds are within 0.08 of a bone's size of it, and of others 0.12 and 2.5 times as far") {
    const Two two({{0.07, 0.5},   // a seed
                   {0.09, 0.5},   // not near
                   {0.01, 0.115}, // not far from the other
                   {0.01, 0.125}, // a seed
                   {0.06, 0.145}, // the other is 2.4 times as far: a closed upper lip on the lower teeth
                   {0.06, 0.155}, // 2.6 times: a seed
                   {0.5, 0.07},
                   {0.5, 0.03}});
    CHECK(seedsOf(two.influences)[0] == Vertices{0, 3, 5});
    CHECK(seedsOf(two.influences)[1] == Vertices{6, 7});
}

TEST_CASE(
    "where too few are near, as about a bone thin in its flesh, seeds are much nearer to it than to all "
    "others, but for those beyond its end") {
    // Of what is far from the other half is near, then less than half.
    Two two({{0.07, 0.5}, {0.07, 0.5}, {0.09, 0.5}, {0.5, 0.07}});
    CHECK(seedsOf(two.influences)[0] == Vertices{0, 1});
    two = Two({{0.07, 0.5}, {0.09, 0.5}, {0.09, 0.5}, {0.5, 0.07}});
    CHECK(seedsOf(two.influences)[0] == Vertices{0, 1, 2});
    CHECK(seedsOf(two.influences)[1] == Vertices{3});
    // A limb, the other bone nearer and nearer; its last two are beyond the bone's end.
    std::vector<std::pair<double, double>> limb;
    for (int k = 0; k < 10; ++k) {
        const double own = k < 8 ? 0.2 : k == 8 ? 0.3 : 0.4;
        limb.emplace_back(own, own + 0.05 + 0.1 * k);
    }
    limb.emplace_back(0.9, 0.2); // of the other
    // 0.15 is less than a fifth of 0.95, and of the eight that are left one in five is not taken.
    CHECK(seedsOf(Two(limb).influences)[0] == Vertices{2, 3, 4, 5, 6, 7, 8});
    // Beside a short bone, of which no skin is nearer than to the other by more than 0.4, its seeds begin
    // where they would if 0.6 were the most.
    limb.back() = {0.6, 0.2};
    CHECK(seedsOf(Two(limb).influences)[0] == Vertices{1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE(
    "a claim is weaker the farther its bone, but for the tissue on it and for what is surely the bone's") {
    TriangleMesh skin;
    for (int k = 0; k <= 40; ++k) {
        skin.vertices.emplace_back(k, 0, 0);
        skin.vertices.emplace_back(k, 1, 0);
    }
    for (int k = 0; k < 80; k += 2) {
        skin.triangles.emplace_back(k, k + 2, k + 1);
        skin.triangles.emplace_back(k + 1, k + 2, k + 3);
    }
    std::vector<std::pair<double, double>> distances;
    for (int k = 0; k <= 40; ++k)
        for (int side = 0; side < 2; ++side)
            distances.push_back(k < 12 ? std::pair(0.05, 0.9) : std::pair(0.9, k > 28 ? 0.05 : 0.8));
    distances[2 * 4] = {0.002, 0.9};
    distances[2 * 5] = {0.008, 0.9};
    distances[2 * 6] = {0.02, 0.9};
    Two two(distances);
    two.influences[0].certain = {2 * 12, 2 * 12 + 1};
    const SkinClaims claims = claimSkin(skin, skinGraph(skin), two.influences);
    const auto weight = [&](int k) { return claims.weight[2 * static_cast<std::size_t>(k)]; };
    CHECK(weight(4) == Approx(weight(5)));               // both within 0.01
    CHECK(weight(4) == Approx(4 * weight(6)));           // 0.02
    CHECK(weight(3) == Approx(9 * weight(12)));          // 0.05, and 0.9 that counts as 0.15
    CHECK(weight(3) == Approx(8 * 0.5 / (0.05 * 0.05))); // 0.5: the area about it
}
