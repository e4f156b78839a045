#include "bake/model/Kinematics.h"
#include "bake/play/Player.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinFollowMeasure.h"
#include "bake/respond/SkinResponse.h"
#include "bake/scene/SceneFile.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace tss;

namespace {

/// An animated scene with one skin, and what the skin is asked at time codes that are `apart`.
struct Played {
    explicit Played(const std::string& file, double apart = 1)
        : scene(loadScene(std::string(OSGTSS_SOURCE_DIR) + "/scenes/" + file)),
          response(skinRig(scene, scene.skins.at(0))) {
        SceneModel joints = scene;
        joints.skins.clear();
        std::vector<std::string> warnings;
        Player player(joints, warnings);
        for (double time = scene.startTimeCode; time <= scene.endTimeCode; time += apart) {
            const std::vector<double> values = player.step(drivenValues(scene, time), time).values;
            poses.push_back(skinPoses(scene, scene.skins[0], posedBodies(scene, values)));
            poses.back().resize(response.rig().bodies.size(), Pose::Identity());
            activations.push_back(skinActivations(scene, scene.skins[0], time));
        }
    }
    SceneModel scene;
    SkinResponse response;
    std::vector<std::vector<Pose>> poses;
    std::vector<std::vector<double>> activations;
};

struct Lacking {
    double mean = 0;      ///< of the most that one lacks at each step, millimetres
    std::size_t rows = 0; ///< that lack more than 0.05 mm, over all steps
};

/// What rows of contact lack where an animated skin stands, each of them looked up at each step.
Lacking lackingOf(Played played) {
    SkinResponse& response = played.response;
    const SkinRig& rig = response.rig();
    SkinScene stand;
    Lacking result;
    for (std::size_t step = 0; step < played.poses.size(); ++step) {
        response.update(played.activations[step], played.poses[step]);
        placeBodies(rig, played.activations[step], played.poses[step], {}, stand);
        for (std::size_t v = 0; v < rig.rest.size(); ++v)
            stand.skin[v].head<3>() =
                rig.places[v].head<3>() + ((response.positions()[v] - rig.rest[v]) / rig.size).cast<float>();
        double most = 0;
        for (const SkinRow& row : rig.rows) {
            const SkinPlane plane = queryContact(rig, stand, row);
            const double lack = plane.found ? -rig.size * static_cast<double>(plane.gap) : 0;
            most = std::max(most, lack);
            result.rows += lack > 0.05;
        }
        result.mean += most;
        std::copy(stand.carried.begin(), stand.carried.end(), stand.skin.begin());
    }
    result.mean /= static_cast<double>(played.poses.size());
    return result;
}

} // namespace

TEST_CASE("what contacts have moved is seen wherever it has come to") {
    // What is left are rows that ask for opposite things. With planes left where the skin has slid away from
    // them, and rows unseen where others had moved their skin to, it was 0.39 mm and 403 rows on dog_head.
    const Lacking head = lackingOf(Played("dog_head_baked.tss")),
                  lips = lackingOf(Played("dog_lips_baked.tss"));
    WARN("lacking at worst, mean over the steps: dog_head "
         << head.mean << " mm, " << head.rows << " rows by more than 0.05 mm; dog_lips " << lips.mean
         << " mm, " << lips.rows << " rows");
    CHECK(head.mean < 0.0075); // 0.0076 with those
    CHECK(head.rows < 4);
    CHECK(lips.mean < 0.007); // 0.009 with at most 8 rounds
    CHECK(lips.rows == 0);
}

TEST_CASE("no animated skin gets deeper into bones and muscles than it is at rest") {
    for (const char* file :
         {"dog_face_baked.tss", "dog_head_baked.tss", "dog_lips_baked.tss", "dog_ears_baked.tss"}) {
        const SceneModel scene = loadScene(std::string(OSGTSS_SOURCE_DIR) + "/scenes/" + file);
        std::vector<std::string> warnings;
        Player player(scene, warnings);
        double deepest = 0; // millimetres
        for (double time = scene.startTimeCode; time <= scene.endTimeCode; ++time)
            deepest = std::max(deepest, player.step(drivenValues(scene, time), time).residualDepths.at(0));
        INFO(file);
        CHECK(deepest < 0.05);
    }
}

