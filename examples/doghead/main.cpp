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

} // namespace

/// tss-dog [DIR]: writes dog_jaw.tss and dog_frontalis.tss, the repository's own dog, into a folder.
int main(int count, char** arguments) {
    if (count > 2 || (count == 2 && arguments[1][0] == '-')) {
        std::fprintf(stderr,
                     "usage: tss-dog [DIR]\n\nWrites dog_jaw.tss and dog_frontalis.tss into DIR (default: "
                     "the current folder).\n");
        return count == 2 && !std::strcmp(arguments[1], "--help") ? 0 : 2;
    }
    try {
        const std::filesystem::path folder = count == 2 ? arguments[1] : ".";
        write(doghead::jawScene(), folder / "dog_jaw.tss");
        write(doghead::frontalisScene(), folder / "dog_frontalis.tss");
        return 0;
    } catch (const tss::InputError& error) {
        std::fprintf(stderr, "tss-dog: %s\n", error.what());
        return 1;
    }
}
