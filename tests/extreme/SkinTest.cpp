#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"
#include "tests/extreme/Served.h"
#include "tests/extreme/tool/LongRun.h"

#include <cmath>

using namespace extreme;

namespace {

std::vector<tss::Vec3> shapeAt(const tss::SceneModel& scene, const std::vector<double>& activations) {
    tss::SkinResponse response(tss::skinRig(scene, scene.skins[0]));
    for (const double a : activations) response.update(std::vector<double>{a});
    return {response.positions().begin(), response.positions().end()};
}

const tss::SceneModel& skinScene(const std::string& name) {
    REQUIRE(served(name).refusal.empty());
    return served(name).scene;
}

} // namespace

TEST_CASE("skins of compliance 0 and 1e-12 to 1e12 stay bounded, move, and come back exactly") {
    const tss::SceneModel& scene = skinScene("skin_compliances");
    REQUIRE(scene.skins.size() == 6);
    for (const tss::SkinModel& skin : scene.skins) {
        INFO(skin.path);
        tss::SkinResponse response(tss::skinRig(scene, skin));
        double farthest = 0;
        for (int frame = 0; frame < 200; ++frame) {
            response.update(std::vector<double>{0.5 - 0.5 * std::cos(0.3 * frame)});
            for (std::size_t k = 0; k < response.positions().size(); ++k) {
                REQUIRE(response.positions()[k].allFinite());
                farthest = std::max(farthest, (response.positions()[k] - response.rig().rest[k]).norm());
            }
        }
        CHECK(farthest > 0.01);
        CHECK(farthest < 0.3); // the muscle shortens by 0.3 at most
        CHECK(response.update(std::vector<double>{0}).rest);
        for (std::size_t k = 0; k < response.positions().size(); ++k)
            CHECK(response.positions()[k] == response.rig().rest[k]);
    }
}

TEST_CASE("a skin in other units moves as it does in metres") {
    const std::vector<double> way{0.2, 0.5, 1, 1, 0.7};
    const auto metres = shapeAt(skinScene("skin_million"), way);
    for (const auto& [name, unit] : {std::pair{"skin_micrometre", 1e6}, {"skin_megametre", 1e-6}}) {
        const auto shape = shapeAt(skinScene(name), way);
        REQUIRE(shape.size() == metres.size());
        double most = 0;
        for (std::size_t k = 0; k < shape.size(); ++k)
            most = std::max(most, (shape[k] / unit - metres[k]).norm());
        CHECK(most < 2e-4);
    }
}

TEST_CASE("a muscle that flickers gives the same shape every time, and rest in between, in each bit") {
    const tss::SceneModel& scene = skinScene("skin_flicker");
    tss::SkinResponse response(tss::skinRig(scene, scene.skins[0]));
    std::vector<tss::Vec3> first;
    for (int frame = 0; frame < 200; ++frame) {
        response.update(std::vector<double>{frame % 2 ? 1. : 0.});
        const std::vector<tss::Vec3> now(response.positions().begin(), response.positions().end());
        if (frame == 1) first = now;
        CHECK((now == (frame % 2 ? first : response.rig().rest)));
    }
}

TEST_CASE("frames of a millionth of a second and of ten seconds have the same shapes") {
    const tss::SceneModel &quick = skinScene("skin_frame_1e-6s"), &slow = skinScene("skin_frame_10s");
    CHECK(quick.timeCodesPerSecond == 1e6);
    CHECK(slow.timeCodesPerSecond == 0.1);
    std::vector<double> way;
    for (int code = 0; code <= 24; ++code) {
        const auto activations = tss::skinActivations(quick, quick.skins[0], code);
        CHECK(activations == tss::skinActivations(slow, slow.skins[0], code));
        way.push_back(activations[0]);
        CHECK(shapeAt(quick, way) == shapeAt(slow, way));
    }
}

TEST_CASE("a skin does not creep over some thousand frames, nor does its memory grow") {
    for (const bool rest : {true, false}) {
        const ManyFrames run = playFrames(skinScene("skin_million"), 3000, rest);
        INFO("creep " << run.creep << " growth " << run.growth);
        CHECK(run.creep <= (rest ? 0 : 1e-6 * run.size));
        CHECK(run.growth < 1000000);
        CHECK(run.subnormals == 0);
    }
}

TEST_CASE("a skin neither creeps nor grows nor slows down over a million frames", "[.long]") {
    for (const bool rest : {true, false}) {
        const ManyFrames run = playFrames(skinScene("skin_million"), 1000000, rest);
        INFO("creep " << run.creep << " growth " << run.growth << " slowdown " << run.slowdown);
        CHECK(run.creep <= (rest ? 0 : 1e-6 * run.size));
        CHECK(run.growth < 1000000);
        CHECK(run.slowdown < 1.2);
        CHECK(run.subnormals == 0);
    }
}
