// Tables of skins damaged: what verify lets pass claims nothing, and keeps what verify says it has looked at.
#include "tests/adversary/scenes/SkinDamage.h"
#include "bake/base/Error.h"
#include "bake/check/VerifySkin.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/pipeline/Bake.h"
#include "bake/play/SkinSetup.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "bake/spheres/RoundToFloat.h"
#include "tests/extreme/scenes/Builders.h"
#include "tests/respond/SkinShapes.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace adversary;
using tss::SceneModel;
using tss::SkinTable;
using tss::Vec3;

namespace {

/// A vaulted skin over one to three muscles; how, goes by the number. Written and read again.
SceneModel bakedSkin(std::uint64_t number) {
    SceneModel scene;
    scene.defaultPrim = "Scene";
    const int muscles = 1 + int(number % 3);
    tss::SkinModel skin;
    for (int m = 0; m < muscles; ++m) {
        tss::MuscleModel muscle;
        muscle.path = fmt::format("/Scene/Muscle{}", m);
        muscle.muscle = skins::muscleBelow(0.02 * double(number % 4) - 0.03, 0.1 + 0.05 * double(number % 5),
                                           0.35 * (m - 0.5 * (muscles - 1)));
        muscle.muscle.surface = extreme::inFloat(muscle.muscle.surface);
        for (Vec3& v : muscle.muscle.fibre) v = v.cast<float>().cast<double>();
        muscle.activation = {{0, 24}, {0, 1}};
        muscle.body = m;
        tss::Body surface;
        surface.path = muscle.path + "Surface";
        surface.mesh = muscle.muscle.surface;
        scene.bodies.push_back(surface);
        scene.muscles.push_back(muscle);
        skin.muscles.push_back(m);
    }
    tss::Body body;
    body.path = skin.path = "/Scene/Skin";
    body.mesh = extreme::inFloat(skins::vaultedSheet(number % 2 ? 16 : 24, 1, 0.01, 0.3));
    skin.body = int(scene.bodies.size());
    skin.thickness = number % 4 == 3 ? 0 : 0.03;
    skin.travel = number % 5 == 2 ? 0 : 0.02;
    scene.bodies.push_back(body);
    if (number % 6 == 4) skin.settings["spheres"] = "shrinking";
    if (number % 7 == 5) skin.settings["tolerance"] = "0.05";
    scene.skins.push_back(skin);
    scene = extreme::readText(extreme::textOf(scene), "skin");
    tss::bake(scene, {});
    return extreme::readText(tss::writeJson(tss::layerOf(scene)), "baked");
}

/// What a skin's table does not tell, looked for between the activations that the verifier looks at, with
/// the exact shapes and every vertex.
class Judge {
public:
    explicit Judge(const SceneModel& scene)
        : skin_(scene.bodies[scene.skins[0].body].mesh), muscles_(tss::skinMuscles(scene, scene.skins[0])),
          thickness_(scene.skins[0].thickness > 0 ? scene.skins[0].thickness
                                                  : scene.skins[0].table->table.a[0].radius) {
        for (const auto& muscle : muscles_)
            for (const double activation : {0.0, 0.13, 0.37, 0.61, 0.87, 1.0}) {
                State state{muscle->state(activation), {}};
                tss::TriangleMesh surface = muscle->muscle().surface;
                surface.vertices = muscle->vertices(state.state);
                const tss::MeshQuery query(surface);
                for (const Vec3& v : skin_.vertices) state.distance.push_back(query.distance(v));
                states_[muscle.get()].push_back(std::move(state));
            }
    }

    /// Vertices that a muscle is near without a test that says so: later than rounding at rest, later than
    /// the skin is thick on the way.
    int missed(const SkinTable& table) const {
        int missed = 0;
        for (std::size_t m = 0; m < muscles_.size(); ++m)
            for (const State& state : states_.at(muscles_[m].get())) {
                std::vector<Vec3> centres;
                std::vector<double> radii;
                for (const tss::Sphere& sphere : table.table.b) {
                    const tss::MusclePoint point = muscles_[m]->bind(sphere.centre);
                    centres.push_back(muscles_[m]->map(point, state.state));
                    radii.push_back(sphere.radius * muscles_[m]->thickness(point.s, state.state));
                }
                missed += missedAt(table, std::uint32_t(m), state, centres, radii);
            }
        return missed;
    }

