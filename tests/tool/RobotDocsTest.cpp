// docs/ROBOTS.md is run as it stands there.
#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>

#if defined(OSGTSS_HAVE_URDF) && defined(OSGTSS_HAVE_MJCF)
TEST_CASE("every command of docs/ROBOTS.md does what it says, one after the other") {
    const Folder folder;
    const std::vector<Ran> commands = runPage("ROBOTS.md", folder.path());
    REQUIRE(commands.size() == 11);
    // What it says comes next is what the page goes on with, finer.
    CHECK((commands[0].out + commands[0].err).find("next: tss bake arm.tss -o BAKED.tss --budget 120\n") !=
          std::string::npos);
    const std::string srdf = readText(folder.path() / "arm.srdf");
    CHECK(srdf.find("reason=\"Never\"") != std::string::npos);
    CHECK(srdf.find("the meshes meet, as at ") != std::string::npos);
    CHECK(srdf.find("link1=\"base\" link2=\"hand\"") == std::string::npos); // it can hit the base
}
#endif
