// A skin of a whole head over thirteen muscles that all move at once: bench_skin [FRAMES, 240 [--save FILE]].
// Prints the processor time of an update, by the size of the skin. The largest scene, baked, goes to FILE, to
// be played in osgviewer, or measured alone: bench_skin FRAMES FILE. Instructions an update are what two such
// runs under callgrind differ by, per frame.
#include "bake/pipeline/Bake.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "examples/doghead/DogScenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace {

constexpr int lastCode = 240;

/// Muscle m tightens and lets go again and again, each at its own time.
double activation(std::size_t m, double code) {
    return 0.5 - 0.5 * std::cos(0.1 * code + 2.4 * static_cast<double>(m));
}

tss::SceneModel bakedFace(const doghead::Detail& skin) {
    tss::SceneModel scene = doghead::faceScene(skin);
    scene.endTimeCode = lastCode;
    for (std::size_t m = 0; m < scene.muscles.size(); ++m) {
        tss::TimeSamples& samples = scene.muscles[m].activation;
        samples = {};
        for (int code = 0; code <= lastCode; ++code) {
            samples.times.push_back(code);
            samples.values.push_back(activation(m, code));
        }
    }
    scene = tss::readScene(tss::toLayer(scene), "dog_face"); // its numbers as a file holds them
    tss::bake(scene, {});
    return scene;
}

double cpuSeconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void measure(const tss::SceneModel& scene, const tss::SkinModel& skin, int frames) {
    double start = cpuSeconds();
    tss::SkinResponse response(tss::skinRig(scene, skin));
    const double loading = cpuSeconds() - start;
    const tss::SkinRig& rig = response.rig();
    std::vector<double> activations(skin.muscles.size());
    std::size_t contacts = 0;
    double worst = 0, whole = 0;
    for (int f = 0; f < frames; ++f) {
        for (std::size_t m = 0; m < activations.size(); ++m) activations[m] = activation(m, f);
        start = cpuSeconds();
        contacts += response.update(activations).contacts;
        const double frame = cpuSeconds() - start;
        whole += frame;
        worst = std::max(worst, frame);
    }
    std::size_t carried = 0;
    for (std::size_t v = 0; v < rig.vertices.size(); ++v) carried += !rig.pulls[v].empty();
    std::printf("%6zu vertices   %6zu move   %6zu rows   %5zu contacts   %5.1f MB   "
                "%7.3f ms an update (%.0f a second), worst %.3f   loaded in %.2f s\n",
                scene.bodies[skin.body].mesh.vertices.size(), carried, rig.rows.size(),
                contacts / static_cast<std::size_t>(frames), 1e-6 * static_cast<double>(rig.bytes()),
                1e3 * whole / frames, frames / whole, 1e3 * worst, loading);
}

} // namespace

int main(int count, char** arguments) {
    const int frames = count > 1 ? std::atoi(arguments[1]) : 240;
    const bool saves = count == 4 && std::string_view(arguments[2]) == "--save";
    if (frames < 1 || count > 4 || (count == 4 && !saves)) {
        std::fprintf(stderr, "usage: bench_skin [FRAMES [--save FILE]]\n       bench_skin FRAMES BAKED\n");
        return 2;
    }
    if (count == 3) {
        const tss::SceneModel scene = tss::loadScene(arguments[2]);
        for (const tss::SkinModel& skin : scene.skins) measure(scene, skin, frames);
        return 0;
    }
    for (const doghead::Detail& detail : {doghead::Detail{1.6, 0.4}, {0.9, 0.06}, {0.6, 0.02}}) {
        const tss::SceneModel scene = bakedFace(detail);
        measure(scene, scene.skins.front(), frames);
        if (saves) tss::saveScene(scene, arguments[3]); // the last one stays
    }
}