    int near() const {
        int count = 0;
        for (const auto& [muscle, states] : states_)
            for (const State& state : states)
                count += int(std::count_if(state.distance.begin(), state.distance.end(),
                                           [&](double d) { return d < 0.98 * thickness_; }));
        return count;
    }

private:
    struct State {
        tss::MuscleState state;
        std::vector<double> distance; ///< of each vertex from the surface
    };

    int missedAt(const SkinTable& table, std::uint32_t m, const State& state,
                 const std::vector<Vec3>& centres, const std::vector<double>& radii) const {
        std::vector<double> told(skin_.vertices.size(), 1e300);
        for (std::size_t i = 0; i < table.table.a.size(); ++i)
            for (std::uint32_t k = table.table.rowOffsets[i]; k < table.table.rowOffsets[i + 1]; ++k) {
                const std::uint32_t j = table.table.columns[k], v = table.skinVertices[i];
                if (table.muscleOf[j] != m) continue;
                // Where the table says that its sphere is, as large as it says.
                const double gap = (centres[j] - table.table.a[i].centre).norm() - radii[j] -
                                   (table.table.a[i].radius - thickness_);
                told[v] = std::min(told[v], gap);
            }
        const double granted = state.state.activation == 0 ? 1e-5 * thickness_ : 1.02 * thickness_;
        int missed = 0;
        for (std::size_t v = 0; v < told.size(); ++v)
            missed += state.distance[v] < 0.98 * thickness_ && told[v] > state.distance[v] + granted;
        return missed;
    }

    tss::TriangleMesh skin_;
    std::vector<std::shared_ptr<const tss::MuscleDeformer>> muscles_;
    double thickness_;
    std::map<const tss::MuscleDeformer*, std::vector<State>> states_;
};

struct Tally {
    int tried = 0, refused = 0, harmful = 0;
};

void damageSkin(std::uint64_t number, Tally& tally) {
    const SceneModel scene = bakedSkin(number);
    REQUIRE(scene.skins[0].table);
    const SkinTable& honest = *scene.skins[0].table;
    const tss::SkinVerdict verdict = verifySkin(scene, scene.skins[0]);
    INFO(verdict.reason);
    CHECK(verdict.holds());
    const Judge judge(scene);
    CHECK(judge.near() > 20);
    CHECK(judge.missed(honest) == 0);
    std::mt19937_64 random(number);
    for (const SkinDamage& damage : skinDamages(0.03)) {
        CAPTURE(damage.name);
        SceneModel damaged = scene;
        auto table = std::make_shared<SkinTable>(honest);
        damage.apply(*table, random);
        table->table.a = tss::roundToFloat(table->table.a); // as files hold them
        table->table.b = tss::roundToFloat(table->table.b);
        const int missed = judge.missed(*table);
        damaged.skins[0].table = table;
        ++tally.tried;
        tally.harmful += missed > 0;
        std::string why;
        try { // what a file holds of it
            damaged = extreme::readText(tss::writeJson(tss::layerOf(damaged)), "damaged");
            why = verifySkin(damaged, damaged.skins[0]).reason;
        } catch (const tss::InputError& error) {
            why = error.what();
        }
        tally.refused += !why.empty();
        INFO(missed << " places missed");
        if (why.empty()) CHECK(missed == 0);
        if (damage.claims) CHECK_FALSE(why.empty());
    }
}

void damageSkins(std::uint64_t count) {
    Tally tally;
    for (std::uint64_t number = 0; number < count; ++number) {
        CAPTURE(number);
        damageSkin(number, tally);
    }
    WARN(tally.tried << " damages to skins: " << tally.refused << " refused, " << tally.harmful
                     << " shown harmful by the meshes, none of those passed unless said above");
    CHECK(tally.harmful > tally.tried / 8);
}

} // namespace

TEST_CASE("no damaged table of a skin passes that misses what was looked at: fifty kinds on three") {
    CHECK(skinDamages(0.03).size() >= 50);
    damageSkins(3);
}

TEST_CASE("no damaged table of a skin passes that misses what was looked at: fifty kinds on twenty",
          "[.long]") {
    damageSkins(20);
}
