#!/usr/bin/env bash
# The main job, from a bare Debian 12 and a clean clone: installs what is missing, builds what the pictures need, bakes
# the repository's two dog scenes and has stock osgviewer render them off screen; then builds the rest and makes the
# reports of error against run time. Everything it makes is in build/ and out/.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
source tests/setup.sh

[ $# -eq 0 ] || {
    echo "usage: examples/run.sh" >&2
    exit 2
}

install_packages build pictures
parts "building what the pictures need=4" "two scenes, baked and rendered=1" \
      "building the rest: readers, the report, the examples=3" "error against run time=2"

# What the pictures do not need, the tests, the report and the readers of others' files, is not there yet; where it has
# been built, it stays.
only_pictures=(-DOSGTSS_TESTS=OFF "${later_parts[@]/%/=OFF}")
[ ! -f build/CMakeCache.txt ] || only_pictures=()
part "building what the pictures need" build_release "${only_pictures[@]}" -- tss osgdb_tss osgdb_capture tss-render

export OSG_LIBRARY_PATH="$root/build/lib:$root/build/lib/osgPlugins-$(pkg-config --modversion openscenegraph)"
export LD_LIBRARY_PATH="$root/build/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
tss=$root/build/bin/tss

# bake <scene>: out/<scene>_baked.tss from scenes/<scene>.tss
bake() {
    say "Baking $1"
    "$tss" bake "scenes/$1.tss" -o "out/$1_baked.tss"
}

# pictures <scene> <frames> <every>: PNG frames of the baked scene, one time code a frame
pictures() {
    say "Rendering $1: every ${3}th of $2 frames"
    rm -f "out/$1"_*.png
    # The capture pseudo-loader of examples/capture saves what osgviewer draws; -noreset, or Xvfb may end with the
    # first program that leaves it.
    LIBGL_ALWAYS_SOFTWARE=1 OSG_RUN_FRAME_COUNT=$(($2 + 1)) \
        xvfb-run -a -s "-screen 0 1024x768x24 -noreset" \
        osgviewer --SingleThreaded --samples 4 --clear-color 0.16,0.18,0.22 --borderless-window 0 0 1024 768 \
        -p "examples/views/$1.path" -O "clock=frame capture=out/$1_%04d.png every=$3" "out/$1_baked.tss.capture"
    ls "out/$1"_*.png >/dev/null || {
        echo "examples/run.sh: osgviewer left no pictures of $1" >&2
        exit 1
    }
}

bake_and_render() {
    mkdir -p out
    bake dog_jaw
    bake dog_frontalis
    pictures dog_jaw 96 8
    pictures dog_frontalis 72 8
    say "The jaw's table, proven again"
    "$tss" verify out/dog_jaw_baked.tss
}

tell_pictures() {
    echo "pictures: $root/out/dog_jaw_*.png ($(ls out/dog_jaw_*.png | wc -l)), $root/out/dog_frontalis_*.png ($(ls out/dog_frontalis_*.png | wc -l))"
    echo "scenes:   $root/out/dog_jaw_baked.tss, $root/out/dog_frontalis_baked.tss (osgviewer plays them)"
}

part "two scenes, baked and rendered" bake_and_render
say "After $(minutes_since "$started"), packages apart"
tell_pictures

install_packages report
part "building the rest: readers, the report, the examples" build_release "${later_parts[@]/%/=ON}"

make_reports() {
    local scene
    for scene in dog_jaw dog_frontalis; do
        "$tss" report "scenes/$scene.tss" -o "out/report_$scene" --quick
    done
}
part "error against run time" make_reports

say "Done after $(minutes_since "$started"), packages apart"
tell_pictures
echo "reports:  $root/out/report_dog_jaw/report.md, $root/out/report_dog_frontalis/report.md (docs/REPORT.md is the full one)"
