#!/usr/bin/env bash
# Film strips of the repository's scenes into docs/pictures. Needs the build of tests/run.sh and ImageMagick.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
export LD_LIBRARY_PATH=$root/build/lib OSG_LIBRARY_PATH=$root/build/lib:$root/build/lib/osgPlugins-3.6.5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
strip() { # SCENE EVERY FRAME... : of the frames that are multiples of EVERY, those named
    local scene=$1 every=$2 pictures=()
    shift 2
    "$root/build/bin/tss-render" "$root/scenes/${scene}_baked.tss" -o "$work/${scene}_%04d.png" --every "$every" \
        --frames $((${*: -1} + 1)) --size 640x480 --quiet --view "$root/examples/views/$scene.path"
    for frame in "$@"; do pictures+=("$work/${scene}_$(printf %04d "$frame").png"); done
    montage "${pictures[@]}" -tile "${columns:-4}x" -geometry "${picture:-320x240}+1+1" -background '#808080' miff:- |
        convert - +dither -colors 96 -define png:compression-level=9 -define png:exclude-chunks=date,tIME "PNG8:$root/docs/pictures/$scene.png"
}
columns=2 picture=640x480 strip dog_jaw 8 8 64 # open, and as far closed as its teeth and joint let it
strip dog_face 10 0 10 30 50 70 90 110 130 # at rest, then where each muscle is at its most
strip dog_ears 8 $(seq 0 8 56)
strip dog_lips 8 $(seq 0 8 56)
strip dog_head 2 0 24 46 58 82 96 112 126 # calm, alert, a growl, a bite, the ears laid back
strip dog_frontalis 8 $(seq 0 8 56)
# A captured brow beside ours: needs the real meshes, and the shapes that the test writes.
if [ -d "$root/../shared/meshes" ]; then
    "$root/build/bin/test_respond" "a frontalis set up from its anatomy*" >/dev/null
    for state in rest muscle captured; do
        "$root/build/bin/tss-render" "$root/build/brow_$state.obj" -o "$work/brow_$state.png" --frames 1 --quiet \
            --size 640x640 --view "$root/examples/views/human_brow.path" 2>/dev/null
    done
    montage "$work"/brow_{rest,muscle,captured}.png -tile 3x -geometry 400x400+1+1 -background '#808080' miff:- |
        convert - +dither -colors 256 -define png:compression-level=9 -define png:exclude-chunks=date,tIME "PNG8:$root/docs/pictures/human_brow.png"
fi
