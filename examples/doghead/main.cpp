#include "bake/base/Error.h"
#include "bake/scene/SceneFile.h"
#include "examples/doghead/DogScenes.h"

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

namespace {

void write(const tss::SceneModel& scene, const std::filesystem::path& file) {
    for (const tss::Body& body : scene.bodies)
        std::fprintf(stderr, "  %-34s %6zu triangles\n", body.path.c_str(), body.mesh.triangles.size());
    tss::saveScene(scene, file.string());
    std::fprintf(stderr, "%s\n", file.string().c_str());
}

struct Named {
    const char* name;
    tss::SceneModel (*make)();
};
constexpr Named all[] = {{"dog_jaw", doghead::jawScene},
                         {"dog_frontalis", doghead::frontalisScene},
                         {"dog_face", [] { return doghead::faceScene(); }},
                         {"dog_ears", doghead::earsScene},
                         {"dog_lips", doghead::lipsScene},
                         {"dog_head", doghead::headScene}};

} // namespace

/// tss-dog [DIR [NAME...]]: writes the repository's own dog into a folder, all scenes or those named.
int main(int count, char** arguments) {
    if (count > 1 && arguments[1][0] == '-') {
        std::fprintf(stderr, "usage: tss-dog [DIR [NAME...]]\n\nWrites NAME.tss into DIR (default: the "
                             "current folder), by default each of:\n");
        for (const Named& scene : all) std::fprintf(stderr, "  %s\n", scene.name);
        return count == 2 && !std::strcmp(arguments[1], "--help") ? 0 : 2;
    }
    try {
        const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
        std::filesystem::create_directories(folder);
        for (const Named& scene : all) {
            bool wanted = count <= 2;
            for (int k = 2; k < count; ++k) wanted = wanted || !std::strcmp(arguments[k], scene.name);
            if (wanted) write(scene.make(), folder / (std::string(scene.name) + ".tss"));
        }
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tss-dog: %s\n", error.what());
        return 1;
    }
}
