#!/usr/bin/env bash
# Film strips of the repository's skin scenes into docs/pictures: every N-th frame of a round of the motion, in rows of
# four. Needs the build of tests/run.sh and ImageMagick.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
export LD_LIBRARY_PATH=$root/build/lib OSG_LIBRARY_PATH=$root/build/lib:$root/build/lib/osgPlugins-3.6.5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
strip() { # SCENE EVERY [OPTION...]
    "$root/build/bin/tss-render" "$root/scenes/$1_baked.tss" -o "$work/$1_%04d.png" --every "$2" --size 640x480 --quiet "${@:3}"
    montage "$work/$1"_*.png -tile 4x -geometry 320x240+1+1 -background '#808080' miff:- |
        convert - +dither -colors 96 -define png:compression-level=9 "PNG8:$root/docs/pictures/$1.png"
}
strip dog_face 16 --frames 113
strip dog_ears 8 --frames 57 --view "$root/examples/views/dog_ears.path"
strip dog_lips 8 --frames 57 --view "$root/examples/views/dog_lips.path"
strip dog_frontalis 8 --frames 57 --view "$root/examples/views/dog_frontalis.path"
# A captured brow beside ours: needs the real meshes, and the shapes that the test writes.
if [ -d "$root/../shared/meshes" ]; then
    "$root/build/bin/test_respond" "a frontalis set up from its anatomy*" >/dev/null
    for state in rest muscle captured; do
        "$root/build/bin/tss-render" "$root/build/brow_$state.obj" -o "$work/brow_$state.png" --frames 1 --quiet \
            --size 640x640 --view "$root/examples/views/human_brow.path" 2>/dev/null
    done
    montage "$work"/brow_{rest,muscle,captured}.png -tile 3x -geometry 400x400+1+1 -background '#808080' miff:- |
        convert - +dither -colors 96 -define png:compression-level=9 "PNG8:$root/docs/pictures/human_brow.png"
fi
