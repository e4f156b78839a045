#!/usr/bin/env bash
# tss-render as its users call it, with no display; and the tools that OpenSceneGraph ships. Arguments: the build
# folder, the scenes folder.
set -euo pipefail
build=$1 scenes=$2
out=$build/test-render
rm -rf "$out" && mkdir -p "$out"
unset DISPLAY
export OSG_LIBRARY_PATH="$build/lib:$build/lib/$(ls "$build/lib" | grep osgPlugins)" LD_LIBRARY_PATH="$build/lib"
export LIBGL_ALWAYS_SOFTWARE=1
render=$build/bin/tss-render
fail() { echo "FAILED: $*" >&2; exit 1; }
ends() { local want=$1 rc=0; shift; "$@" >"$out/log" 2>&1 || rc=$?; [ "$rc" = "$want" ] || { cat "$out/log"; fail "exit $rc, not $want: $*"; }; }

jaw=$scenes/dog_jaw_baked.tss
ends 0 "$render" "$jaw" -o "$out/a_%03d.png" --frames 9 --every 8 --size 160x120
[ "$(ls "$out"/a_*.png | wc -l)" = 2 ] || fail "expected 2 pictures"
ends 0 "$render" "$jaw" -o "$out/b_%03d.png" --frames 9 --every 8 --size 160x120 --json --quiet
cmp "$out/a_008.png" "$out/b_008.png" || fail "the same frame is another picture"
! cmp -s "$out/a_000.png" "$out/a_008.png" || fail "nothing moves"
ends 0 "$render" "$jaw" -o "$out/c_%03d.png" --frames 9 --size 160x120
cmp "$out/a_008.png" "$out/c_008.png" || fail "frames that are passed over change the next picture"
ends 0 "$render" "$jaw" -o "$out/o_%03d.png" --frames 1 --size 160x120 --overlay
! cmp -s "$out/a_000.png" "$out/o_000.png" || fail "no overlay"
skin=$scenes/dog_frontalis_baked.tss
ends 0 "$render" "$skin" -o "$out/skin_%03d.png" --frames 9 --every 8 --size 160x120
ends 0 "$render" "$skin" -o "$out/spheres_%03d.png" --frames 9 --every 8 --size 160x120 --overlay
for frame in 000 008; do
    ! cmp -s "$out/skin_$frame.png" "$out/spheres_$frame.png" || fail "no overlay over a skin"
done
ends 0 "$render" "$jaw" -o "$out/one.png" --frames 1
ends 0 "$render" "$jaw" -o "$out/from.png" --frames 1 --view=0.5,-2,0.5:0.3,0,0.3
ends 0 "$render" "$jaw" -o "$out/behind.png" --frames 1 --view 0.3,2,0.5:0.3,0,0.3
! cmp -s "$out/from.png" "$out/behind.png" || fail "--view EYE:AT changes nothing"
ends 1 "$render" "$jaw" -o "$out/n_%d.png" --frames 1 --view 0,0,1:0,0
# A scene whose Y axis stands up is seen from a place in its own coordinates.
printf 'v 0 99 0\nv 2 99 0\nv 0 101 0\nv 0 99 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >"$out/high.obj"
"$build/bin/tss" make -o "$out/high.tss" --quiet --up-axis Y --a "$out/high.obj" --b "$out/high.obj" \
    --dof rot:0,100,0:0,1,0:0:90
ends 0 "$render" "$out/high.tss" -o "$out/high.png" --frames 1 --size 160x120 --view 0,100,30:0,100,0
ends 0 "$render" "$out/high.tss" -o "$out/away.png" --frames 1 --size 160x120 --view 0,100,30:0,100,60
! cmp -s "$out/high.png" "$out/away.png" || fail "--view sees nothing of a scene with Y up"
# What lies flat is seen from above: two prisms that are the same from the front are not.
prism() { # NAME X: a triangle with its third corner at X, 1 high
    printf 'v 0 0 0\nv 9 0 0\nv %s 9 0\nv 0 0 1\nv 9 0 1\nv %s 9 1\n' "$2" "$2" >"$out/$1.obj"
    printf 'f 1 3 2\nf 4 5 6\nf 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 3 1 4\nf 3 4 6\n' >>"$out/$1.obj"
    "$build/bin/tss" make -o "$out/$1.tss" --quiet --a "$out/$1.obj" --b "$out/$1.obj" --dof rot:0,0,0:0,0,1:0:0
    ends 0 "$render" "$out/$1.tss" -o "$out/$1.png" --frames 1 --size 160x120
}
prism left 0
prism right 9
! cmp -s "$out/left.png" "$out/right.png" || fail "flat scenes are seen on edge"
ends 0 "$render" --help
ends 1 "$render" "$scenes/none.tss" -o "$out/n_%d.png"
ends 1 "$render" "$jaw" -o "$out/n_%d.png" --frames 1 --view "$out/none.path"
echo "0 1 2 three" >"$out/bad.path"
ends 1 "$render" "$jaw" -o "$out/n_%d.png" --frames 1 --view "$out/bad.path"
ends 1 "$render" "$jaw" -o "$out/nowhere/n_%d.png" --frames 1
ends 2 "$render" "$jaw" -o "$out/n_%d_%d.png"
ends 2 "$render" "$jaw" -o "$out/n_%d.png" --size big
ends 2 "$render"

ends 1 "$render" "$scenes/../examples/hinge/upper.obj" -o "$out/n_%d.png" --frames 1 --overlay

# Stock osgconv, round and back: the same motion as the tool plays it.
for name in dog_jaw_baked dog_frontalis_baked; do
    from=$scenes/$name.tss
    for extension in osgt osgb osgx tss; do
        ends 0 osgconv "$from" "$out/$name.$extension"
        from=$out/$name.$extension
    done
    "$build/bin/tss" play "$scenes/$name.tss" -o "$out/$name.csv" --quiet
    "$build/bin/tss" play "$from" -o "$out/$name.back.csv" --quiet
    cmp "$out/$name.csv" "$out/$name.back.csv" || fail "$name plays otherwise after osgconv"
done
ends 0 "$render" "$out/dog_jaw_baked.osgb" -o "$out/p_%03d.png" --frames 1 --size 160x120
ends 0 "$render" "$out/dog_jaw_baked.osgb" -o "$out/q_%03d.png" --frames 1 --size 160x120 --overlay
! cmp -s "$out/p_000.png" "$out/q_000.png" || fail "no overlay over a graph of osgconv"
echo "tss-render and osgconv do as they say"
