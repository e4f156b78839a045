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
ends 0 "$render" "$scenes/dog_frontalis.tss" -o "$out/bare_%03d.png" --frames 2 --size 160x120 # has no table yet
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
# Nothing is seen on edge: prisms along each axis whose third corners differ are different pictures.
prism() { # NAME X AXIS: a triangle with its third corner at X, 9 high, along the axis
    local corner i order=(1 2 3)
    [ "$3" != X ] || order=(3 1 2)
    [ "$3" != Y ] || order=(2 3 1)
    for corner in "0 0 0" "9 0 0" "$2 9 0" "0 0 9" "9 0 9" "$2 9 9"; do
        echo "v $(for i in "${order[@]}"; do echo "$corner" | cut -d' ' -f"$i"; done | paste -sd' ')"
    done >"$out/$1.obj"
    printf 'f 1 3 2\nf 4 5 6\nf 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 3 1 4\nf 3 4 6\n' >>"$out/$1.obj"
    "$build/bin/tss" make -o "$out/$1.tss" --quiet --a "$out/$1.obj" --b "$out/$1.obj" --dof rot:0,0,0:0,0,1:0:0
    ends 0 "$render" "$out/$1.tss" -o "$out/$1.png" --frames 1 --size 160x120
}
for axis in X Y Z; do
    prism left 0 $axis
    prism right 9 $axis
    ! cmp -s "$out/left.png" "$out/right.png" || fail "what lies along $axis is seen on edge"