TEST_CASE("skin over an ear that turns slowly does not jump") {
    // A push that was kept however far its skin had slid since made it 2.6 mm.
    Played ears("dog_ears_baked.tss", 0.05);
    double farthest = 0; // millimetres, of the steps of a twentieth of a time code
    std::vector<Vec3> before(ears.response.rig().rest);
    for (std::size_t step = 0; step < ears.poses.size(); ++step) {
        ears.response.update(ears.activations[step], ears.poses[step]);
        const auto places = ears.response.positions();
        for (std::size_t v = 0; v < before.size(); ++v)
            farthest = std::max(farthest, (places[v] - before[v]).norm());
        before.assign(places.begin(), places.end());
    }
    CHECK(farthest < 1.2);
}

TEST_CASE("an animated skin stands the same wherever it comes from") {
    for (const char* file :
         {"dog_face_baked.tss", "dog_head_baked.tss", "dog_lips_baked.tss", "dog_ears_baked.tss"}) {
        Played played(file);
        const std::size_t steps = played.poses.size();
        std::vector<std::vector<Vec3>> stood;
        for (std::size_t step = 0; step < steps; ++step) {
            played.response.update(played.activations[step], played.poses[step]);
            const auto places = played.response.positions();
            stood.emplace_back(places.begin(), places.end());
        }
        double off = 0;
        std::size_t steppedOff = 0;
        std::vector<std::size_t> order(steps);
        std::iota(order.begin(), order.end(), std::size_t(0));
        std::shuffle(order.begin(), order.end(), std::mt19937_64(1));
        for (const std::size_t step : order) {
            played.response.update(played.activations[step], played.poses[step]);
            double here = 0;
            for (std::size_t v = 0; v < stood[step].size(); ++v)
                here = std::max(here, (played.response.positions()[v] - stood[step][v]).norm());
            steppedOff += here > 0;
            off = std::max(off, here);
        }
        INFO(file << ": " << steppedOff << " of " << steps << " steps stand elsewhere, by up to " << off);
        CHECK(off == 0);
    }
}

TEST_CASE("no animated skin turns a triangle over, or draws its edges out further than was measured") {
    struct Scene {
        const char* file;
        double shortest, longest; ///< edges, of their length at rest: 1st and 99th percentile, docs/SKIN.md
    };
    // A skin that becomes better fails here too: the figures are then stated anew, not left behind.
    for (const Scene& scene :
         {Scene{"dog_frontalis_baked.tss", 0.79, 1.33}, Scene{"dog_face_baked.tss", 0.78, 1.31},
          Scene{"dog_head_baked.tss", 0.78, 1.59}, Scene{"dog_lips_baked.tss", 0.87, 1.37},
          Scene{"dog_ears_baked.tss", 0.75, 1.76}}) {
        Played played(scene.file);
        const SkinModel& skin = played.scene.skins[0];
        const auto bodies = skinMuscles(played.scene, skin);
        const SkinFollowMeasure measure(played.scene.bodies[skin.body].mesh, bodies, played.response.rig());
        SkinFollowing worst;
        for (std::size_t step = 0; step < played.poses.size(); ++step) {
            played.response.update(played.activations[step], played.poses[step]);
            worst.worsen(measure.at(played.response.positions(), played.poses[step]));
        }
        INFO(scene.file);
        CHECK(worst.turnedOver == 0);
        CHECK_THAT(worst.shortest, Catch::Matchers::WithinAbs(scene.shortest, 0.01));
        CHECK_THAT(worst.longest, Catch::Matchers::WithinAbs(scene.longest, 0.01));
    }
}
