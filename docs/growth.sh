#!/usr/bin/env bash
# The paper's growth with the paper's lengths: sphere counts for several sizes of its unit, and a picture of the
# spheres before and after the reduction (its Figure 2a and 2b). docs/GROWTH.md has what this printed.
#   docs/growth.sh [SCENE.tss [UNITS ...]]     default: the repository's jaw, bounding diagonals of 3, 4, 5 and 8 units
# Writes docs/pictures/growth.png where tss-render and ImageMagick are: at the second of the UNITS.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
tss=$root/build/bin/tss render=$root/build/bin/tss-render
export OSG_LIBRARY_PATH=$root/build/lib:$(echo "$root"/build/lib/osgPlugins-*) LD_LIBRARY_PATH=$root/build/lib
scene=${1:-$root/scenes/dog_jaw.tss}
units=("${@:2}")
[ $# -gt 1 ] || units=(3 4 5 8)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# T_min, delta t, T_max and the largest radius for a body whose bounding diagonal is $1 units.
lengths() { awk -v n="$1" 'BEGIN { printf "%.6g,%.6g,%.6g,%.6g", 0.01 / n, 0.01 / n, 0.101 / n, 0.02 / n }'; }
grow() { # SCENE UNITS OUT [OPTION...]
    "$tss" bake "$1" -o "$3" --spheres growth --growth "$(lengths "$2")" --search sampled --reduce cooccurrence \
        "${@:4}" --json --quiet
}

echo "| scene | diagonal, units | spheres | pairs that meet | after reduction | tests |"
echo "|---|---|---|---|---|---|"
echo "| the paper's skull and mandible | not said | 1158 + 812 | | 9 + 22 | 22 |"
for n in "${units[@]}"; do
    grow "$scene" "$n" "$work/baked.tss" | python3 -c '
import json, sys
p = json.load(sys.stdin)["pairs"][0]
print("| %s | %s | %d + %d | %s | %d + %d | %d |" % (sys.argv[1], sys.argv[2], p["spheresA"], p["spheresB"],
      p["candidatePairs"] or 0, p["usedA"], p["usedB"], p["tests"]))' "$(basename "$scene" .tss)" "$n"
done

[ $# -eq 0 ] && [ -x "$render" ] && command -v convert >/dev/null || exit 0
grow "$scene" "${units[1]}" "$work/before.tss" --keep-spheres >/dev/null
grow "$scene" "${units[1]}" "$work/after.tss" >/dev/null
for which in before after; do
    "$render" "$work/$which.tss" -o "$work/$which.png" --frames 1 --size 1280x960 --overlay --quiet
done
convert "$work/before.png" "$work/after.png" -gravity center -crop 720x600+0+0 +repage +append -colors 160 \
    "$root/docs/pictures/growth.png"