done
# All of the motion is in sight, and fills the picture one way or the other.
fits() { # SIZE SCENE EVERY
    local size=$1
    ends 0 "$render" "$2" -o "$out/all_%04d.ppm" --every "$3" --size "$size"
    tail -q -c $((3 * ${size%x*} * ${size#*x})) "$out"/all_*.ppm | od -An -v -tu1 -w$((3 * ${size%x*})) |
        awk -v size="$size" '
            BEGIN { split(size, of, "x"); left = of[1]; top = of[2] }
            {
                row = (NR - 1) % of[2]
                for (x = 0; x < of[1]; ++x)
                    if ($(3 * x + 1) != $1 || $(3 * x + 2) != $2 || $(3 * x + 3) != $3) {
                        if (x < left) left = x
                        if (x > right) right = x
                        if (row < top) top = row
                        if (row > bottom) bottom = row
                    }
            }
            END {
                cut = left < 1 || top < 1 || right > of[1] - 2 || bottom > of[2] - 2
                exit cut || ((right - left) / of[1] < 0.85 && (bottom - top) / of[2] < 0.85)
            }' || fail "a picture of $2, $size, does not hold the motion, or is mostly empty"
    rm "$out"/all_*.ppm
}
fits 160x120 "$jaw" 4
fits 90x180 "$jaw" 4
# So is a skin far wider than its bones, and a moment of a long motion.
tube() { # NAME FROM TO RADIUS: along X
    awk -v from="$2" -v to="$3" -v r="$4" 'BEGIN {
        for (k = 0; k <= 16; ++k)
            for (i = 0; i < 12; ++i)
                print "v", from + (to - from) * k / 16, r * cos(i * atan2(0, -1) / 6), r * sin(i * atan2(0, -1) / 6)
        for (k = 0; k < 16; ++k)
            for (i = 1; i <= 12; ++i)
                print "f", 12 * k + i, 12 * k + i % 12 + 1, 12 * k + i % 12 + 13, 12 * k + i + 12
        printf "f"; for (i = 12; i >= 1; --i) printf " %d", i; print ""
        printf "f"; for (i = 1; i <= 12; ++i) printf " %d", 192 + i; print ""
    }' >"$out/$1.obj"
}
tube upper 0 17 1 && tube lower 23 40 1 && tube hide -9 49 7
"$build/bin/tss" make -o "$out/limb.tss" --quiet --body "$out/upper.obj" --body "$out/lower.obj" \
    --skin "$out/hide.obj" --joint 'elbow=upper,lower:rot:20,0,0:0,1,0:-80:80'
fits 160x120 "$out/limb.tss" 12
# Nor does a ground count that is so large that nothing of the rest would be seen: two corners of it, aside.
printf 'v %s\n' '3276 2294 0' '3277 2294 0' '3276 2295 0' '-3276 -2294 0' '-3277 -2294 0' '-3276 -2295 0' \
    >"$out/ground.obj"
printf 'f %s\n' '1 2 3' '4 5 6' >>"$out/ground.obj"
"$build/bin/tss" make -o "$out/outdoors.tss" --quiet --body "$out/ground.obj" --body "$out/upper.obj" \
    --body "$out/lower.obj" --joint 'turn=ground,upper:rot:0,0,0:0,0,1:0:20' \
    --joint 'elbow=upper,lower:rot:20,0,0:0,1,0:-80:80'
fits 160x120 "$out/outdoors.tss" 12
# No more is in sight than the skin itself, as the corners of its bounding box would be.
printf 'v %s\n' '70 0 0' '-30 0 0' '20 50 0' '20 -50 0' '20 0 50' '20 0 -50' >"$out/octahedron.obj"
printf 'f %s\n' '1 3 5' '3 2 5' '2 4 5' '4 1 5' '3 1 6' '2 3 6' '4 2 6' '1 4 6' >>"$out/octahedron.obj"
"$build/bin/tss" make -o "$out/octahedron.tss" --quiet --body "$out/upper.obj" --body "$out/lower.obj" \
    --skin "$out/octahedron.obj" --joint 'elbow=upper,lower:rot:20,0,0:0,1,0:0:1'
fits 160x120 "$out/octahedron.tss" 12
printf 'step,rot\n0,0\n1001,0\n1002,90\n1003,0\n2015,0\n' >"$out/moment.csv"
"$build/bin/tss" make -o "$out/moment.tss" --quiet --a "$out/upper.obj" --b "$out/lower.obj" \
    --dof rot:20,0,0:0,1,0:0:90 --motion "$out/moment.csv"
fits 160x120 "$out/moment.tss" 1002
# A rigged mesh is in sight where its bones have it, wherever its own numbers are.
cat >"$out/rig.dae" <<'END'
<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_controllers><controller id="c"><skin source="#g">
<source id="j"><Name_array id="ja" count="1">bone</Name_array><technique_common>
<accessor source="#ja" count="1"><param name="JOINT" type="name"/></accessor></technique_common></source>
<source id="b"><float_array id="ba" count="16">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>
<accessor source="#ba" count="1" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
<source id="w"><float_array id="wa" count="1">1</float_array><technique_common>
<accessor source="#wa" count="1"><param name="WEIGHT" type="float"/></accessor></technique_common></source>
<joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#b"/></joints>
<vertex_weights count="4"><input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>
<vcount>1 1 1 1</vcount><v>0 0 0 0 0 0 0 0</v></vertex_weights></skin></controller></library_controllers>
<library_visual_scenes><visual_scene id="s">
<node id="bone" sid="bone" type="JOINT"><translate sid="t">90 0 0</translate><scale sid="s">3 3 3</scale></node>
<node id="n"><instance_controller url="#c"><skeleton>#bone</skeleton></instance_controller></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
END
fits 160x120 "$out/rig.dae" 1
# The end of a motion is shown where it is another place than the beginning.
printf 'step,rot\n0,0\n4,90\n' >"$out/open.csv"
"$build/bin/tss" make -o "$out/open.tss" --quiet --a "$out/upper.obj" --b "$out/lower.obj" \
    --dof rot:20,0,0:0,1,0:0:90 --motion "$out/open.csv"
ends 0 "$render" "$out/open.tss" -o "$out/open_%d.png" --size 160x120
[ "$(ls "$out"/open_*.png | wc -l)" = 5 ] || fail "expected 5 pictures"
! cmp -s "$out/open_0.png" "$out/open_4.png" || fail "the end of the motion is not shown"
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
