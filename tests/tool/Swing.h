#pragma once
#include "tests/Shapes.h"
#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>

/// A ball of radius 10 and one of radius 5 that swings about the Z axis and can hit it.
inline void writeSwing(const Folder& folder) {
    writeObj(ballMesh({0, 0, 0}, 10, 3), folder / "still.obj");
    writeObj(ballMesh({0, 30, 0}, 5, 3), folder / "swing.obj");
    const Ran made = runTss("make -o swing.tss --a still.obj --b swing.obj --meters-per-unit 0.001 "
                            "--dof rot:25,0,0:0,0,1:-40:90",
                            folder.path());
    INFO(made.err);
    REQUIRE(made.exit == 0);
}
