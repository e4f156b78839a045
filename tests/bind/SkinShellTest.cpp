// Shells of a skin that no bone begins on: clothes, shoes, things in a hand.
#include "bake/base/Infinity.h"
#include "bake/bind/SkinShares.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// A strip of skin from x 0 to 10 on two bones, the left one up to 5; far above it nothing is near a bone.
class OnTwoBones {
public:
    OnTwoBones() {
        band(0, 10, 0, 0);
        for (std::size_t h = 0; h < 2; ++h) {
            influences[h].size = 10;
            for (const Vec3& v : skin.vertices)
                influences[h].distance.push_back((v.x() <= 5) == (h == 0) ? 0.1 : 9);
        }
    }

    /// A band of its own along x, each step of which takes it up by `rise`; left and right: how far the bones
    /// are from it. Returns its first vertex, at the end at `from`.
    std::size_t shell(double from, double to, double height, double rise, double left, double right) {
        const std::size_t first = skin.vertices.size();
        band(from, to, height, rise);
        influences[0].distance.resize(skin.vertices.size(), left);
        influences[1].distance.resize(skin.vertices.size(), right);
        return first;
    }

    std::vector<double> ofRight() const { return claimedShares(skin, skinGraph(skin), influences)[1]; }

    TriangleMesh skin;
    std::vector<SkinInfluence> influences = std::vector<SkinInfluence>(2);

private:
    void band(double from, double to, double height, double rise) {
        const auto first = static_cast<int>(skin.vertices.size());
        const int steps = std::max(1, static_cast<int>(std::abs(to - from)));
        for (int i = 0; i <= steps; ++i)
            for (int y = 0; y < 2; ++y)
                skin.vertices.emplace_back(from + (to - from) * i / steps, y, height + rise * i);
        for (int i = first; i < first + 2 * steps; i += 2) {
            skin.triangles.emplace_back(i, i + 2, i + 1);
            skin.triangles.emplace_back(i + 1, i + 2, i + 3);
        }
    }
};

} // namespace

TEST_CASE("a shell without a seed goes with the skin below it, however near another bone is") {
    OnTwoBones body;
    const std::size_t cloth = body.shell(8, 10, 1, 0, 1.9, 2);
    const std::vector<double> right = body.ofRight();
    for (std::size_t v = cloth; v < right.size(); ++v) CHECK(right[v] > 0.95);
}

TEST_CASE("a shell without a seed that is nearer to a bone than to all skin goes with the bone") {
    OnTwoBones body;
    const std::size_t cloth = body.shell(8, 10, 3, 0, 2, 4);
    const std::vector<double> right = body.ofRight();
    for (std::size_t v = cloth; v < right.size(); ++v) CHECK(right[v] < 0.05);
}

TEST_CASE("shoes go with trousers and these with hips, though another part of the body is nearer") {
    OnTwoBones body;
    const std::size_t trousers = body.shell(9.5, 3.5, 0.05, 0.5, 9, 9); // from the right bone's skin upwards
    const std::size_t shoe = body.shell(3.5, 2, 3.1, 0, 9, 9);          // at their end, above the left one's
    const std::vector<double> right = body.ofRight();
    for (std::size_t v = trousers; v < right.size(); ++v) CHECK(right[v] > 0.8);
    const std::vector<ShellVertex> shells = bindShells(body.skin, body.influences, [&] {
        std::vector<double> seeded(body.skin.vertices.size(), infinity);
        std::fill(seeded.begin(), seeded.begin() + static_cast<std::ptrdiff_t>(trousers), 0.0);
        return seeded;
    }());
    CHECK(shells[0].round == -1);
    CHECK(shells[trousers].round == 0);
    CHECK(shells[shoe].round == 1);
}

TEST_CASE("a thing in a hand goes with the hand alone, though its other end is beside the body") {
    OnTwoBones body;
    const std::size_t staff =
        body.shell(10, 2, 0.05, 0.25, 9, 9); // from the right bone's skin over the left one's
    const std::vector<double> right = body.ofRight();
    for (std::size_t v = staff; v < right.size(); ++v) CHECK(right[v] > 0.8);
}

TEST_CASE("where all skin has a seed there are no shells") {
    const OnTwoBones body;
    CHECK(bindShells(body.skin, body.influences, std::vector<double>(body.skin.vertices.size(), 1)).empty());
}

TEST_CASE("shells about as far from skin as the nearest one are bound with it, farther ones after it") {
    OnTwoBones body;
    const std::size_t bare = body.skin.vertices.size();
    std::vector<std::size_t> shells; // beside each other, so that each is nearest to the skin
    for (const double height : {0.5, 0.7, 0.9, 1.2}) {
        const double x = 2.0 * static_cast<double>(shells.size());
        shells.push_back(body.shell(x, x + 1, height, 0, 9, 9));
    }
    std::vector<double> seeded(body.skin.vertices.size(), infinity);
    std::fill(seeded.begin(), seeded.begin() + static_cast<std::ptrdiff_t>(bare), 0.0);
    const std::vector<ShellVertex> made = bindShells(body.skin, body.influences, seeded);
    for (std::size_t k = 0; k < shells.size(); ++k) CHECK(made[shells[k]].round == (k < 3 ? 0 : 1));
}
