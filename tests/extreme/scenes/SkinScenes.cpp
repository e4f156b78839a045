#include "tests/extreme/scenes/Builders.h"

#include "tests/respond/SkinShapes.h"

#include <fmt/format.h>

namespace extreme {

namespace {

struct Stiffness {
    double stretch, bend;
};

/// One muscle under as many skins as there are pairs of compliances.
SceneModel skinScene(const std::vector<Stiffness>& skins, const tss::TimeSamples& activation,
                     double unit = 1) {
    SceneModel scene;
    scene.defaultPrim = "Scene";
    scene.endTimeCode = activation.times.back();
    tss::MuscleModel muscle;
    muscle.path = "/Scene/Muscle";
    muscle.muscle = skins::muscleBelow(0);
    for (Vec3& v : muscle.muscle.surface.vertices) v *= unit;
    for (Vec3& v : muscle.muscle.fibre) v *= unit;
    muscle.muscle.surface = inFloat(muscle.muscle.surface);
    for (Vec3& v : muscle.muscle.fibre) v = v.cast<float>().cast<double>();
    muscle.activation = activation;
    muscle.body = 0;
    tss::Body surface;
    surface.path = "/Scene/MuscleSurface";
    surface.mesh = muscle.muscle.surface;
    scene.bodies.push_back(surface);
    scene.muscles.push_back(muscle);
    for (std::size_t k = 0; k < skins.size(); ++k) {
        tss::Body body;
        body.path = fmt::format("/Scene/Skin{}", k);
        body.mesh = skins::vaultedSheet(16, 1, 0.01, 0.3);
        for (Vec3& v : body.mesh.vertices) v *= unit;
        body.mesh = inFloat(body.mesh);
        tss::SkinModel skin;
        skin.path = body.path;
        skin.body = static_cast<int>(scene.bodies.size());
        skin.muscles = {0};
        skin.thickness = 0.03125 * unit;
        skin.travel = 0.03125 * unit;
        skin.stretchCompliance = skins[k].stretch;
        skin.bendCompliance = skins[k].bend;
        scene.bodies.push_back(std::move(body));
        scene.skins.push_back(skin);
    }
    return scene;
}

tss::TimeSamples ramp() {
    return {{0, 12, 24}, {0, 1, 0}};
}

tss::TimeSamples flicker() {
    tss::TimeSamples samples;
    for (int t = 0; t <= 24; ++t) {
        samples.times.push_back(t);
        samples.values.push_back(t % 2);
    }
    return samples;
}

std::string clocked(double timeCodesPerSecond) {
    SceneModel scene = skinScene({{0, 0}}, ramp());
    scene.timeCodesPerSecond = timeCodesPerSecond;
    return textOf(scene);
}

} // namespace

std::vector<ExtremeScene> skinScenes() {
    const std::vector<Stiffness> stiff = {{0, 0},       {1e-12, 1e12},  {1e12, 1e-12},
                                          {1e12, 1e12}, {1e-12, 1e-12}, {0, 1e12}};
    const std::string bounded = "bounded at every frame, and at rest exactly as modelled";
    return {
        {"skin_compliances", "compliance 0, 1e-12 ... 1e12 in one skin", bounded, Fate::Skin, "",
         textOf(skinScene(stiff, ramp()))},
        {"skin_micrometre", "units from 1e-6 to 1e6", "the skin in metres, times 1e6", Fate::Skin, "",
         textOf(skinScene({{0, 0}}, ramp(), 1e6))},
        {"skin_megametre", "units from 1e-6 to 1e6", "the skin in metres, times 1e-6", Fate::Skin, "",
         textOf(skinScene({{0, 0}}, ramp(), 1e-6))},
        {"skin_flicker", "activation 0→1→0 every frame",
         "every second frame is exactly at rest, the others "
         "are all alike",
         Fate::Skin, "", textOf(skinScene({{0, 0}}, flicker()))},
        {"skin_frame_1e-6s", "frame times 1e-6 s to 10 s", "the same shapes at the same time codes",
         Fate::Skin, "", clocked(1e6)},
        {"skin_frame_10s", "frame times 1e-6 s to 10 s", "the same shapes at the same time codes", Fate::Skin,
         "", clocked(0.1)},
        {"skin_million", "a million frames", "no creep, no growth, no slow-down", Fate::Skin, "",
         textOf(skinScene({{0, 0}}, ramp()))},
    };
}

} // namespace extreme
