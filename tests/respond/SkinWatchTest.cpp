#include "SkinShapes.h"

#include "bake/respond/SkinWatch.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

namespace {

/// A rig as its muscles stand, and what each look-up finds there.
struct Stand {
    explicit Stand(std::shared_ptr<const SkinRig> of) : rig(std::move(of)) {}

    std::size_t count() const { return rig->rows.size() + rig->pokes.size(); }

    void place(std::span<const double> activations, const Pose& pose = Pose::Identity()) {
        placeMuscles(*rig, activations, std::vector<Pose>(rig->muscles.size(), pose), scene);
    }
    SkinContact lookUp(std::size_t i) const {
        const std::size_t rows = rig->rows.size();
        return i < rows ? rowContact(*rig, scene, i) : pokeContact(*rig, scene, i - rows);
    }
    /// How far skin that only muscles carry is from pushing.
    double slack(std::size_t i, const SkinContact& contact) const {
        const std::size_t rows = rig->rows.size();
        double distance = contact.distance - (i < rows ? rig->rowOffsets[i] : rig->pokeOffsets[i - rows]);
        for (int k = 0; k < contact.vertices; ++k) {
            const std::uint32_t v = contact.vertex[k];
            distance += contact.weight[k] * contact.normal.dot(scene.predicted[v] - rig->rest[v]);
        }
        return distance;
    }

    std::shared_ptr<const SkinRig> rig;
    SkinScene scene;
};

} // namespace

TEST_CASE(
    "a look-up is due when nothing is known, when the plane pushes, and when things have moved that far") {
    Stand stand(skins::usual().rig());
    SkinWatch watch(*stand.rig);
    stand.place(std::vector<double>{0.5});
    std::size_t i = 0;
    while (!stand.lookUp(i).found()) ++i;
    CHECK(watch.due(*stand.rig, stand.scene, i, 1));
    watch.note(*stand.rig, stand.scene, i, stand.lookUp(i));
    CHECK_FALSE(watch.due(*stand.rig, stand.scene, i, 1e-6f));
    CHECK(watch.due(*stand.rig, stand.scene, i, 0));
    CHECK(watch.due(*stand.rig, stand.scene, i, -1));
    stand.place(std::vector<double>{0.6});
    CHECK(watch.due(*stand.rig, stand.scene, i, 1e-6f));
    CHECK_FALSE(watch.due(*stand.rig, stand.scene, i, 1));
    watch.forget();
    CHECK(watch.due(*stand.rig, stand.scene, i, 1));
}

TEST_CASE("a muscle far from where it was looked up comes near and is looked up in time") {
    Stand stand(skins::usual().rig());
    SkinWatch watch(*stand.rig);
    const auto away = [](double by) { return Pose(Eigen::Translation3d(0, 0, -by)); };
    stand.place(std::vector<double>{0}, away(0.3));
    for (std::size_t i = 0; i < stand.rig->rows.size(); ++i) {
        const SkinContact contact = stand.lookUp(i);
        REQUIRE_FALSE(contact.found());
        REQUIRE(contact.clear > 0);
        watch.note(*stand.rig, stand.scene, i, contact);
    }
    std::size_t spared = 0, found = 0;
    for (int step = 29; step >= 0; --step) {
        stand.place(std::vector<double>{0}, away(0.01 * step));
        INFO("away by " << 0.01 * step);
        for (std::size_t i = 0; i < stand.rig->rows.size(); ++i) {
            const bool there = stand.lookUp(i).found(), due = watch.due(*stand.rig, stand.scene, i, 0);
            CHECK((due || !there));
            spared += !due;
            found += there;
        }
    }
    CHECK(spared > stand.rig->rows.size());
    CHECK(found > stand.rig->rows.size());
}

TEST_CASE("what is not due would not push") {
    Stand stand(skins::usual().rig());
    SkinWatch watch(*stand.rig);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> any(-0.1, 1);
    std::size_t spared = 0, looked = 0;
    for (int round = 0; round < 40; ++round) {
        const double from = any(random), to = std::clamp(from + 0.2 * any(random), -0.1, 1.0);
        stand.place(std::vector<double>{from});
        std::vector<double> slack(stand.count(), 0);
        for (std::size_t i = 0; i < slack.size(); ++i) {
            const SkinContact contact = stand.lookUp(i);
            if (contact.found()) slack[i] = stand.slack(i, contact);
            watch.note(*stand.rig, stand.scene, i, contact);
        }
        stand.place(std::vector<double>{to});
        for (std::size_t i = 0; i < slack.size(); ++i) {
            ++looked;
            if (watch.due(*stand.rig, stand.scene, i, static_cast<float>(slack[i]))) continue;
            ++spared;
            const SkinContact contact = stand.lookUp(i);
            INFO("from " << from << " to " << to << ", contact " << i);
            if (contact.found()) CHECK(stand.slack(i, contact) > 0);
        }
    }
    INFO(spared << " of " << looked);
    CHECK(spared > looked / 4);
}
