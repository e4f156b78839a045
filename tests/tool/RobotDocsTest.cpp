// docs/ROBOTS.md is run as it stands there.
#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>
#include <sstream>

#if defined(OSGTSS_HAVE_URDF) && defined(OSGTSS_HAVE_MJCF)
TEST_CASE("every command of docs/ROBOTS.md does what it says, one after the other") {
    const Folder folder;
    std::filesystem::copy(OSGTSS_SOURCE_DIR "/examples/arm", folder.path() / "arm");
    std::istringstream lines(readText(OSGTSS_SOURCE_DIR "/docs/ROBOTS.md"));
    int commands = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("    tss ")) continue;
        ++commands;
        const Ran ran = runTss(line.substr(8), folder.path());
        INFO(line << "\n" << ran.out << ran.err);
        REQUIRE(ran.exit == 0);
        if (commands == 1) // what it says comes next is what the page goes on with, finer
            CHECK((ran.out + ran.err)
                      .find("next: tss bake arm.tss -o BAKED.tss --tolerance 2mm --budget 5\n") !=
                  std::string::npos);
    }
    CHECK(commands == 11);
    const std::string srdf = readText(folder.path() / "arm.srdf");
    CHECK(srdf.find("reason=\"Never\"") != std::string::npos);
    CHECK(srdf.find("the meshes meet, as at ") != std::string::npos);
    CHECK(srdf.find("link1=\"base\" link2=\"hand\"") == std::string::npos); // it can hit the base
}
#endif
