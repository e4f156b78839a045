// Loads a large scene as JSON, as its binary twin and with a buffer: bench_scene [MEGABYTES of the JSON file,
// 100]. Prints the user CPU time of loadScene() and the peak memory of a process that does nothing else.
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

/// Bodies of a size that scans have, their vertices on rough grids with all the digits of floats.
tss::SceneModel largeScene(std::size_t bodies) {
    constexpr int side = 160;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> rough(0, 1);
    tss::SceneModel scene;
    for (std::size_t b = 0; b < bodies; ++b) {
        tss::Body body;
        body.path = "/Scene/Body" + std::to_string(b);
        for (int i = 0; i < side * side; ++i)
            body.mesh.vertices.emplace_back(i % side + rough(random), i / side + rough(random),
                                            rough(random));
        for (int i = 0; i + side < side * side; ++i) {
            if (i % side == side - 1) continue;
            body.mesh.triangles.emplace_back(i, i + 1, i + side);
            body.mesh.triangles.emplace_back(i + 1, i + side + 1, i + side);
        }
        scene.bodies.push_back(std::move(body));
    }
    return scene;
}

/// Loads in a process of its own.
void measure(const char* what, const std::string& file, double bytes) {
    const pid_t child = fork();
    if (child == 0) {
        rusage before, after;
        getrusage(RUSAGE_SELF, &before);
        const tss::SceneModel scene = tss::loadScene(file);
        getrusage(RUSAGE_SELF, &after);
        const auto seconds = [](const timeval& time) {
            return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
        };
        std::printf(
            "%-18s %6.1f MB   user %5.2f s   system %5.2f s   peak memory %4.2f x the file (%zu bodies)\n",
            what, bytes / 1e6, seconds(after.ru_utime) - seconds(before.ru_utime),
            seconds(after.ru_stime) - seconds(before.ru_stime), 1024.0 * double(after.ru_maxrss) / bytes,
            scene.bodies.size());
        std::fflush(stdout);
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
}

/// Makes the files in a process of its own too, so that the measuring ones begin small.
void makeFiles(const std::string& folder, double megabytes) {
    if (const pid_t child = fork(); child != 0) {
        int status = 0;
        waitpid(child, &status, 0);
        return;
    }
    const double one = double(tss::writeJson(tss::toLayer(largeScene(1))).size());
    const tss::Layer layer = tss::toLayer(largeScene(std::size_t(megabytes * 1e6 / one) + 1));
    tss::saveLayer(layer, folder + "/json.tss");
    tss::saveLayer(layer, folder + "/cbor.tss", tss::Encoding::Cbor);
    tss::saveWithBuffer(layer, folder + "/buffer.tss", tss::Encoding::Cbor);
    _exit(0);
}

} // namespace

int main(int count, char** arguments) {
    namespace fs = std::filesystem;
    std::string folder = (fs::temp_directory_path() / "bench-scene-XXXXXX").string();
    if (!mkdtemp(folder.data())) return 1;
    makeFiles(folder, count > 1 ? std::atof(arguments[1]) : 100);
    const auto size = [&](const char* name) { return double(fs::file_size(folder + name)); };
    measure("JSON", folder + "/json.tss", size("/json.tss"));
    measure("binary", folder + "/cbor.tss", size("/cbor.tss"));
    double buffers = 0;
    for (const auto& file : fs::directory_iterator(folder))
        if (file.path().filename().string().starts_with("buffer.")) buffers += double(file.file_size());
    measure("binary and buffer", folder + "/buffer.tss", buffers);
    fs::remove_all(folder);
}
